
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
    pixels[0] = vec4u(bitcast<vec3u>(traced.color), camera_setpix(traced.color, traced.error) | traced.verdict);
    pixels[1] = vec4u(bitcast<vec3u>(traced.error), 0u);
}
