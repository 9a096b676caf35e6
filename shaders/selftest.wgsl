// What the certified path takes for granted of a device, tried out: src/gpu/selftest judges the results.

@group(0) @binding(0) var<storage, read> operands: array<vec2u>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4u>;
// Zero, which no compiler can know.
@group(0) @binding(2) var<storage, read> unknown: array<u32>;

var<private> zero: u32;

// The barrier: no identity of real arithmetic leads through it.
fn barrier(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ zero);
}

// x + y = sum + tail, exactly (Knuth).
fn two_sum(x: f32, y: f32) -> vec2f {
    let sum = barrier(x + y);
    let b = barrier(sum - x);
    let a = barrier(sum - b);
    return vec2f(sum, barrier(x - a) + barrier(y - b));
}

// x = high + low, each of 12 bits (Veltkamp).
fn split(x: f32) -> vec2f {
    let c = barrier(4097.0 * x);
    let high = barrier(c - barrier(c - x));
    return vec2f(high, barrier(x - high));
}

// x · y = product + tail, exactly (Dekker).
fn two_prod(x: f32, y: f32) -> vec2f {
    let product = barrier(x * y);
    let a = split(x);
    let b = split(y);
    let rest = barrier(barrier(barrier(a.x * b.x) - product) + barrier(a.x * b.y));
    return vec2f(product, barrier(rest + barrier(a.y * b.x)) + barrier(a.y * b.y));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    zero = unknown[0];
    let a = operands[id.x].x;
    let b = operands[id.x].y;
    let x = bitcast<f32>(a);
    let y = bitcast<f32>(b);
    let sum = two_sum(x, y);
    let product = two_prod(x, y);
    // This product is not folded before the driver sees it; the driver may fold it.
    var folded = LITERAL_0;
    folded *= LITERAL_1;
    // Below 2^-126 and back, by powers of two whose number no compiler knows.
    var chain = x;
    for (var i = 0u; i < 4u + unknown[0]; i += 1u) {
        chain *= 0x1p-40f;
    }
    for (var i = 0u; i < 4u + unknown[0]; i += 1u) {
        chain *= 0x1p40f;
    }
    // x + y + y/2 + y/4, each sum with its tail, in a loop: the last sum and the three tails.
    var sums = vec4f(x, 0.0, 0.0, 0.0);
    var term = y;
    for (var i = 0u; i < 3u + unknown[0]; i += 1u) {
        let total = barrier(sums.x + term);
        let b = barrier(total - sums.x);
        let a = barrier(total - b);
        sums = vec4f(total, barrier(sums.x - a) + barrier(term - b), sums.yz);
        term *= 0.5;
    }
    let at = id.x * RESULTS / 4u;
    results[at + 0u] = vec4u(
        bitcast<u32>(x + y),
        bitcast<u32>(x - y),
        bitcast<u32>(x * y),
        bitcast<u32>(x / y),
    );
    results[at + 1u] = vec4u(
        bitcast<u32>(sqrt(abs(x))),
        bitcast<u32>(inverseSqrt(abs(x))),
        bitcast<u32>(floor(x)),
        bitcast<u32>(round(x)),
    );
    results[at + 2u] = vec4u(
        bitcast<u32>(i32(x)),
        u32(abs(x)),
        bitcast<u32>(f32(bitcast<i32>(a))),
        bitcast<u32>(f32(a)),
    );
    results[at + 3u] = vec4u(
        bitcast<u32>(min(x, y)),
        bitcast<u32>(max(x, y)),
        bitcast<u32>(abs(x)),
        bitcast<u32>(select(x, y, x > y)),
    );
    results[at + 4u] = vec4u(
        u32(x > y) | u32(x >= y) << 1u | u32(abs(x) > abs(y)) << 2u | u32(x == y) << 3u,
        a + b,
        a - b,
        a * b,
    );
    results[at + 5u] = vec4u(
        (a << (b & 31u)) ^ (a >> (b & 31u)),
        bitcast<u32>(bitcast<i32>(a) * bitcast<i32>(b)),
        bitcast<u32>(bitcast<i32>(a) >> (b & 31u)),
        bitcast<u32>(barrier(x)),
    );
    results[at + 6u] = vec4u(
        bitcast<u32>(sum.x),
        bitcast<u32>(sum.y),
        bitcast<u32>(product.x),
        bitcast<u32>(product.y),
    );
    results[at + 7u] = vec4u(
        bitcast<u32>(LITERAL_0),
        bitcast<u32>(LITERAL_1),
        bitcast<u32>(LITERAL_2),
        bitcast<u32>(LITERAL_3),
    );
    results[at + 8u] = vec4u(
        bitcast<u32>(folded),
        bitcast<u32>(x * LITERAL_0),
        bitcast<u32>(x + LITERAL_1),
        bitcast<u32>(x / LITERAL_2),
    );
    results[at + 9u] = vec4u(
        u32(abs(x) > LITERAL_3),
        bitcast<u32>(dot(vec3f(x, LITERAL_0, y), vec3f(y, LITERAL_1, x))),
        bitcast<u32>(chain),
        bitcast<u32>(x * y) >> 23u & 255u,
    );
    results[at + 10u] = bitcast<vec4u>(sums);
    results[at + 11u] = vec4u(u32(abs(x * y) < 0x1p100f), 0u, 0u, 0u);
}
