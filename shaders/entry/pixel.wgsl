
// Instead of the entry point of a picture's shader: what a single pixel has before it is quantised, and its bounds.
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    // `id` is 0. Where the pixel was `dispatch.first` alone, lavapipe took 71 s to compile the showcase; so it takes 1
    // s.
    let pixel = vec2i(dispatch.first + id.xy);
//#if samples
    let ray = camera_getdir(pixel, jitter_hash(pixel, 0u));
//#else
    let ray = camera_getdir(pixel);
//#end
    let traced = ray_trace(ray);
    let word = camera_setpix(traced.color, traced.error) | traced.verdict;
//#if double
    // Lower halves, then higher ones.
    let color = bitcast<vec3<u64>>(traced.color);
    let error = bitcast<vec3<u64>>(traced.error);
    pixels[0] = vec4u(vec3u(color), word);
    pixels[1] = vec4u(vec3u(error), 0u);
    pixels[2] = vec4u(vec3u(color >> vec3u(32u)), 0u);
    pixels[3] = vec4u(vec3u(error >> vec3u(32u)), 0u);
//#else
    pixels[0] = vec4u(bitcast<vec3u>(traced.color), word);
    pixels[1] = vec4u(bitcast<vec3u>(traced.error), 0u);
//#end
}
