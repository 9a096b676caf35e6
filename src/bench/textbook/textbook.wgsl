// What a careful reader of the course notes writes, in f32: formula by formula, a loop over the objects, no tricks. For
// the report alone (`plumb bench`); no picture that anybody asked for is rendered with it.
//
// Two shaders are made of it (and for `report`, which tells what primary rays hit, two more without lights). In
// `prepared` ones the host has taken in f64, and rounded once, what does not depend on the ray: everything is relative
// to the viewpoint, normals and rows are of unit length, N·(Q − V) and where tiles begin are known. In the others
// (`//#else`) it hands over the scene's own numbers, and the shader starts from those.

const WORKGROUP = 16;
const NOTHING = 0xffffffffu;
const FAR = 3.4e38;
// What the surfaces are; the host's numbers.
const TILED = 1u;
const TILED_ALONG = 2u;
const TEXTURED = 3u;
const PPLANE_0 = 16u;
const PPLANE_1 = 17u;
const PPLANE_2 = 18u;
const PSPHERE_0 = 32u;

struct Dispatch {
    first: vec2u,
    size: vec2u,
    zero: u32,
    unused_0: u32,
    unused_1: u32,
    unused_2: u32,
}

struct Object {
    // Plane: normal, a point on it. Sphere: center.
    normal: vec3f,
    is_sphere: u32,
    point: vec3f,
    radius: f32,
    // Of a rectangle or of tiles: the first direction.
    xdir: vec3f,
    surface: u32,
    // The second; prepared only.
    ydir: vec3f,
    // N·(Q − V); prepared only.
    distance: f32,
    // Sides of a rectangle; 0 without end.
    extent: vec2f,
    // Sides of a tile, or texels per unit.
    dimension: vec2f,
    // Prepared: the fraction of the index at p = 0, and 1 where its whole part is odd.
    begins: vec3f,
    material: u32,
    odd: vec3f,
    altmaterial: u32,
    // A texture: its first texel, columns, rows; and whether it repeats.
    texels: vec4u,
}

struct Material {
    ambient: vec3f,
    transparency: f32,
    diffuse: vec3f,
    shininess: f32,
    specular: vec3f,
    unused: u32,
}

struct Light {
    location: vec3f,
    // Degrees, 0 for no spotlight; prepared: the cosine, below −1 for none.
    theta: f32,
    emissivity: vec3f,
    unused: u32,
    // Where a spotlight points to; prepared: its unit direction.
    point: vec3f,
    // The number of a projector's picture among the objects, behind all that rays meet; 0 for another light.
    picture: u32,
}

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
//#if report
// t, the object and 1 (0 for none), nothing, and the bytes as below.
@group(0) @binding(1) var<storage, read_write> pixels: array<vec4u>;
//#else
// Red, green, blue from the lowest byte up; the highest is not 0 where the loops came near the driver's limit.
@group(0) @binding(1) var<storage, read_write> pixels: array<u32>;
//#end
@group(0) @binding(2) var<storage, read> objects: array<Object>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> lights: array<Light>;
@group(0) @binding(5) var<storage, read> texels: array<u32>;

// Rounds of all loops so far: some drivers end loops early, without a word, that go round too often.
var<private> steps: u32;
const STEPS_LIMIT = 50000u;

// The notes' plane_hits and sphere_hits: t, or −1 for a miss.
fn plane_hits(object: Object, base: vec3f, dir: vec3f) -> f32 {
    let across = dot(object.normal, dir);
    if across == 0.0 {
        return -1.0;
    }
//#if prepared
    let t = (object.distance - dot(object.normal, base)) / across;
//#else
    let t = (dot(object.normal, object.point) - dot(object.normal, base)) / across;
//#end
    let hit = base + t * dir;
    if t <= 0.0 || hit.z > FRONT {
        return -1.0;
    }
    if object.extent.x > 0.0 {
        let p = along(object, hit - object.point);
        if p.x < 0.0 || p.y < 0.0 || p.x > object.extent.x || p.y > object.extent.y {
            return -1.0;
        }
    }
    return t;
}

