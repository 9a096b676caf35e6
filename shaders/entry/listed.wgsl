
// Instead of the entry point of a picture's shader: the pixels that it listed, again.
//#if listed
@compute @workgroup_size(LIST_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= min(atomicLoad(&pixels.records), dispatch.room) {
        return;
    }
    let first = record_words(id.x);
    let place = pixels.words[first];
    let row = place / dispatch.size.x;
    let column = place - row * dispatch.size.x;
    let pixel = vec2i(i32(dispatch.first.x + column), i32(dispatch.first.y) - i32(row));
    let traced = ray_trace(camera_getdir(pixel));
    pixels.words[first + 1u] = camera_setpix(traced.color, traced.error) | traced.verdict;
}
//#end
