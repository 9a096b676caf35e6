//! Numbers as WGSL literals that mean exactly them.

/// The f32 as a WGSL literal that means exactly it: a hexadecimal one, since a decimal one may be rounded either way.
pub fn literal(value: f32) -> String {
    let bits = value.to_bits();
    let sign = if bits >> 31 == 1 { "-" } else { "" };
    let exponent = (bits >> 23) & 0xff;
    let fraction = (bits & 0x7f_ffff) << 1;
    match exponent {
        // Subnormals may be flushed anyway; zero keeps the text short.
        0 => "0f".into(),
        // Larger than any f32: no scene that keeps its limits gets here but through overflow; the largest stands for
        // it.
        255 => format!("{sign}0x1.fffffep+127f"),
        _ => {
            let digits = format!("{fraction:06x}");
            let digits = digits.trim_end_matches('0');
            let point = if digits.is_empty() { "" } else { "." };
            format!("{sign}0x1{point}{digits}p{:+}f", exponent as i32 - 127)
        }
    }
}

/// A vector of f32 as WGSL.
pub fn vector(values: &[f32]) -> String {
    let list: Vec<String> = values.iter().map(|v| literal(*v)).collect();
    format!("vec{}f({})", values.len(), list.join(", "))
}