fn sphere_hits(object: Object, base: vec3f, dir: vec3f) -> f32 {
    let v = base - object.point;
    let a = dot(dir, dir);
    let b = 2.0 * dot(v, dir);
    let c = dot(v, v) - object.radius * object.radius;
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 {
        return -1.0;
    }
    let t = (-b - sqrt(discriminant)) / (2.0 * a);
    return select(-1.0, t, t > 0.0);
}

// A vector along the two directions of a plane.
fn along(object: Object, v: vec3f) -> vec2f {
//#if prepared
    return vec2f(dot(object.xdir, v), dot(object.ydir, v));
//#else
    let n = normalize(object.normal);
    let x = normalize(object.xdir - dot(n, object.xdir) * n);
    return vec2f(dot(x, v), dot(cross(n, x), v));
//#end
}

struct Hit {
    t: f32,
    object: u32,
}

// The closest object but `last`, nearer than `limit`; of equally near ones the first.
fn find_closest_object(base: vec3f, dir: vec3f, last: u32, limit: f32) -> Hit {
    var closest = Hit(limit, NOTHING);
    for (var i = 0u; i < OBJECTS; i += 1u) {
        if i == last {
            continue;
        }
        var t: f32;
        if objects[i].is_sphere != 0u {
            t = sphere_hits(objects[i], base, dir);
        } else {
            t = plane_hits(objects[i], base, dir);
        }
        if t > 0.0 && t < closest.t {
            closest = Hit(t, i);
        }
    }
    return closest;
}

// Whether an index is odd: floor(p / size + what it is at p = 0).
fn odd(p: f32, size: f32, begins: f32, is_odd: f32) -> f32 {
    let index = floor(p / size + begins) + is_odd;
    return index - 2.0 * floor(index / 2.0);
}

// 1 where the indices add up to an odd number.
fn tile_odd(object: Object, hit: vec3f) -> bool {
    var p = hit.xz;
    if object.surface == TILED_ALONG {
        p = along(object, hit);
    }
//#if prepared
    let sum = odd(p.x, object.dimension.x, object.begins.x, object.odd.x)
        + odd(p.y, object.dimension.y, object.begins.y, object.odd.y);
//#else
    let sum = odd(p.x + 10000.0, object.dimension.x, 0.0, 0.0) + odd(p.y + 10000.0, object.dimension.y, 0.0, 0.0);
//#end
    return sum == 1.0;
}

// 0 or 1 a coordinate, as floor(2·p + 1000) is even or odd.
fn blocks_odd(object: Object, hit: vec3f) -> vec3f {
//#if prepared
    return vec3f(odd(hit.x, 0.5, object.begins.x, object.odd.x), odd(hit.y, 0.5, object.begins.y, object.odd.y),
        odd(hit.z, 0.5, object.begins.z, object.odd.z));
//#else
    let index = floor(2.0 * hit + 1000.0);
    return index - 2.0 * floor(index / 2.0);
//#end
}

const TURN = 6.2831855;

fn wheel(angle: f32) -> vec3f {
    return 1.0 + cos(vec3f(2.0 * angle, 2.0 * angle + TURN / 3.0, 2.0 * angle + 2.0 * TURN / 3.0));
}

// The angle of (x, y) from +x by an arc cosine.
fn angle_of(v: vec2f) -> f32 {
    if v.x == 0.0 && v.y == 0.0 {
        return 0.0;
    }
    return acos(clamp(v.x / sqrt(v.x * v.x + v.y * v.y), -1.0, 1.0));
}

fn texel(object: Object, hit: vec3f) -> vec3f {
    let size = vec2f(object.texels.yz);
    var place = floor(along(object, hit - object.point) * object.dimension);
    if object.texels.w != 0u {
        place -= size * floor(place / size);
    }
    place = clamp(place, vec2f(0.0), size - 1.0);
    let word = texels[object.texels.x + (u32(size.y) - 1u - u32(place.y)) * u32(size.x) + u32(place.x)];
    return vec3f(vec3u(word, word >> 8u, word >> 16u) & vec3u(255u)) / 256.0;
}

