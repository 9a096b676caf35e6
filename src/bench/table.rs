//! The report as text: two tables a scene, of errors and of times, at most 100 columns wide.

use std::fmt::Write as _;

use super::machine::Machine;
use super::statistics::Times;
use super::ways::Way;
use super::{Report, SceneReport, WayReport};

/// Characters of the reason why there is nothing to say of a way.
const WHY: usize = 67;

/// The report for people.
#[must_use]
pub fn table(report: &Report) -> String {
    let mut text = format!("{}\n{}", report.software, machine(&report.machine));
    let runs = match report.repeat {
        1 => "one run".to_owned(),
        n => format!("the median of {n} runs (the fastest–the slowest)"),
    };
    let _ = writeln!(text, "times are {runs}, after one that does not count");
    for scene in &report.scenes {
        text += "\n";
        text += &scene_table(scene);
    }
    text += "\n";
    for way in Way::ALL {
        let _ = writeln!(text, "  {:<15}{}", way.name(), way.meaning());
    }
    text += "
  wrong, worst, RMS: bytes against the certified picture. t: distances along primary rays that see
  the right object, in units in the last place of f32. other: pixels that see another object.
  kernel: the dispatches, compiled before; on the CPU the tracing. frame: from the scene to the
  bytes, preparing and compiling included. cold: plumb render as a process, all caches of shaders
  and devices empty; warm: once more. The system's own cache of files is left as it is.
";
    text
}

/// The machine in lines.
fn machine(machine: &Machine) -> String {
    let gpu = match (&machine.adapter, &machine.no_gpu) {
        (Some(adapter), _) => {
            let driver = machine.driver.as_deref().unwrap_or("unknown");
            let clock = if machine.timestamps {
                "the device's clock"
            } else {
                "the host's clock"
            };
            format!("{adapter}, driver {driver}; kernels by {clock}")
        }
        (None, why) => why.clone().unwrap_or_default(),
    };
    let Machine {
        cpu,
        threads,
        system,
        ..
    } = machine;
    format!("GPU: {gpu}\nCPU: {cpu}, {threads} threads, {system}\n")
}

fn scene_table(scene: &SceneReport) -> String {
    let SceneReport {
        width,
        height,
        objects,
        lights,
        ..
    } = scene;
    let mut text = format!(
        "{}: {width}×{height}, objects {objects}, lights {lights}, {:.2} rays a pixel\n\n",
        scene.scene, scene.rays.all
    );
    let missing = |way: &WayReport| way.not_available.clone();
    text += &aligned(
        &[
            "error",
            "wrong px",
            "%",
            "worst",
            "RMS",
            "t: median",
            "99 %",
            "worst",
            "other",
            "doubtful %",
        ],
        &scene.ways,
        |way| missing(way).map_or_else(|| Ok(errors(way)), Err),
    );
    text += "\n";
    text += &aligned(
        &[
            "time, ms", "kernel", "", "frame", "", "cold", "warm", "Mpixel/s", "Mrays/s",
        ],
        &scene.ways,
        |way| missing(way).map_or_else(|| Ok(times(way)), Err),
    );
    text
}

fn errors(way: &WayReport) -> Vec<String> {
    let error = way.error.as_ref();
    let t = way.t.as_ref();
    let none = || "–".to_owned();
    let some = |value: Option<f64>| value.map_or_else(none, short);
    vec![
        error.map_or_else(none, |e| e.wrong.to_string()),
        some(error.map(|e| e.wrong_percent)),
        error.map_or_else(none, |e| e.worst.to_string()),
        some(error.map(|e| e.rms)),
        some(t.map(|t| t.median)),
        some(t.map(|t| t.percentile_99)),
        some(t.map(|t| t.worst)),
        t.map_or_else(none, |t| t.other_object.to_string()),
        some(way.doubtful_percent),
    ]
}

