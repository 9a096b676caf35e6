// The power of a glint's cosine, with bounds. Referee: `glint` in src/cpu/light.rs.
//
// The cosine is told from 1 by the distance of the two unit vectors, |a − b|² = 2 − 2·a·b, and its logarithm is taken
// of that difference: where the glint is bright, the difference is known far better than the cosine.

const LOG2_E_TWICE = 2.885390081777927;
const LN_2 = 0.6931471805599453;

// (1 − y)ⁿ or 2⁻¹⁰⁰, whichever is more, for y from 0 up to 1 and n up to MOST_SHININESS; and what share of that it may
// be off by. Sums and products alone: what a driver's own functions are off by need not be known.
fn power(y: f32, n: f32) -> vec2f {
    // x = m·2^e, m from √½ to √2.
    let x = barrier1(1.0 - y);
//#if double
    let e = (bitcast<i32>(single(x)) - 0x3f3504f3) >> 23u;
    let m = x * f32(bitcast<single>((127 - e) << 23u));
//#else
    let e = (bitcast<i32>(x) - 0x3f3504f3) >> 23u;
    let m = bitcast<f32>(bitcast<i32>(x) - (e << 23u));
//#end
    // log m = −2·artanh z
    let z = select(1.0 - m, y, e == 0) / (1.0 + m);
    let z2 = z * z;
//#if double
    let least = barrier1(1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 * (1.0 / 11.0 + z2 * (1.0 / 13.0 + z2 * (1.0 / 15.0
        + z2 * (1.0 / 17.0 + z2 * (1.0 / 19.0 + z2 * (1.0 / 21.0))))))));
//#else
    let least = 1.0 / 7.0;
//#end
    let part_of_log = barrier1(LOG2_E_TWICE * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * least))));
    let log = barrier1(f32(e) - part_of_log);
    let q = barrier1(max(n * log, -100.0));
    let whole = round(q);
    let w = (q - whole) * LN_2;
//#if double
    let last = barrier1(1.0 / 5040.0 + w * (1.0 / 40320.0 + w * (1.0 / 362880.0 + w * (1.0 / 3628800.0
        + w * (1.0 / 39916800.0 + w * (1.0 / 479001600.0 + w * (1.0 / 6227020800.0)))))));
//#else
    let last = 1.0 / 5040.0;
//#end
    let part = 1.0 + w * (1.0 + w * (1.0 / 2.0 + w * (1.0 / 6.0 + w * (1.0 / 24.0 + w * (1.0 / 120.0
        + w * (1.0 / 720.0 + w * last))))));
    let error = select((POWER_ROUNDINGS - LOG_ROUNDINGS * q) * U, 1.0, q == -100.0);
//#if double
    return vec2f(part * f32(bitcast<single>((i32(whole) + 127) << 23u)), error);
//#else
    return vec2f(part * bitcast<f32>((i32(whole) + 127) << 23u), error);
//#end
}

// The power of the cosine between the direction `half`, of any length, and a unit normal, at the upper end of what it
// may be; and what share of that it may be off by. The cosine may also be 0 or less where the share is 1.
fn glint_power(half: vec3f, half_error: f32, normal: vec3f, normal_error: f32, n: f32) -> vec2f {
    let half_2 = dot(half, half);
    let half_inverse = inverseSqrt(max(half_2, TINY_SQUARE));
    doubt |= !(half_2 * half_inverse > CLOSE_FROM * half_error) | (n > MOST_SHININESS);
    let apart = barrier(barrier(half * half_inverse) - normal);
    let apart_2 = dot(apart, apart);
    let distance = apart_2 * inverseSqrt(max(apart_2, TINY_SQUARE));
    let off = CLOSE * half_error * half_inverse + normal_error + DIRECTION_ROUNDINGS * U
        + APART_ROUNDINGS * U * distance;
    let near = max(distance - off, 0.0);
    let y = barrier1(0.5 * near * near);
    if y >= 1.0 {
        return vec2f(0.0);
    }
    let most = power(y, min(n, MOST_SHININESS));
    let spread = SECOND_ORDER * off * (distance + max(distance, off));
    return vec2f(most.x, min(max(n, 1.0) * spread / (1.0 - y), 1.0) + most.y);
}
