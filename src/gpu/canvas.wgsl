// Puts single pixels into a picture: where each goes, and what.
@group(0) @binding(0) var<storage, read> list: array<vec2u>;
@group(0) @binding(1) var<storage, read_write> pixels: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    // Rows of 1,024 workgroups.
    let i = id.y * 65536u + id.x;
    if i < arrayLength(&list) {
        pixels[list[i].x] = list[i].y;
    }
}
