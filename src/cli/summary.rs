//! How a rendering went, in words.

use std::time::Duration;

use plumb::certify::DecidedBy;
use plumb::image::Target;
use plumb::probe::digits::count;
use plumb::render::{Backend, Precision, Report};

use super::Answer;

/// `walls.ppm: 640×480, GPU llvmpipe (LLVM 15.0.6), 0.21 s; certified, 0.26 % decided on the CPU: f64 780, tie 2`.
pub(crate) fn summary(target: &Target, report: &Report, took: Duration) -> String {
    let [start, end] = report.rows;
    let mut size = format!("{}×{}", report.width, end - start);
    if end - start != report.height {
        size += &format!(" (rows {start}..{end} of {})", report.height);
    }
    let seconds = took.as_secs_f64();
    let (who, decided) = (makers(report), decided(report));
    let mut line = format!("{target}: {size}, {who}, {seconds:.2} s; {decided}");
    let outrun = report.workers.iter().find(|worker| worker.is_outrun());
    if let Some(name) = report
        .left_out
        .as_deref()
        .or(outrun.map(|worker| &*worker.name))
    {
        line += &format!(
            "; {} is software and slower here: --backend gpu takes it",
            short(name)
        );
    }
    line
}

/// Who made the picture, and if there are several, how much of it.
fn makers(report: &Report) -> String {
    let made = || report.workers.iter().filter(|worker| worker.bands > 0);
    let makers: Vec<_> = made()
        .map(|worker| {
            let who = if worker.is_device() {
                format!("GPU {}", short(&worker.name))
            } else {
                format!("CPU, {}", count(report.threads.unwrap_or(1), "thread"))
            };
            if made().count() == 1 {
                return who;
            }
            let percent = 100.0 * worker.pixels as f64 / report.pixels as f64;
            format!("{who} ({percent:.0} %)")
        })
        .collect();
    makers.join(" and ")
}

/// An adapter's name; its driver, in brackets behind it, is told by --json.
fn short(adapter: &str) -> &str {
    adapter.split(" [").next().unwrap_or(adapter)
}

/// What decided the pixels, in short.
fn decided(report: &Report) -> String {
    let counts = DecidedBy::ALL[1..]
        .iter()
        .filter(|by| report.decided.count(**by) > 0)
        .map(|by| format!("{} {}", by.name(), report.decided.count(*by)))
        .collect::<Vec<_>>()
        .join(", ");
    match (report.precision, report.backend, report.refined) {
        (Precision::Fast, Backend::Gpu, 0) => "fast, not certified".into(),
        (Precision::Fast, Backend::Gpu, refined) => {
            format!("fast, not certified, but for {refined} on the CPU")
        }
        (Precision::Certified, Backend::Gpu, 0) => "certified, all of it on the GPU".into(),
        (Precision::Certified, Backend::Gpu, _) => {
            let percent = report.refined_percent;
            let samples = if report.jitter.is_some() {
                let percent = report.refined_samples_percent;
                format!(" ({percent:.2} % of the samples)")
            } else {
                String::new()
            };
            format!("certified, {percent:.2} % decided on the CPU{samples}: {counts}")
        }
        _ => format!("certified: {counts}"),
    }
}

/// What has to be said of a rendering beside the summary.
pub(crate) fn told(report: &Report) -> Vec<String> {
    let mut lines: Vec<String> = report.fallback.iter().cloned().collect();
    if let Some(revoked) = &report.revoked {
        lines.push(format!(
            "{revoked}: its certificate is revoked, and others made its part of the picture. Please report this, with \
            `plumb doctor`"
        ));
    }
    if report.presumed > 0 {
        let at = |[x, y]: &[u32; 2]| format!("({x}, {y})");
        let mut named: Vec<String> = report.presumed_at.iter().map(at).collect();
        if report.presumed > named.len() as u64 {
            named.push("…".into());
        }
        lines.push(format!(
            "{} so near a border that it is presumed, not proven, to lie on it: {}",
            count(report.presumed as usize, "pixel"),
            named.join(", ")
        ));
    }
    lines
}

/// The answer to a rendering: no, if every byte had to be proven and some were not.
pub(crate) fn answer(strict: bool, report: &Report) -> Answer {
    if strict && report.presumed > 0 {
        Answer::No
    } else {
        Answer::Yes
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use plumb::render::{SamplePattern, Settings, WorkerReport, render};
    use plumb::scene::load_from;

    use super::*;

    fn report() -> Report {
        let text = "camera c { pixeldim 2 1 worlddim 2 2 viewpoint 1 1 1 }";
        let scene = load_from("scene", text.as_bytes(), Path::new(".")).unwrap();
        let settings = Settings {
            backend: Backend::Cpu,
            ..Settings::default()
        };
        render(&scene, &settings, &mut |_| Ok(())).unwrap()
    }

    fn device(name: &str, pixels: u64) -> WorkerReport {
        WorkerReport::device(name, pixels)
    }

    #[test]
    fn the_summary_says_who_made_how_much() {
        let mut report = report();
        report.workers.push(device("card [driver]", 6));
        report.pixels = 8;
        let line = |report: &Report| summary(&Target::Stdout, report, Duration::ZERO);
        let text = line(&report);
        assert!(
            text.contains(" (25 %) and GPU card (75 %), 0.00 s"),
            "{text}"
        );
        report.workers.pop();
        report.left_out = Some("soft [driver]".into());
        let text = line(&report);
        assert!(
            text.ends_with("; soft is software and slower here: --backend gpu takes it"),
            "{text}"
        );
    }

    #[test]
    fn presumed_pixels_are_named_and_strictly_the_answer_is_no() {
        let mut report = report();
        assert_eq!(told(&report), Vec::<String>::new());
        assert_eq!(answer(true, &report), Answer::Yes);
        report.presumed = 3;
        report.presumed_at = vec![[7, 9], [8, 9]];
        let told = told(&report).join("\n");
        assert!(told.starts_with("3 pixels so near"), "{told}");
        assert!(told.ends_with("(7, 9), (8, 9), …"), "{told}");
        assert_eq!(answer(true, &report), Answer::No);
        assert_eq!(answer(false, &report), Answer::Yes);
    }

    #[test]
    fn a_revoked_certificate_is_told() {
        let mut report = report();
        report.revoked = Some("adapter X was sure of a pixel".into());
        let told = told(&report).join("\n");
        assert!(told.contains("adapter X was sure") && told.contains("others made"));
    }

    #[test]
    fn the_summary_says_how_many_the_cpu_decided() {
        let mut report = report();
        let took = Duration::from_millis(210);
        let line = |report: &Report| summary(&Target::Stdout, report, took);
        assert!(
            line(&report).ends_with("0.21 s; certified: f64 2"),
            "{}",
            line(&report)
        );
        report.backend = Backend::Gpu;
        report.workers[0] = device("card [driver]", 2);
        report.refined = 2;
        report.refined_percent = 0.256;
        let text = line(&report);
        assert!(
            text.ends_with("GPU card, 0.21 s; certified, 0.26 % decided on the CPU: f64 2"),
            "{text}"
        );
        report.samples = 16;
        report.jitter = Some(SamplePattern::Hash);
        report.refined_samples_percent = 0.021;
        let text = line(&report);
        assert!(
            text.ends_with("certified, 0.26 % decided on the CPU (0.02 % of the samples): f64 2"),
            "{text}"
        );
        report.precision = Precision::Fast;
        assert!(line(&report).contains("fast, not certified"));
    }
}