fn times(way: &WayReport) -> Vec<String> {
    let none = || "–".to_owned();
    let ms = |seconds: f64| short(1e3 * seconds);
    let median = |times: Option<&Times>| times.map_or_else(none, |t| ms(t.median));
    let spread = |times: Option<&Times>| {
        times.map_or_else(String::new, |t| format!("({}–{})", ms(t.min), ms(t.max)))
    };
    let some = |value: Option<f64>| value.map_or_else(none, short);
    let seconds = way.seconds.as_ref();
    let kernel = seconds.map(|s| &s.kernel);
    let frame = seconds.map(|s| &s.frame);
    vec![
        median(kernel),
        spread(kernel),
        median(frame),
        spread(frame),
        median(seconds.and_then(|s| s.cold.as_ref())),
        median(seconds.and_then(|s| s.warm.as_ref())),
        some(way.mpixels_per_second),
        some(way.rays_per_second.map(|rays| rays * 1e-6)),
    ]
}

/// A line for each way, its cells below the titles, all but the first to the right; or why there are none.
fn aligned(
    titles: &[&str],
    ways: &[WayReport],
    cells: impl Fn(&WayReport) -> Result<Vec<String>, String>,
) -> String {
    let rows: Vec<_> = ways.iter().map(|way| (way.name, cells(way))).collect();
    let count = |text: &str| text.chars().count();
    let widths: Vec<usize> = (1..titles.len())
        .map(|column| {
            let cells = rows
                .iter()
                .filter_map(|(_, cells)| cells.as_ref().ok()?.get(column - 1));
            cells
                .map(|cell| count(cell))
                .chain([count(titles[column])])
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = format!("  {:<15}", titles[0]);
    for (title, width) in titles[1..].iter().zip(&widths) {
        let _ = write!(text, "{title:>width$}  ");
    }
    text.truncate(text.trim_end().len());
    text += "\n";
    for (name, cells) in rows {
        let _ = write!(text, "  {name:<15}");
        match cells {
            Err(why) => {
                // What drivers say may be long; JSON has all of it.
                let first = why.lines().next().unwrap_or_default();
                let cut: String = first.chars().take(WHY).collect();
                let more = if cut.len() < why.len() { "…" } else { "" };
                let _ = write!(text, "not available: {cut}{more}");
            }
            Ok(cells) => {
                for (cell, width) in cells.iter().zip(&widths) {
                    let _ = write!(text, "{cell:>width$}  ");
                }
            }
        }
        text.truncate(text.trim_end().len());
        text += "\n";
    }
    text
}

/// Three digits that say something, however large or small the number.
#[must_use]
pub fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !size.is_finite() {
        return value.to_string();
    }
    // The limits are those of the rounded number: 9.999 is printed as 10.00 would be.
    let digits = |decimals: usize| format!("{value:.decimals$}");
    match size {
        1e6.. => format!("{value:.2e}"),
        99.95.. => digits(0),
        9.995.. => digits(1),
        0.9995.. => digits(2),
        0.000_999_5.. => {
            let decimals = (2 - size.log10().floor() as i32).clamp(0, 6) as usize;
            digits(decimals)
        }
        _ => format!("{value:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::report;
    use super::*;

    #[test]
    fn three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.00"),
            (9.996, "10.0"),
            (123.4, "123"),
            (99.96, "100"),
            (54_321.0, "54321"),
            (0.012_345, "0.0123"),
            (1.234e-5, "1.2e-5"),
            (12_345_678.0, "1.23e7"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn the_table_fits_and_says_what_is_missing() {
        let mut report = report();
        report.scenes[0].ways[4].not_available = Some(["no ", &"x".repeat(90), "\nmore"].concat());
        let text = table(&report);
        assert!(text.contains("xxx…") && !text.contains("more\n"), "{text}");
        for line in text.lines() {
            assert!(line.chars().count() <= 100, "{line}");
        }
        for word in [
            "room.txt: 40×30",
            "Card, driver Driver 1",
            "not available: no luck",
            "the median of 2 runs",
            "Mrays/s",
        ] {
            assert!(text.contains(word), "no {word:?} in {text}");
        }
        let exact = text
            .lines()
            .find(|line| line.contains("GPU certified"))
            .unwrap();
        let cells: Vec<&str> = exact.split_whitespace().collect();
        assert_eq!(cells[2..7], ["0", "0", "0", "0", "0.500"]);
    }
}
