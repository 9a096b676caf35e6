//! The shader's text for f64: the same text, with other types and other literals.
//!
//! What is not the same for both formats (barriers, which look at bits; powers, which need longer polynomials) stands
//! between `//#if double` and `//#end` in `shaders/`.

/// The names of f32, and those of f64.
const NAMES: [(&str, &str); 6] = [
    ("f32", "f64"),
    ("vec2f", "vec2<f64>"),
    ("vec3f", "vec3<f64>"),
    ("vec4f", "vec4<f64>"),
    ("single", "f32"),
    ("inverseSqrt", "inverse_root"),
];

/// The text of a shader for f32 as one for f64. Names of single precision that stay so are written `single` in it.
pub fn double(text: &str) -> String {
    let mut doubled = String::with_capacity(text.len() + text.len() / 8);
    for line in text.lines() {
        let (code, comment) = line.split_at(line.find("//").unwrap_or(line.len()));
        words(code, &mut doubled);
        doubled.push_str(comment);
        doubled.push('\n');
    }
    doubled
}

/// Appends a line's names and numbers, one after the other, and what is between them.
fn words(mut code: &str, doubled: &mut String) {
    while let Some(first) = code.chars().next() {
        let end = match first {
            'a'..='z' | 'A'..='Z' | '_' => end_of_name(code),
            '0'..='9' => end_of_number(code),
            _ => first.len_utf8(),
        };
        let (word, rest) = code.split_at(end);
        match first {
            '0'..='9' => number(word, doubled),
            _ => {
                let known = NAMES.iter().find(|(single, _)| *single == word);
                doubled.push_str(known.map_or(word, |(_, double)| double));
            }
        }
        code = rest;
    }
}

fn end_of_name(code: &str) -> usize {
    let inside = |c: char| c.is_ascii_alphanumeric() || c == '_';
    code.find(|c| !inside(c)).unwrap_or(code.len())
}

/// Where a number ends that the text begins with: a sign belongs to it behind an exponent's letter.
fn end_of_number(code: &str) -> usize {
    let is_hexadecimal = code.starts_with("0x");
    let mut before = ' ';
    for (at, c) in code.char_indices() {
        let exponent = if is_hexadecimal { 'p' } else { 'e' };
        let signed = matches!(c, '+' | '-') && before == exponent;
        if !(c.is_ascii_alphanumeric() || c == '.' || signed) {
            return at;
        }
        before = c;
    }
    code.len()
}

/// Appends a number: one that is a float, by its point, exponent or suffix, is an f64.
fn number(word: &str, doubled: &mut String) {
    let is_hexadecimal = word.starts_with("0x");
    let float = if is_hexadecimal {
        word.contains('p')
    } else {
        word.contains(['.', 'e', 'f'])
    };
    let plain = if float && !word.ends_with("lf") {
        word.strip_suffix('f').unwrap_or(word)
    } else {
        word
    };
    doubled.push_str(plain);
    if float && !word.ends_with("lf") {
        doubled.push_str("lf");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_and_literals_become_those_of_f64() {
        for (single, doubled) in [
            ("var v: vec3f; // an f32", "var v: vec3<f64>; // an f32"),
            (
                "let x = 1.5 * f32(n) - 2f;",
                "let x = 1.5lf * f64(n) - 2lf;",
            ),
            ("0x1.8p-3f + 0x3f7fp+1f", "0x1.8p-3lf + 0x3f7fp+1lf"),
            ("0x1p-8f-1e-4", "0x1p-8lf-1e-4lf"),
            ("a.x+1u-0xffffffffu-7i-12", "a.x+1u-0xffffffffu-7i-12"),
            ("vec2<f32>(x_, 0.)", "vec2<f64>(x_, 0.lf)"),
            ("single(inverseSqrt(v))", "f32(inverse_root(v))"),
            ("0x1.99p-4lf * my_f32", "0x1.99p-4lf * my_f32"),
        ] {
            assert_eq!(double(single).trim_end(), doubled);
        }
    }
}
