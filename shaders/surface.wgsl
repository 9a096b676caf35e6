// The reflectivity of an object at a hit. Twin: src/cpu/surface.rs.

//#if lit
struct Object {
    // Index of the material.
    material: u32,
    // What modulates it: KIND_… in the low byte, the index of its record above.
    kind: u32,
    // Number of the surface that the object is or is part of.
    group: u32,
    // Index into `world_planes`, or into `world_spheres` with the highest bit set.
    place: u32,
}

struct Material {
    ambient: vec3f,
    transparency: f32,
    diffuse: vec3f,
    // 0 where there is no glint.
    shininess: f32,
    specular: vec3f,
    unused_0: u32,
    // What tints light that goes through.
    tint: vec3f,
    unused_1: u32,
}
//#else
struct Object {
    // The material's ambient reflectivity.
    ambient: vec3f,
    // What modulates it: KIND_… in the low byte, the index of its record above.
    kind: u32,
}
//#end

// A hit point.
struct Point {
    object: u32,
    // From the viewpoint.
    position: vec3f,
//#if from_center
    // H − center, on a sphere.
    from_center: vec3f,
//#end
//#if lit
    // Of unit length.
    normal: vec3f,
    group: u32,
//#end
//#if level
    // Bit i: light i lies in the plane of the point.
    level: u32,
//#end
}
//#if lit

// The length of a vector; no component may overflow when squared.
fn length3(v: vec3f) -> f32 {
    return sqrt(dot(v, v));
}
//#end
//#if odd

// 1 where the integers are odd, 0 where they are even.
fn odd3(index: vec3f) -> vec3f {
    return index - 2.0 * floor(index * 0.5);
}
//#end
//#if tiled

struct Tiled {
    // Tile indices along both directions: floor(row_i·P + fraction_i), up to `parity`.
    row_0: vec3f,
    fraction_0: f32,
    row_1: vec3f,
    fraction_1: f32,
    // The other material's ambient reflectivity, and its index.
    altmaterial: vec3f,
    altindex: u32,
    // The host's parities together, 0 to 3: tiles whose sum is odd have the other material.
    parity: f32,
    unused: vec3f,
}

// Whether a tile is of the plane's own material.
fn tplane_foreground(plane: Tiled, position: vec3f) -> bool {
    let index = vec2f(dot(plane.row_0, position) + plane.fraction_0, dot(plane.row_1, position) + plane.fraction_1);
    let odd = odd3(vec3f(floor(index), plane.parity));
    return odd3(vec3f(odd.x + odd.y + odd.z)).x == 0.0;
}
//#end
//#if pplane

struct Pplane {
    // The indices floor(2·H + 1000): floor(P·per_unit + fraction), up to `parity` (0 or 1 each).
    per_unit: vec3f,
    unused_0: u32,
    fraction: vec3f,
    unused_1: u32,
    parity: vec3f,
    unused_2: u32,
    // The components x and y of H − point: P·from_point.xy − from_point.zw.
    from_point: vec4f,
}

// What a procedural plane's shader is told about the hit.
struct PlanePoint {
    position: vec3f,
    ambient: vec3f,
    plane: Pplane,
}
//#end
//#if pplane_odd

// Parities of floor(2·H + 1000), each 0 or 1.
fn pplane_odd(at: PlanePoint) -> vec3f {
    return odd3(floor(at.position * at.plane.per_unit + at.plane.fraction) + at.plane.parity);
}
//#end
//#if pplane_from_point

// Components x and y of H − point.
fn pplane_from_point(at: PlanePoint) -> vec2f {
    return at.position.xy * at.plane.from_point.xy - at.plane.from_point.zw;
}
//#end
//#if textured

struct Texplane {
    // Texel column and row: floor(row_i·P − origin_i).
    row_0: vec3f,
    origin_0: f32,
    row_1: vec3f,
    origin_1: f32,
    // Columns and rows of the texture, and its first texel in `texels`.
    size: vec2u,
    first: u32,
    // 1 where the picture repeats, 0 where it is stretched.
    repeats: u32,
}

// The texel at a point of a texplane, each channel byte/256.
fn texel(plane: Texplane, position: vec3f) -> vec3f {
    var p = floor(vec2f(dot(plane.row_0, position) - plane.origin_0, dot(plane.row_1, position) - plane.origin_1));
    let size = vec2f(plane.size);
    if plane.repeats != 0u {
        p -= size * floor(p / size);
    }
    // The remainder of a rounded quotient may be off by one turn; an edge may be overshot.
    let place = vec2u(clamp(p, vec2f(0.0), size - 1.0));
    let packed = texels[plane.first + place.y * plane.size.x + place.x];
    return vec3f(vec3u(packed, packed >> 8u, packed >> 16u) & vec3u(255u)) / 256.0;
}
//#end
//#if psphere

// What a procedural sphere's shader is told about the hit.
struct SpherePoint {
    from_center: vec3f,
    ambient: vec3f,
}
//#end
//#if color_wheel

// (1 + cos 2θ, 1 + cos(2θ + 2π/3), 1 + cos(2θ + 4π/3)), θ the angle of (x, y) from +x; θ = 0 at the origin.
// By 1 + cos 2α = 2·cos²α: no acos, no cos, and never less than 0.
fn color_wheel(x: f32, y: f32) -> vec3f {
    let larger = max(abs(x), abs(y));
    if !(larger > 0.0) {
        return vec3f(2.0, 0.5, 0.5);
    }
    let v = vec2f(x, y) / larger;
    let cosines = vec3f(v.x, 0.5 * v.x - HALF_ROOT_3 * v.y, 0.5 * v.x + HALF_ROOT_3 * v.y);
    return cosines * cosines * (2.0 / dot(v, v));
}

const HALF_ROOT_3 = 0.86602540378443864676f;
//#end
//#insert procedural

//#if lit
// The material at a point: of a tiled plane, that of the tile.
fn tile_material(point: Point) -> u32 {
    let object = objects[point.object];
//#if tiled
    if (object.kind & 255u) == KIND_TILED {
        let plane = tiled_planes[object.kind >> 8u];
        return select(plane.altindex, object.material, tplane_foreground(plane, point.position));
    }
//#end
    return object.material;
}

// The diffuse reflectivity at a point.
fn getdiff(point: Point) -> vec3f {
    let diffuse = materials[tile_material(point)].diffuse;
//#if textured
    let object = objects[point.object];
    if (object.kind & 255u) == KIND_TEXTURED {
        return diffuse * texel(texplanes[object.kind >> 8u], point.position);
    }
//#end
    return diffuse;
}

//#end
// The ambient reflectivity at a point.
fn getamb(point: Point) -> vec3f {
    let object = objects[point.object];
//#if lit
    let ambient = materials[tile_material(point)].ambient;
//#else
    let ambient = object.ambient;
//#end
//#if modulated
    let record = object.kind >> 8u;
    switch object.kind & 255u {
//#if tiled_ambient
        case KIND_TILED: {
            let plane = tiled_planes[record];
            return select(plane.altmaterial, ambient, tplane_foreground(plane, point.position));
        }
//#end
//#if textured
        case KIND_TEXTURED: {
            return ambient * texel(texplanes[record], point.position);
        }
//#end
//#insert procedural_cases
        default: {}
    }
//#end
    return ambient;
}
