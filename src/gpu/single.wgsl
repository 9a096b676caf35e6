
// Instead of the entry point of a picture's shader: what a single pixel has before it is quantised, and its bounds.
@compute @workgroup_size(1)
fn main() {
    let traced = ray_trace(camera_getdir(vec2i(job.first)));
    pixels[0] = vec4u(bitcast<vec3u>(traced.color), camera_setpix(traced.color, traced.error) | traced.verdict);
    pixels[1] = vec4u(bitcast<vec3u>(traced.error), 0u);
}