fn material_at(object: Object, hit: vec3f) -> u32 {
    if object.surface == TILED || object.surface == TILED_ALONG {
        // Tiles along a direction have the colours the other way round.
        if tile_odd(object, hit) != (object.surface == TILED_ALONG) {
            return object.altmaterial;
        }
    }
    return object.material;
}

fn getamb(object: Object, hit: vec3f) -> vec3f {
    let ambient = materials[material_at(object, hit)].ambient;
    let from_point = hit - object.point;
    switch object.surface {
        case PPLANE_0: {
            let index = blocks_odd(object, hit);
            return select(vec3f(ambient.xy, 0.0), vec3f(0.0, ambient.yz), index.x != index.z);
        }
        case PPLANE_1, PPLANE_2: {
            let index = blocks_odd(object, hit);
            if object.surface == PPLANE_2 && (index.x + index.y + index.z) % 2.0 == 1.0 {
                return ambient;
            }
            let angle = angle_of(from_point.xy);
            return 6.0 * wheel(select(angle, TURN - angle, from_point.y < 0.0));
        }
        case PSPHERE_0: {
            return wheel(TURN - angle_of(from_point.xy));
        }
        case TEXTURED: {
            return ambient * texel(object, hit);
        }
        default: {
            return ambient;
        }
    }
}
//#if lit

fn normal_at(object: Object, hit: vec3f) -> vec3f {
    if object.is_sphere != 0u {
        return normalize(hit - object.point);
    }
    return normalize(object.normal);
}

// What passes a transparent surface: its diffuse reflectivity, the largest channel 1.
fn tint(object: Object, hit: vec3f) -> vec3f {
    let diffuse = materials[material_at(object, hit)].diffuse;
    let most = max(diffuse.x, max(diffuse.y, diffuse.z));
    if most == 0.0 {
        return vec3f(1.0);
    }
    return diffuse / most;
}

// The share of light that reaches `hit` along `dir` over the distance; none is below 0.
fn shadow(hit: vec3f, dir: vec3f, distance: f32, from_object: u32) -> vec3f {
    var share = vec3f(1.0);
    var base = hit;
    var left = distance;
    var last = from_object;
    loop {
        steps += LANES * (OBJECTS + 2u);
        if steps > STEPS_LIMIT {
            break;
        }
        let blocker = find_closest_object(base, dir, last, left);
        if blocker.object == NOTHING {
            break;
        }
        base += blocker.t * dir;
        left -= blocker.t;
        last = blocker.object;
        let transparency = materials[objects[last].material].transparency;
        if transparency == 0.0 {
            share = vec3f(-1.0);
            break;
        }
        share *= tint(objects[last], base) * transparency;
    }
    return share;
}

fn light_term(light: Light, number: u32, hit: vec3f, normal: vec3f, base: vec3f) -> vec3f {
    let toward = light.location - hit;
    let distance = length(toward);
    if distance == 0.0 {
        return vec3f(0.0);
    }
    let d = toward / distance;
    let cosine = dot(d, normal);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
//#if prepared
    if light.theta >= -1.0 && dot(-d, light.point) <= light.theta {
        return vec3f(0.0);
    }
//#else
    if light.theta > 0.0 && dot(-d, normalize(light.point - light.location)) <= cos(radians(light.theta)) {
        return vec3f(0.0);
    }
//#end
    var emissivity = light.emissivity;
    if light.picture != 0u {
        let picture = objects[light.picture];
        let way = hit - light.location;
        let up_to = dot(picture.normal, picture.point - light.location) / dot(picture.normal, way);
        let crossing = light.location + up_to * way;
        let p = along(picture, crossing - picture.point);
        if !(up_to > 0.0 && up_to < 1.0) || any(p < vec2f(0.0)) || any(p > picture.extent) {
            return vec3f(0.0);
        }
        emissivity *= texel(picture, crossing);
    }
    let share = shadow(hit, d, distance, number);
    if share.x < 0.0 {
        return vec3f(0.0);
    }
    let material = materials[objects[number].material];
    var diffuse = materials[material_at(objects[number], hit)].diffuse;
    if objects[number].surface == TEXTURED {
        diffuse *= texel(objects[number], hit);
    }
    var color = diffuse * emissivity * share * cosine / distance;
    if material.shininess != 0.0 {
        let half = normalize(base - hit) + d;
        let along_half = dot(half, normal);
        if along_half > 0.0 {
            color += material.specular * emissivity * pow(along_half / length(half), material.shininess);
        }
    }
    return color;
}

