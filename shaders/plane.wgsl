// Planes and rectangles of planes. Twin: src/cpu/plane.rs.

//#if plane
struct Plane {
    // 1/s = inverse.x·W.x + inverse.y·W.y + inverse.z
    inverse: vec3f,
    object: u32,
    // Hit only where front.x·x + front.y·y + front.z ≥ 0, (x, y) the pixel: the rule H.z ≤ τ.
    front: vec3f,
    unused: u32,
}

// 1/s of the hit on the plane; 0 or less for a miss.
fn plane_hits(plane: Plane, ray: Ray) -> f32 {
    let inverse = plane.inverse.x * ray.w.x + plane.inverse.y * ray.w.y + plane.inverse.z;
//#if front
    let pixel = from_pixel(ray, vec2i(0));
    let side = plane.front.x * pixel.x + plane.front.y * pixel.y + plane.front.z;
    return select(0.0, inverse, side >= 0.0);
//#else
    return inverse;
//#end
}
//#end
//#if rectangle

struct Rectangle {
    // As in a Plane.
    inverse: vec3f,
    object: u32,
    front: vec3f,
    unused: u32,
    // p_i/s = side_i.x·W.x + side_i.y·W.y + side_i.z, p the coordinates on the rectangle; and the sides' lengths.
    side_0: vec3f,
    length_0: f32,
    side_1: vec3f,
    length_1: f32,
}

// 1/s of the hit on the rectangle; 0 or less for a miss.
fn rectangle_hits(rectangle: Rectangle, ray: Ray) -> f32 {
    let w = vec3f(ray.w.xy, 1.0);
    let inverse = dot(rectangle.inverse, w);
    let p = vec2f(dot(rectangle.side_0, w), dot(rectangle.side_1, w));
    let lengths = vec2f(rectangle.length_0, rectangle.length_1);
    let inside = all(p >= vec2f(0.0)) && all(p <= lengths * inverse);
//#if front
    let side = dot(rectangle.front, vec3f(from_pixel(ray, vec2i(0)), 1.0));
    return select(0.0, inverse, inside && side >= 0.0);
//#else
    return select(0.0, inverse, inside);
//#end
}
//#end
//#if lit

// A plane or rectangle for rays from anywhere; positions are from the viewpoint.
struct WorldPlane {
    // Of unit length; normal·P = offset on the plane.
    normal: vec3f,
    offset: f32,
    // A hit point P becomes P·keep + own: on a plane perpendicular to an axis that coordinate is exact.
    keep: vec3f,
    group: u32,
    own: vec3f,
    object: u32,
    // p_i = row_i·P − origin_i, the coordinates on the rectangle; the sides' lengths, huge for a plane without end.
    row_0: vec3f,
    origin_0: f32,
    row_1: vec3f,
    origin_1: f32,
    lengths: vec2f,
    // Bit i: light i lies in the plane.
    level: u32,
    // 1 for a rectangle.
    bounded: u32,
}

// t of the hit on the plane; 0 for a miss.
fn plane_hits_from(plane: WorldPlane, base: vec3f, dir: vec3f, range: Range) -> f32 {
    let t = (plane.offset - dot(plane.normal, base)) / dot(plane.normal, dir);
    let position = (base + t * dir) * plane.keep + plane.own;
    var hit = t > range.beyond && t < range.limit && position.z <= HIGHEST;
    // A light in the plane is where the ray meets it: at the light, not before.
    hit = hit && plane.group != range.skip && (plane.level & range.light) == 0u;
//#if rectangle_anywhere
    if plane.bounded != 0u {
        let p = vec2f(dot(plane.row_0, position) - plane.origin_0, dot(plane.row_1, position) - plane.origin_1);
        hit = hit && all(p >= vec2f(0.0)) && all(p <= plane.lengths);
    }
//#end
    return select(0.0, t, hit);
}
//#end
