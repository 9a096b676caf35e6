// The reflectivity of an object at a hit. Referee: src/cpu/surface.rs.

//#if lit
//#insert struct LitObject

//#insert struct Material
//#else
//#insert struct Object
//#end

// A hit point.
struct Point {
    object: u32,
    // From the viewpoint.
    position: vec3f,
//#if certified
    // How far the true hit may be, and |position.x| + |position.y| + |position.z|.
    error: f32,
    size: f32,
//#end
//#if tables
    // Whether the pixel's own ray met it, and which pixel that is.
    direct: bool,
    pixel: vec2i,
//#end
//#if from_center
    // (H − center)/radius, on a sphere.
    from_center: vec3f,
    from_center_error: f32, //~
//#end
//#if lit
    // Of unit length.
    normal: vec3f,
    normal_error: f32, //~
    group: u32,
//#end
//#if low_light
    // The bit of the light whose height above the plane is told, and that height.
    low_light: u32, //~
    height: f32, //~
//#end
//#if lights_on_surface
    // Bit i: light i lies in the plane of the point.
    lights_on_surface: u32,
//#end
}
//#if certified

// Set where a decision that the colour depends on cannot be made.
var<private> doubt: bool;
//#end

// A colour, and the bound of its error.
struct Shade {
    color: vec3f,
    error: vec3f, //~
}
//#if lit

// The length of a vector; no component may overflow when squared.
fn length3(v: vec3f) -> f32 {
    return sqrt(dot(v, v));
}
//#end
//#if whole

// floor(index), from the nearest whole number and the side of it that the index lies on: where that side is certain the
// floor is. (Behind a barrier the index is one number, and its difference from the nearest whole number exact.)
fn floor3(index: vec3f) -> vec3f {
    let nearest = round(index);
    return nearest - select(vec3f(0.0), vec3f(1.0), index - nearest < vec3f(0.0));
}
//#end
//#if odd

// 1 where the integers are odd, 0 where they are even.
fn odd3(index: vec3f) -> vec3f {
    return index - 2.0 * floor(index * 0.5);
}
//#end
//#if index

// How far a position may be off for an index, per unit of the index's slope.
fn index_error(point: Point) -> f32 {
    return point.error + INDEX_ROUNDINGS * U * point.size;
}

//#end
//#if sure_index

// Leaves a doubt where an index is no farther from a whole number than its error.
fn certain(margin: vec3f) {
    doubt |= !all(margin > vec3f(0.0));
}
//#end
//#if tables

// What the host knows of the indices at the hit of a pixel's own ray, from the pixel's column and row: 0 where that is
// nothing. src/gpu/pack/tables.rs says which bit means what. (The tables are in the buffer of the objects, in the field
// `kind`, as some drivers allow only ten buffers. Asked only where an index is not certain by itself: loads cost more.)
fn index_table(point: Point) -> u32 {
    let first = objects[TABLES + point.object].kind;
    let there = point.direct & (first != 0u);
    let column = TABLES + select(0u, first + u32(point.pixel.x), there);
    let row = TABLES + select(0u, first + COLUMNS + u32(point.pixel.y), there);
    return select(0u, objects[column].kind | objects[row].kind, there);
}
//#if odd

// Which indices of tiles or blocks are known, and what has the parity of their floors.
fn index_table_known(word: u32) -> vec3<bool> {
    return (vec3u(word) & vec3u(2u, 8u, 32u)) != vec3u(0u);
}
fn index_table_odd(word: u32) -> vec3f {
    return vec3f((vec3u(word) >> vec3u(0u, 2u, 4u)) & vec3u(1u));
}
//#end
//#end
//#if tiled

//#insert struct TiledPlane

