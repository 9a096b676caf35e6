//! Makes the table of procedural shaders from the list of `shaders/procedural/`, and names the commit for `--version`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

fn main() {
    println!("cargo:rerun-if-changed=shaders/procedural");
    println!("cargo:rerun-if-changed=src/procedural");
    let root = env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
    let out = env::var("OUT_DIR").expect("cargo sets it");
    let table = procedural_table(Path::new(&root));
    fs::write(Path::new(&out).join("procedural.rs"), table)
        .expect("the build folder can be written");
    println!("cargo:rustc-env=PLUMB_COMMIT={}", commit());
}

/// Rust source: a module a twin, the number of shaders of each family, their WGSL, and the dispatch by number.
fn procedural_table(root: &Path) -> String {
    let mut families: BTreeMap<&str, BTreeMap<u32, String>> =
        [("pplane", BTreeMap::new()), ("psphere", BTreeMap::new())].into();
    let folder = root.join("shaders/procedural");
    for entry in fs::read_dir(&folder).expect("shaders/procedural exists") {
        let name = entry
            .expect("the folder can be read")
            .file_name()
            .into_string()
            .expect("names are ASCII");
        let Some(stem) = name.strip_suffix(".wgsl") else {
            panic!("{name} in shaders/procedural is no .wgsl file")
        };
        let mut parts = stem.splitn(3, '_');
        let family = parts.next().unwrap_or_default();
        let number = parts.next().and_then(|n| n.parse().ok());
        let (Some(shaders), Some(number), Some(_)) =
            (families.get_mut(family), number, parts.next())
        else {
            panic!(
                "{name}: a procedural shader is called pplane_N_name.wgsl or psphere_N_name.wgsl"
            );
        };
        if let Some(other) = shaders.insert(number, stem.to_owned()) {
            panic!("{name} and {other}.wgsl have the same number");
        }
        let twin = root.join(format!("src/procedural/{stem}.rs"));
        assert!(
            twin.is_file(),
            "shaders/procedural/{name} has no second version in Rust, src/procedural/{stem}.rs"
        );
    }
    let mut source = String::new();
    for (family, shaders) in &families {
        for (expected, number) in (0..).zip(shaders.keys()) {
            assert!(
                expected == *number,
                "shaders/procedural: {family}_{expected} is missing, the numbers have a gap"
            );
        }
        for stem in shaders.values() {
            let twin = root.join(format!("src/procedural/{stem}.rs"));
            writeln!(
                source,
                "#[path = {:?}]\nmod {stem};",
                twin.display().to_string()
            )
            .expect("a string grows");
        }
        let upper = family.to_uppercase();
        let point = if *family == "pplane" {
            "impl PlanePoint<R>"
        } else {
            "SpherePoint<R>"
        };
        writeln!(
            source,
            "/// The number of {family} shaders.\npub const {upper}_SHADERS: u32 = {};\n\
             /// Each {family} shader, by number.\nconst {upper}: &[Shader] = &[",
            shaders.len()
        )
        .expect("a string grows");
        for stem in shaders.values() {
            let file = folder.join(format!("{stem}.wgsl")).display().to_string();
            writeln!(
                source,
                "    Shader {{ name: {stem:?}, wgsl: include_str!({file:?}), brightest: {stem}::brightest }},"
            )
            .expect("a string grows");
        }
        writeln!(
            source,
            "];\n/// The colour that {family} shader `shader` gives; the parser has checked the number.\n\
             ///\n/// # Errors\n/// If the number type cannot decide something.\n\
             #[allow(clippy::match_single_binding, reason = \"a family may have one shader\")]\n\
             pub fn {family}<R: Real>(shader: u32, at: &{point}) -> Result<V3<R>, Undecided> {{\n    match shader {{"
        )
        .expect("a string grows");
        let last = shaders.len() - 1;
        for (number, stem) in shaders {
            let pattern = if *number as usize == last {
                "_".to_owned()
            } else {
                number.to_string()
            };
            writeln!(source, "        {pattern} => {stem}::{stem}(at),").expect("a string grows");
        }
        writeln!(source, "    }}\n}}").expect("a string grows");
    }
    source
}

/// The short commit, with a plus if files differ from it; "unknown" outside a checkout (an unpacked archive).
fn commit() -> String {
    let git = |args: &[&str]| {
        let out = Command::new("git").args(args).output().ok()?;
        out.status
            .success()
            .then(|| String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    for path in ["HEAD", "index"] {
        if let Some(file) = git(&["rev-parse", "--git-path", path]) {
            println!("cargo:rerun-if-changed={file}");
        }
    }
    let Some(hash) = git(&["rev-parse", "--short=12", "HEAD"]) else {
        return "unknown".to_owned();
    };
    let changed = git(&[
        // It would write the index anew, which is what a change is told by: everything would be built twice.
        "--no-optional-locks",
        "status",
        "--porcelain",
        "--untracked-files=no",
    ])
    .is_some_and(|s| !s.is_empty());
    if changed { format!("{hash}+") } else { hash }
}
