// Where in its pixel a sample's ray passes: the PCG 3D hash of Jarzynski and Olano. `hash` in src/jitter.rs has the
// same steps, to the bit.
fn jitter_hash(pixel: vec2i, number: u32) -> vec2f {
    var v = vec3u(vec2u(pixel), number) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    return vec2f(v.xy >> vec2u(22u)) * 0x1p-10f - 0.5;
}
