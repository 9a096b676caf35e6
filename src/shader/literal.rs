//! Numbers as WGSL literals that mean exactly them: hexadecimal ones, since a decimal one may be rounded either way.

/// The f32 as a WGSL literal that means exactly it.
pub fn literal(value: f32) -> String {
    let limits = (f32::MIN_POSITIVE, f32::MAX);
    hexadecimal(value.into(), (limits.0.into(), limits.1.into()), "f")
}

/// The f64 as a WGSL literal that means exactly it.
pub fn literal_of_f64(value: f64) -> String {
    hexadecimal(value, (f64::MIN_POSITIVE, f64::MAX), "lf")
}

/// A vector of f32 as WGSL.
pub fn vector(values: &[f32]) -> String {
    let list: Vec<String> = values.iter().map(|v| literal(*v)).collect();
    format!("vec{}f({})", values.len(), list.join(", "))
}

/// A number of a type whose normal numbers have sizes within these limits.
fn hexadecimal(value: f64, (least, most): (f64, f64), suffix: &str) -> String {
    // Subnormals may be flushed anyway; zero keeps the text short.
    if value.abs() < least {
        return format!("0{suffix}");
    }
    // Larger than any number, or none: no scene that keeps its limits gets here but through overflow; the largest
    // stands for it.
    let size = value.abs().min(most);
    let sign = if value.is_sign_negative() { "-" } else { "" };
    let bits = size.to_bits();
    let digits = format!("{:013x}", bits & 0xf_ffff_ffff_ffff);
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    let exponent = (bits >> 52) as i32 - 1023;
    format!("{sign}0x1{point}{digits}p{exponent:+}{suffix}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_literal_is_the_number() {
        for (value, text) in [
            (1.0, "0x1p+0f"),
            (-0.75, "-0x1.8p-1f"),
            (f32::MAX, "0x1.fffffep+127f"),
            (f32::NEG_INFINITY, "-0x1.fffffep+127f"),
            (f32::MIN_POSITIVE, "0x1p-126f"),
            (1e-45, "0f"),
            (-0.0, "0f"),
        ] {
            assert_eq!(literal(value), text);
        }
        for (value, text) in [
            (0.1, "0x1.999999999999ap-4lf"),
            (-f64::MAX, "-0x1.fffffffffffffp+1023lf"),
            (f64::INFINITY, "0x1.fffffffffffffp+1023lf"),
            (5e-324, "0lf"),
        ] {
            assert_eq!(literal_of_f64(value), text);
        }
    }
}
