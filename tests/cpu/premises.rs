//! docs/NUMERICS.md lists every premise and every constant of the error bounds; here is what keeps the list in step
//! with the code.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use plumb::shader::bounds::{Constant, LITERAL, NAMED, ROUNDING};

/// Files in which a constant that is not a whole number belongs to a bound.
const SOURCES: &[&str] = &[
    "src/real/bounded.rs",
    "src/real/pair.rs",
    "src/prepare/boxes.rs",
    "src/prepare/screen_grid.rs",
    "src/prepare/bvh.rs",
    "src/cpu/pixel.rs",
    "src/certify/lanes/lit/by_hand.rs",
    "src/shader/pack/lit.rs",
    "src/shader/pack/mod.rs",
    "src/prepare/world_plane.rs",
    "src/shader/pack/primary.rs",
    "src/shader/pack/projector.rs",
    "src/shader/pack/surface.rs",
    "shaders/branch.wgsl",
    "shaders/bvh.wgsl",
    "shaders/glint.wgsl",
    "shaders/light.wgsl",
    "shaders/plane.wgsl",
    "shaders/point.wgsl",
    "shaders/projector.wgsl",
    "shaders/quadric.wgsl",
    "shaders/sphere.wgsl",
    "shaders/surface.wgsl",
    "shaders/trace.wgsl",
    "shaders/unit.wgsl",
    "shaders/world.wgsl",
];

fn read(path: &str) -> Option<String> {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).ok()
}

/// A constant where it stands.
struct Stands {
    name: String,
    value: f64,
    least: Option<f64>,
    file: String,
}

/// The value of an expression of the code or of the table.
fn value(text: &str) -> Option<f64> {
    let text = text.replace('_', "").replace('−', "-");
    let binary = |sign: &str, apply: fn(f64, f64) -> f64| {
        let (left, right) = text.split_once(sign)?;
        Some(apply(value(left)?, value(right)?))
    };
    let shift = |text: &str| {
        let (_, places) = text.split_once("<<")?;
        Some(places.split(')').next()?.trim().parse::<f64>().ok()?.exp2())
    };
    let plain = text.trim().trim_end_matches('f');
    None.or_else(|| plain.parse().ok())
        .or_else(|| {
            plain
                .strip_prefix("f64::frombits(")?
                .strip_suffix(')')?
                .parse()
                .ok()
                .map(f64::from_bits)
        })
        .or_else(|| plain.strip_prefix("2^")?.parse::<f64>().ok().map(f64::exp2))
        .or_else(|| hexadecimal(plain))
        .or_else(|| binary(" + ", |a, b| a + b))
        .or_else(|| binary(" - ", |a, b| a - b))
        .or_else(|| binary(" · ", |a, b| a * b))
        .or_else(|| binary(" / ", |a, b| a / b))
        .or_else(|| binary("/", |a, b| a / b))
        .or_else(|| shift(plain))
}

/// A literal such as 0x1.8p-1.
fn hexadecimal(text: &str) -> Option<f64> {
    let (mantissa, exponent) = text.strip_prefix("0x1.")?.split_once('p')?;
    let bits = 4 * mantissa.len() as i32;
    let whole = u64::from_str_radix(mantissa, 16).ok()? as f64;
    Some((1.0 + whole / f64::from(bits).exp2()) * exponent.parse::<f64>().ok()?.exp2())
}

/// The constants of a file, but for those that are whole numbers or tests'.
fn constants(file: &str) -> Vec<Stands> {
    let text = read(file).unwrap();
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = code.lines().filter_map(|line| {
        let (_, rest) = line.split_once("const ")?;
        let (name, written) = rest.strip_suffix(';')?.split_once(" = ")?;
        let (name, kind) = name.split_once(": ").unwrap_or((name, ""));
        let whole = written.ends_with('u') || written.contains("vec");
        // `Number` is what a format's numbers are.
        let float = ["f64", "f32", "Number"].contains(&kind)
            || (kind.is_empty() && file.ends_with(".wgsl"));
        (float && !whole).then(|| Stands {
            name: name.to_owned(),
            value: value(written).unwrap_or_else(|| panic!("{file}: {line}")),
            least: None,
            file: file.to_owned(),
        })
    });
    lines.collect()
}

/// All constants of error bounds.
fn all() -> Vec<Stands> {
    let stands = |constant: &Constant| Stands {
        name: constant.name.to_owned(),
        value: constant.value,
        least: Some(constant.least),
        file: String::new(),
    };
    let rounding = Stands {
        name: "ROUNDING".to_owned(),
        value: ROUNDING,
        least: Some(ROUNDING),
        file: String::new(),
    };
    let named = NAMED.iter().chain(LITERAL).map(stands).chain([rounding]);
    named
        .chain(SOURCES.iter().flat_map(|file| constants(file)))
        .collect()
}