// A ray of the tree that a pixel grows.
struct Branch {
    base: vec3f,
    total: f32,
    dir: vec3f,
    last: u32,
    weight: vec3f,
}

const STACK = 8u;
var<private> stack: array<Branch, STACK>;
//#end

@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= dispatch.size) {
        return;
    }
    let pixel = vec2f(f32(dispatch.first.x + id.x), f32(i32(dispatch.first.y) - i32(id.y)));
//#if prepared
    let base = vec3f(0.0);
    let dir = normalize(vec3f(pixel * CAMERA_STEP + CAMERA_OFFSET, CAMERA_Z));
//#else
    let base = VIEWPOINT;
    // With one pixel in a direction, the middle of that side.
    let world = select(WORLDDIM * pixel / max(PIXELDIM - 1.0, vec2f(1.0)), 0.5 * WORLDDIM, PIXELDIM == vec2f(1.0));
    let dir = normalize(vec3f(world, 0.0) - VIEWPOINT);
//#end
    var color = vec3f(0.0);
    var gave_up = false;
//#if lit
    // Instead of the notes' recursion, which WGSL does not have, a stack of rays that wait.
    var ray = Branch(base, 0.0, dir, NOTHING, vec3f(1.0));
    var waiting = 0u;
    loop {
        steps += LANES * (OBJECTS + 2u);
        let met = find_closest_object(ray.base, ray.dir, ray.last, FAR);
        if met.object != NOTHING {
            let object = objects[met.object];
            let at = ray.base + met.t * ray.dir;
            let normal = normal_at(object, at);
            let material = materials[object.material];
            var brings = getamb(object, at);
            for (var i = 0u; i < LIGHTS; i += 1u) {
                steps += LANES;
                brings += light_term(lights[i], met.object, at, normal, ray.base);
            }
            let total = ray.total + met.t;
            color += ray.weight * (1.0 - material.transparency) * brings / total;
            if total <= MAX_PATH && waiting + 2u <= STACK {
                let mirrored = ray.weight * material.specular;
                if any(mirrored > vec3f(0.0)) {
                    let u = -ray.dir;
                    stack[waiting] = Branch(at, total, 2.0 * dot(u, normal) * normal - u, met.object, mirrored);
                    waiting += 1u;
                }
                if material.transparency > 0.0 {
                    let passed = ray.weight * material.transparency * tint(object, at);
                    stack[waiting] = Branch(at, total, ray.dir, met.object, passed);
                    waiting += 1u;
                }
            } else if total <= MAX_PATH {
                gave_up = true;
            }
        }
        gave_up = gave_up || steps > STEPS_LIMIT;
        if waiting == 0u || gave_up {
            break;
        }
        waiting -= 1u;
        ray = stack[waiting];
    }
//#else
    let hit = find_closest_object(base, dir, NOTHING, FAR);
    if hit.object != NOTHING {
        color = getamb(objects[hit.object], base + hit.t * dir) / hit.t;
    }
//#end
    let bytes = vec3u(clamp(255.0 * color, vec3f(0.0), vec3f(255.0)));
    let packed = bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | select(0u, 0xff000000u, gave_up);
    let place = id.y * dispatch.size.x + id.x;
//#if report
    pixels[place] = vec4u(bitcast<u32>(hit.t), select(hit.object + 1u, 0u, hit.object == NOTHING), 0u, packed);
//#else
    pixels[place] = packed;
//#end
    // Never: all bindings are in the layout, also those that this scene does not need.
    if dispatch.zero != 0u {
        steps = lights[0].unused + texels[0] + materials[0].unused;
        pixels[place] = pixels[steps];
    }
}
