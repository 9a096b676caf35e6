// Brings the frame into the window: a word of its buffer for each pixel, red, green, blue from the lowest byte up.

// Columns, in the first of these.
@group(0) @binding(0) var<uniform> size: vec4u;
@group(0) @binding(1) var<storage, read> words: array<u32>;

@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    // A triangle larger than the window.
    return vec4f(vec2f(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

fn color(position: vec4f) -> vec3f {
    let at = vec2u(position.xy);
    return unpack4x8unorm(words[at.y * size.x + at.x]).rgb;
}

fn light(color: vec3f) -> vec3f {
    return select(pow((color + 0.055) / 1.055, vec3f(2.4)), color / 12.92, color <= vec3f(0.04045));
}

// What is written is a byte of the frame.
@fragment
fn bytes(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(color(position), 1.0);
}

// What is written is light.
@fragment
fn linear(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(light(color(position)), 1.0);
}
