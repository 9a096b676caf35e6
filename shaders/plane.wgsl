// Planes. Twin: src/cpu/plane.rs.

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
    let side = plane.front.x * f32(ray.pixel.x) + plane.front.y * f32(ray.pixel.y) + plane.front.z;
    return select(0.0, inverse, side >= 0.0);
//#else
    return inverse;
//#end
}