/// What stands between backticks.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// Whether two numbers are the same, to the digits that a table has.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (a.abs() - 1.0).abs().min(a.abs()) || a == b
}

/// What is wrong with a row about the place and the test that it names.
fn wrong_places(document: &str, name: &str, derived: &str, tried: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let there = ["\n**", "\n### ", "\n## ", ". **", " **"];
    if !there
        .iter()
        .any(|start| document.contains(&format!("{start}{derived}")))
    {
        faults.push(format!("{name}: there is no paragraph `{derived}`"));
    }
    let [file, test] = quoted(tried)[..] else {
        return vec![format!("{name}: no test is named")];
    };
    if !read(file).is_some_and(|text| text.contains(&format!("fn {test}()"))) {
        faults.push(format!("{name}: {file} has no test {test}"));
    }
    faults
}

/// What the document does not say as the code has it.
fn faults(document: &str, code: &[Stands]) -> Vec<String> {
    let mut faults = Vec::new();
    let mut rows = BTreeSet::new();
    let tables = document
        .split_once("\n## 11. ")
        .map_or("", |(_, tables)| tables);
    let premises = tables.split("### Constants").next().unwrap_or_default();
    for line in premises
        .lines()
        .filter(|line| line.starts_with("| ") && line.contains('`'))
    {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        faults.extend(wrong_places(document, cells[0], cells[2], cells[3]));
    }
    for line in tables.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [name, written, least, files, derived, tried] = cells[..] else {
            faults.push(format!("{line}: not six cells"));
            continue;
        };
        let (name, files) = (name.trim_matches('`'), quoted(files));
        let of = |file: &str| code.iter().find(|s| s.name == name && s.file == file);
        let found = files.iter().find_map(|file| of(file)).or_else(|| of(""));
        let Some(stands) = found else {
            faults.push(format!("{name}: the code has no such constant"));
            continue;
        };
        rows.insert((name.to_owned(), stands.file.clone()));
        if !value(written).is_some_and(|written| same(written, stands.value)) {
            faults.push(format!("{name} is {:e}, not {written}", stands.value));
        }
        let needed = value(least);
        if let (Some(needed), Some(stated)) = (needed, stands.least)
            && !same(needed, stated)
        {
            faults.push(format!("{name} has to be at least {stated:e}, not {least}"));
        }
        for file in files {
            if !read(file).is_some_and(|text| text.contains(name)) {
                faults.push(format!("{name}: not in {file}"));
            }
        }
        faults.extend(wrong_places(document, name, derived, tried));
    }
    let missing = code
        .iter()
        .filter(|s| !rows.contains(&(s.name.clone(), s.file.clone())));
    faults.extend(missing.map(|s| format!("{} {}: no row", s.name, s.file)));
    faults
}

#[test]
fn every_premise_and_constant_has_a_row_that_is_right() {
    let document = read("docs/NUMERICS.md").unwrap();
    let faults = faults(&document, &all());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let upper = ["LOWERED", "STEP_ERROR"];
    for constant in NAMED
        .iter()
        .chain(LITERAL)
        .filter(|c| !upper.contains(&c.name))
    {
        assert!(constant.value >= constant.least, "{constant:?}");
    }
}

/// What the test above has to notice.
#[test]
fn a_table_that_is_not_right_is_noticed() {
    let document = read("docs/NUMERICS.md").unwrap();
    for (right, wrong, complaint) in [
        ("| `TURN` | 1.02 |", "| `TURN` | 1.03 |", "TURN is"),
        (
            "| `TURN` | 1.02 | 1 |",
            "| `TURN` | 1.02 | 1.01 |",
            "TURN has to be",
        ),
        ("| `TURN` | 1.02 |", "| `TURNS` | 1.02 |", "TURN : no row"),
        ("| `GROW` | 1 + 1e-8 |", "| `GROW` | 1 + 1e-9 |", "GROW is"),
        (
            "`shaders/bvh.wgsl` | The tree",
            "`shaders/bvh_.wgsl` | The tree",
            "not in shaders/bvh_.wgsl",
        ),
        ("| The tree |", "| The trees |", "no paragraph `The trees`"),
        (
            "`one_wrong_word_is_noticed`",
            "`one_wrong_word`",
            "has no test one_wrong_word",
        ),
    ] {
        assert!(document.contains(right), "{right}");
        let found = faults(&document.replace(right, wrong), &all());
        assert!(
            found.iter().any(|fault| fault.contains(complaint)),
            "{complaint}: {found:?}"
        );
    }
    // A constant that the code has and the document has not.
    let mut code = all();
    code.push(Stands {
        name: "NEW_ROUNDINGS".into(),
        value: 3.0,
        least: Some(3.0),
        file: String::new(),
    });
    assert_eq!(faults(&document, &code), ["NEW_ROUNDINGS : no row"]);
}
