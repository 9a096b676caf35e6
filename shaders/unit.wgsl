// Vectors of unit length, as bounds take the directions of all rays, and normals, for granted.

// A vector of about unit length after a step of Newton's towards it. What is left of a difference of η is 1.5·η².
fn unit_step(v: vec3f) -> vec3f {
    let square = barrier1(dot(v, v));
    return barrier(v * barrier1(1.5 - 0.5 * square));
}

// The direction of a primary ray.
fn unit_direction(ray: Ray) -> vec3f {
    return unit_step(barrier(ray.w * barrier1(ray.inverse_length)));
}
