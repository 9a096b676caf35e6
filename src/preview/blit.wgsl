// Brings the drawn picture into the window: a texel for each of its pixels.

@group(0) @binding(0) var drawn: texture_2d<f32>;

@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    // A triangle larger than the window.
    return vec4f(vec2f(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

fn light(color: vec3f) -> vec3f {
    return select(pow((color + 0.055) / 1.055, vec3f(2.4)), color / 12.92, color <= vec3f(0.04045));
}

// What is written is a byte of a picture.
@fragment
fn bytes(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let color = textureLoad(drawn, vec2i(position.xy), 0);
    if color.a == 0.0 {
        discard;
    }
    return color;
}

// What is written is light.
@fragment
fn linear(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let color = textureLoad(drawn, vec2i(position.xy), 0);
    if color.a == 0.0 {
        discard;
    }
    return vec4f(light(color.rgb), 1.0);
}
