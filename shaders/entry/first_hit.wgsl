
// Instead of the entry point of a picture's shader: what the primary ray meets, and how far away that is.
@compute @workgroup_size(WORKGROUP, WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= dispatch.size) {
        return;
    }
    let pixel = vec2i(i32(dispatch.first.x + id.x), i32(dispatch.first.y) - i32(id.y));
    let ray = camera_getdir(pixel);
    let hit = find_closest_object(ray);
    var seen = vec4u(0u);
    if hit.inverse > 0.0 {
        seen = vec4u(bitcast<u32>(ray.w2 * ray.inverse_length / hit.inverse), hit.object + 1u, 0u, 0u);
    }
    // Never: the rest of the shader stays in, and with it the bindings that the host binds.
    if dispatch.zero != 0u {
        seen.z = ray_trace(ray).verdict;
    }
    pixels[id.y * dispatch.size.x + id.x] = seen;
}