// Whether a tile is of the plane's own material.
fn tplane_foreground(plane: Tiled, point: Point) -> bool {
    let position = point.position;
    var index = vec2f(dot(plane.row_0, position) + plane.fraction_0, dot(plane.row_1, position) + plane.fraction_1);
    index = barrier(vec3f(index, 0.0)).xy; //~
    var margin = abs(index - round(index)) - (plane.row_lengths * index_error(point) + plane.errors); //~
    var whole = floor3(vec3f(index, plane.parity + 0.5));
//#if tables
    if !all(margin > vec2f(0.0)) {
        let word = index_table(point);
        margin = select(margin, vec2f(1.0), index_table_known(word).xy);
        whole = select(whole, index_table_odd(word), index_table_known(word));
    }
//#end
    certain(vec3f(margin, 1.0)); //~
    let odd = odd3(whole);
    return odd3(vec3f(odd.x + odd.y + odd.z)).x == 0.0;
}
//#end
//#if pplane

//#insert struct ProceduralPlane

// What a procedural plane's shader is told about the hit.
struct PlanePoint {
    point: Point,
    ambient: vec3f,
    plane: Pplane,
}
//#end
//#if pplane_odd

// Parities of floor(2·H + 1000), each 0 or 1, for the axes asked for (1, else 0).
fn pplane_odd(at: PlanePoint, axes: vec3f) -> vec3f {
    var index = at.point.position * at.plane.per_unit + at.plane.fraction;
    index = barrier(index); //~
    var whole = floor3(index);
//#if certified
    var margin = abs(index - round(index)) - (abs(at.plane.per_unit) * index_error(at.point) + at.plane.index_error);
//#if tables
    if !all(margin > vec3f(0.0)) {
        let word = index_table(at.point);
        margin = select(margin, vec3f(1.0), index_table_known(word));
        whole = select(whole, index_table_odd(word), index_table_known(word));
    }
//#end
    certain(select(vec3f(1.0), margin, axes > vec3f(0.0)));
//#end
    return odd3(whole + at.plane.parity);
}
//#end
//#if pplane_from_point

// Components x and y of H − point, and the bound of their errors.
fn pplane_from_point(at: PlanePoint) -> vec3f {
    let v = at.point.position.xy * at.plane.from_point.xy - at.plane.from_point.zw;
//#if certified
    let scale = max(abs(at.plane.from_point.x), abs(at.plane.from_point.y));
    return vec3f(v, scale * index_error(at.point) + at.plane.from_point_error);
//#else
    return vec3f(v, 0.0);
//#end
}
//#end
//#if texels
//#if certified

// How far indices of texels are from the next texels', less their errors. At the ends of a stretched picture indices
// are clamped, and one beyond is as good as the last.
fn texel_margin(size: vec2f, repeats: bool, index: vec2f, errors: vec2f) -> vec2f {
    let edge = select(clamp(round(index), vec2f(1.0), size - 1.0), round(index), repeats | any(size < vec2f(2.0)));
    let lone = vec2f(select(0.0, 2.0, !repeats & (size.x < 2.0)), select(0.0, 2.0, !repeats & (size.y < 2.0)));
    return abs(index - edge) - errors + lone;
}
//#end

// The texel at an index, each channel byte/256, of the picture whose texels begin at `first`.
fn texel_at(first: u32, columns: u32, size: vec2f, repeats: bool, index: vec2f) -> vec3f {
    var p = floor3(vec3f(index, 0.5)).xy;
    if repeats {
        // The half keeps the quotient away from whole numbers, whatever its rounding.
        p -= size * floor((p + 0.5) / size);
    }
    // The index may overshoot an edge by its error.
    let place = vec2u(clamp(p, vec2f(0.0), size - 1.0));
    let packed = texels[first + place.y * columns + place.x];
    return vec3f(vec3u(packed, packed >> 8u, packed >> 16u) & vec3u(255u)) * 0x1p-8f;
}
//#end
//#if textured

//#insert struct Texplane

