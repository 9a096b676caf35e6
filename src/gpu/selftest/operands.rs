//! Pairs of operands for which rounding is hard: neighbours of powers of two, halves, ties, cancellation, subnormals.

/// Numbers that are paired with each other, all with all.
#[rustfmt::skip]
const SPECIAL: [u32; 40] = [
    0x0000_0000, 0x8000_0000, // 0, −0
    0x0000_0001, 0x007f_ffff, 0x0040_0000, 0x8000_0001, // subnormals
    0x0080_0000, 0x0080_0001, 0x8080_0000, // 2⁻¹²⁶ and its neighbour
    0x0d80_0000, 0x2180_0000, 0x2180_0001, // 2⁻¹⁰⁰, 2⁻⁶⁰
    0x3f00_0000, 0x3eff_ffff, 0x3f00_0001, 0xbf00_0000, // ½
    0x3f80_0000, 0x3f80_0001, 0x3f7f_ffff, 0xbf80_0000, 0xbf80_0001, // 1
    0x3fc0_0000, 0x4020_0000, 0xbfc0_0000, 0xc020_0000, // 1½, 2½
    0x3fff_ffff, 0x4040_0000, 0x3eaa_aaab, 0x3dcc_cccd, // 2⁻, 3, ⅓, 1/10
    0x4580_0800, // 4,097
    0x4aff_ffff, 0x4b00_0001, 0xcaff_ffff, // 2²³ ± ½ or 1
    0x4b7f_ffff, 0x4b80_0001, // 2²⁴
    0x4eff_ffff, 0xcf00_0000, // ±2³¹
    0x7180_0000, 0x7e80_0000, // 2¹⁰⁰, 2¹²⁶
    0x7f7f_ffff, // the largest
];

/// Random pairs, of five kinds in turn.
const RANDOM: usize = 2496;

/// Bit patterns of all pairs: always the same, finite, a multiple of 64 of them.
pub(super) fn operands() -> Vec<[u32; 2]> {
    let mut pairs = all_with_all(&SPECIAL);
    let mut random = random();
    let mut next = || (random() >> 32) as u32;
    for i in 0..RANDOM {
        let (p, q, r) = (next(), next(), next());
        // Sign and fraction of `bits`, an exponent of `width` values around 0.
        let number = |bits: u32, r: u32, width: u32| {
            bits & 0x807f_ffff | (127 - width / 2 + r % width) << 23
        };
        pairs.push(match i % 5 {
            // Operands of about the same size.
            0 => [number(p, 0, 2), number(q, r, 2)],
            // Operands of any ordinary size.
            1 => [number(p, r, 60), number(q, r >> 16, 60)],
            // Operands that are nearly opposite: all but their last bits cancel.
            2 => {
                let x = number(p, r, 40);
                [x, (x ^ 0x8000_0000).wrapping_add(q % 9).wrapping_sub(4)]
            }
            // Short fractions, whose sums and products end near a half of the last place.
            3 => [
                number(p & 0xffff_f000, r, 24),
                number(q & 0xffff_f000 | 0x800, r >> 16, 24),
            ],
            // Long runs of ones, whose roots and quotients end near a half of the last place.
            _ => [
                number(0x007f_ffff ^ 1 << (p % 23), r, 30),
                number(0x007f_ffff >> (q % 23), r >> 16, 30),
            ],
        });
    }
    pairs
}

/// Every number with every one.
pub(super) fn all_with_all<T: Copy>(numbers: &[T]) -> Vec<[T; 2]> {
    let with_all = |a: &T| numbers.iter().map(|b| [*a, *b]).collect::<Vec<_>>();
    numbers.iter().flat_map(with_all).collect()
}

/// Random bits, always the same: Xorshift64*.
pub(super) fn random() -> impl FnMut() -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        state.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }
}
