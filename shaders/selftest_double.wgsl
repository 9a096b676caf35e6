// What the certified path takes for granted of f64 on a device, tried out: src/gpu/selftest/double.rs judges the
// results.

// x and y, each as two words, the lower half first.
@group(0) @binding(0) var<storage, read> operands: array<vec4u>;
@group(0) @binding(1) var<storage, read_write> results: array<vec2u>;
// Zero, which no compiler can know.
@group(0) @binding(2) var<storage, read> unknown: array<u32>;

var<private> zero: u32;

fn words(x: f64) -> vec2u {
    let bits = bitcast<u64>(x);
    return vec2u(u32(bits & u64(0xffffffffu)), u32(bits >> 32u));
}

fn number(low: u32, high: u32) -> f64 {
    return bitcast<f64>(u64(low) | (u64(high) << 32u));
}

// The barrier: no identity of real arithmetic leads through it.
fn barrier(x: f64) -> f64 {
    return bitcast<f64>(bitcast<u64>(x) ^ u64(zero));
}

// x + y = sum + tail, exactly (Knuth).
fn two_sum(x: f64, y: f64) -> vec2<f64> {
    let sum = barrier(x + y);
    let b = barrier(sum - x);
    let a = barrier(sum - b);
    return vec2<f64>(sum, barrier(x - a) + barrier(y - b));
}

// x = high + low, each of 26 bits (Veltkamp).
fn split(x: f64) -> vec2<f64> {
    let c = barrier(134217729.0lf * x);
    let high = barrier(c - barrier(c - x));
    return vec2<f64>(high, barrier(x - high));
}

// x · y = product + tail, exactly (Dekker).
fn two_prod(x: f64, y: f64) -> vec2<f64> {
    let product = barrier(x * y);
    let a = split(x);
    let b = split(y);
    let rest = barrier(barrier(barrier(a.x * b.x) - product) + barrier(a.x * b.y));
    return vec2<f64>(product, barrier(rest + barrier(a.y * b.x)) + barrier(a.y * b.y));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    zero = unknown[0];
    let a = operands[id.x];
    let x = number(a.x, a.y);
    let y = number(a.z, a.w);
    let sum = two_sum(x, y);
    let product = two_prod(x, y);
    let single = bitcast<f32>(a.x);
    let at = id.x * RESULTS;
    results[at + 0u] = words(x + y);
    results[at + 1u] = words(x - y);
    results[at + 2u] = words(x * y);
    results[at + 3u] = words(x / y);
    results[at + 4u] = words(sqrt(abs(x)));
    results[at + 5u] = words(1.0lf / sqrt(abs(x)));
    results[at + 6u] = words(floor(x));
    results[at + 7u] = words(round(x));
    results[at + 8u] = words(f64(bitcast<i32>(a.x)));
    results[at + 9u] = words(f64(a.x));
    results[at + 10u] = words(min(x, y));
    results[at + 11u] = words(max(x, y));
    results[at + 12u] = words(abs(x));
    results[at + 13u] = words(select(x, y, x > y));
    results[at + 14u] = vec2u(
        u32(x > y) | u32(x >= y) << 1u | u32(abs(x) > abs(y)) << 2u | u32(x == y) << 3u,
        u32(abs(x) > LITERAL_0),
    );
    results[at + 15u] = vec2u(bitcast<u32>(i32(x)), u32(abs(x)));
    results[at + 16u] = vec2u(bitcast<u32>(f32(x)), 0u);
    results[at + 17u] = words(f64(single));
    results[at + 18u] = words(barrier(x));
    results[at + 19u] = words(sum.x);
    results[at + 20u] = words(sum.y);
    results[at + 21u] = words(product.x);
    results[at + 22u] = words(product.y);
    results[at + 23u] = words(x * LITERAL_0);
    results[at + 24u] = words(x + LITERAL_1);
    results[at + 25u] = words(LITERAL_1);
    results[at + 26u] = words(dot(vec3<f64>(x, LITERAL_0, y), vec3<f64>(y, LITERAL_1, x)));
}