// The texel at a point of a texplane, each channel byte/256.
fn texel(plane: Texplane, point: Point) -> vec3f {
    let position = point.position;
    var index = vec2f(dot(plane.row_0, position) - plane.origin_0, dot(plane.row_1, position) - plane.origin_1);
    index = barrier(vec3f(index, 0.0)).xy; //~
    let size = vec2f(plane.size);
    let repeats = plane.repeats != 0u;
//#if certified
    var margin = texel_margin(size, repeats, index, plane.row_lengths * index_error(point) + plane.errors);
//#if tables
    if !all(margin > vec2f(0.0)) {
        let word = index_table(point);
        let known = (vec2u(word) & vec2u(0x8000u, 0x80000000u)) != vec2u(0u);
        index = select(index, vec2f((vec2u(word) >> vec2u(0u, 16u)) & vec2u(0x7fffu)) + 0.5, known);
        margin = select(margin, vec2f(1.0), known);
    }
//#end
    certain(vec3f(margin, MOST_INDEX - max(abs(index.x), abs(index.y))));
//#end
    return texel_at(plane.first, plane.size.x, size, repeats, index);
}
//#end
//#if psphere

// What a procedural sphere's shader is told about the hit.
struct SpherePoint {
    // (H − center)/radius, and the bound of its error.
    from_center: vec3f,
    error: f32,
    ambient: vec3f,
}
//#end
//#if color_wheel

// (1 + cos 2θ, 1 + cos(2θ + 2π/3), 1 + cos(2θ + 4π/3)), θ the angle of (x, y) from +x; θ = 0 at the origin. No acos and
// no cos: cos 2θ = (x² − y²)/(x² + y²), sin 2θ = 2xy/(x² + y²). Both components may be off by `error`.
fn color_wheel(x_: f32, y_: f32, error: f32) -> Shade {
    var shade: Shade;
    let v = barrier(vec3f(x_, y_, 0.0));
    let x = v.x;
    let y = v.y;
    let square = x * x + y * y;
//#if certified
    if !(square > WHEEL_FAR * error * error + TINY_SQUARE) {
        doubt = true;
        return shade;
    }
//#else
    if !(square > 0.0) {
        shade.color = vec3f(2.0, 0.5, 0.5);
        return shade;
    }
//#end
    let inverse = 1.0 / square;
    let cosine = (x - y) * (x + y) * inverse;
    let sine = 2.0 * x * y * inverse;
    shade.color =
        max(vec3f(1.0 + cosine, 1.0 - 0.5 * cosine - HALF_ROOT_3 * sine, 1.0 - 0.5 * cosine + HALF_ROOT_3 * sine),
        vec3f(0.0));
    shade.error = vec3f(WHEEL_SLOPE * error * inverseSqrt(square) + WHEEL_ROUNDINGS * U); //~
    return shade;
}

//#if double
//#else
const HALF_ROOT_3 = 0x1.bb67aep-1f;
//#end
//#if double
const HALF_ROOT_3 = 0x1.bb67ae8584caap-1f;
//#end
//#end
//#insert procedural

//#if lit
// The material at a point: of a tiled plane, that of the tile.
fn tile_material(point: Point) -> u32 {
    let object = objects[point.object];
//#if tiled
    if (object.kind & 255u) == KIND_TILED {
        let plane = tiled_planes[object.kind >> 8u];
        return select(plane.altindex, object.material, tplane_foreground(plane, point));
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
        return diffuse * texel(texplanes[object.kind >> 8u], point);
    }
//#end
    return diffuse;
}

//#end
// The ambient reflectivity at a point.
fn getamb(point: Point) -> Shade {
    var shade: Shade;
    let object = objects[point.object];
//#if lit
    shade.color = materials[tile_material(point)].ambient;
//#else
    shade.color = object.ambient;
//#end
//#if modulated
    let record = object.kind >> 8u;
    switch object.kind & 255u {
//#insert ambient_cases
        default: {}
    }
//#end
    return shade;
}
