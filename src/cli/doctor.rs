//! `plumb doctor`: what there is to render with, which of it would be used, and what to install if there is nothing.

use std::fmt::Write as _;

use anyhow::Result;
use plumb::gpu::adapters::{self, AdapterSummary, VARIABLE};
use plumb::probe::digits::count;
use plumb::render::install_hint;
use serde_json::json;

use super::{Answer, SOFTWARE, args, say};

/// What `plumb doctor` takes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Adapters come in plumb's order of preference: discrete, integrated, virtual, software. Each is put through the \
self-test: hard operands for + - * / sqrt, rounding, conversions, comparisons, exact sums and products behind a \
barrier. Exit 1: \
there is none that can be used or trusted, and the CPU renders. PLUMB_ADAPTER in the environment names one as \
--adapter does.")]
pub(crate) struct Args {
    /// Print the same as JSON
    #[arg(long)]
    json: bool,
}

/// Lists the adapters.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let adapters = adapters::list();
    let wanted = adapters::wanted_by_variable();
    let wanted = wanted.as_deref();
    let chosen = adapters.iter().position(|adapter| match wanted {
        Some(part) => adapter.is_named(part),
        None => adapter.problem.is_none(),
    });
    let text = if args.json {
        to_json(&adapters, chosen, wanted)
    } else {
        to_text(&adapters, chosen, wanted)
    };
    say::data(&text)?;
    let trusted = chosen.and_then(|i| adapters.get(i)).is_some_and(is_trusted);
    Ok(if trusted { Answer::Yes } else { Answer::No })
}

fn to_text(adapters: &[AdapterSummary], chosen: Option<usize>, wanted: Option<&str>) -> String {
    let mut text = String::new();
    for (i, adapter) in adapters.iter().enumerate() {
        let mark = if chosen == Some(i) { "*" } else { " " };
        let _ = writeln!(text, "{mark} {} ({})", adapter.name, adapter.kind);
        let mut line = |what: &str, value: String| {
            let _ = writeln!(text, "    {what:<16}{value}");
        };
        line("driver", adapter.driver.clone());
        line("interface", adapter.backend.clone());
        line(
            "storage buffer",
            format!("{} at most", bytes(adapter.max_storage_buffer)),
        );
        line("buffer", format!("{} at most", bytes(adapter.max_buffer)));
        line(
            "workgroup",
            format!("{} invocations at most", adapter.max_workgroup),
        );
        line("timestamps", yes(adapter.timestamps));
        line("f64 in shaders", yes(adapter.shader_f64));
        for (name, outcomes) in [
            ("self-test", &adapter.selftest),
            ("with f64", &adapter.selftest_f64),
        ] {
            let Some(outcomes) = outcomes else { continue };
            let failed: Vec<_> = outcomes
                .iter()
                .filter_map(|outcome| Some((outcome, outcome.failure.as_ref()?)))
                .collect();
            line(name, tested(outcomes.len(), failed.len()));
            for (outcome, failure) in failed {
                line(
                    "",
                    format!("{} ({}): {failure}", outcome.check, outcome.asked),
                );
            }
        }
        if let Some(problem) = &adapter.problem {
            line("cannot be used", problem.clone());
        }
    }
    let _ = writeln!(text, "  CPU, {}", count(args::cores(), "thread"));
    let _ = writeln!(text, "\n{}", verdict(adapters, chosen, wanted));
    text
}

/// How many checks of the arithmetic were passed.
fn tested(checks: usize, failed: usize) -> String {
    match failed {
        0 => format!("passed, {}", count(checks, "check")),
        _ => format!("{failed} of {} failed", count(checks, "check")),
    }
}

/// Whether certified pixels can come from it.
fn is_trusted(adapter: &AdapterSummary) -> bool {
    adapter
        .selftest
        .as_ref()
        .is_some_and(|outcomes| outcomes.iter().all(|outcome| outcome.failure.is_none()))
}

/// Which one, and why; `wanted` is what the environment asks for.
fn verdict(adapters: &[AdapterSummary], chosen: Option<usize>, wanted: Option<&str>) -> String {
    let named = wanted.map(|part| format!("{VARIABLE}={part}"));
    if let (Some(named), None, false) = (&named, chosen, adapters.is_empty()) {
        return format!(
            "{named} names none of the adapters, so plumb renders with --backend cpu alone."
        );
    }
    let Some(adapter) = chosen.and_then(|i| adapters.get(i)) else {
        let on_cpu = "plumb renders on the CPU";
        // What is there has its driver, and its problem stands above.
        if !adapters.is_empty() {
            return format!("{on_cpu}: none of the adapters can be used.");
        }
        let hint = install_hint();
        return format!("{on_cpu}: there is no GPU adapter.\nFor a GPU: {hint}.");
    };
    if let Some(problem) = &adapter.problem {
        return format!("plumb cannot render on {}: {problem}.", adapter.name);
    }
    if !is_trusted(adapter) {
        return format!(
            "plumb renders on the CPU: {} does not compute as WGSL asks, so nothing it says can be certified.\n\
             With --precision fast it is taken as it comes; --adapter PART-OF-NAME takes another one.",
            adapter.name
        );
    }
    let usable = adapters
        .iter()
        .filter(|adapter| adapter.problem.is_none())
        .count();
    let why = match (adapters.len(), usable) {
        _ if named.is_some() => format!("{} names it", named.unwrap_or_default()),
        (1, _) => "it is the only adapter".to_owned(),
        (_, 1) => "it is the only adapter that can be used".to_owned(),
        _ => format!(
            "of {usable} it comes first in the order discrete, integrated, virtual, software"
        ),
    };
    format!(
        "plumb renders on {}: {why}.\nAnother: --adapter PART-OF-NAME, or --backend cpu.",
        adapter.name
    )
}

fn to_json(adapters: &[AdapterSummary], chosen: Option<usize>, wanted: Option<&str>) -> String {
    let value = json!({
        "software": SOFTWARE,
        "adapters": adapters,
        "chosen": chosen,
        "verdict": verdict(adapters, chosen, wanted),
        "install": adapters.is_empty().then(install_hint),
        "cpu": { "threads": args::cores() },
    });
    format!("{value:#}\n")
}

fn yes(holds: bool) -> String {
    if holds { "yes" } else { "no" }.to_owned()
}

/// `128 MiB`, in the largest unit that leaves no fraction; a limit that is none as such.
fn bytes(n: u64) -> String {
    if n == u64::MAX {
        return "any size".to_owned();
    }
    let units = ["bytes", "KiB", "MiB", "GiB"];
    let (mut n, mut unit) = (n, 0);
    while unit + 1 < units.len() && n > 0 && n.is_multiple_of(1024) {
        n /= 1024;
        unit += 1;
    }
    format!("{n} {}", units[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(name: &str, problem: Option<&str>) -> AdapterSummary {
        AdapterSummary {
            name: name.to_owned(),
            kind: "software",
            backend: "Vulkan".to_owned(),
            driver: "driver 1".to_owned(),
            max_storage_buffer: 1 << 27,
            max_buffer: (1 << 31) - 1,
            max_workgroup: 1024,
            timestamps: true,
            shader_f64: false,
            problem: problem.map(str::to_owned),
            selftest: problem.is_none().then(Vec::new),
            selftest_f64: None,
        }
    }

    #[test]
    fn limits_are_readable() {
        assert_eq!(bytes(1 << 27), "128 MiB");
        assert_eq!(bytes(u64::from(u32::MAX)), "4294967295 bytes");
        assert_eq!(bytes(0), "0 bytes");
        assert_eq!(bytes(u64::MAX), "any size");
    }

    #[test]
    fn without_an_adapter_the_verdict_says_what_to_install() {
        assert!(verdict(&[], None, None).contains(install_hint()));
        let broken = [adapter("a", Some("it is too old"))];
        assert!(verdict(&broken, None, None).contains("none of the adapters can be used"));
        // Its driver is there: another one would not help.
        assert!(!verdict(&broken, None, None).contains("install"));
        assert!(to_text(&broken, None, None).contains("it is too old"));
    }

    #[test]
    fn an_adapter_that_fails_the_self_test_is_not_used() {
        let mut wrong = adapter("a", None);
        wrong.selftest = Some(vec![plumb::gpu::selftest::Outcome {
            check: "x + y",
            asked: "the nearest",
            cases: 7,
            failure: Some("x = 1 gave 3".to_owned()),
        }]);
        let text = to_text(&[wrong], Some(0), None);
        assert!(
            text.contains("self-test       1 of 1 check failed"),
            "{text}"
        );
        assert!(text.contains("x + y (the nearest): x = 1 gave 3"), "{text}");
        assert!(
            text.contains("renders on the CPU: a does not compute"),
            "{text}"
        );
    }

    #[test]
    fn the_adapter_that_is_used_is_marked_and_explained() {
        let two = [adapter("a", Some("it is too old")), adapter("b", None)];
        let text = to_text(&two, Some(1), None);
        assert!(text.contains("\n* b (software)"), "{text}");
        assert!(
            text.contains("plumb renders on b: it is the only adapter that can be used"),
            "{text}"
        );
    }

    #[test]
    fn the_environments_choice_is_told() {
        let mut two = [adapter("a", None), adapter("b", Some("it is too old"))];
        let names = verdict(&two, Some(0), Some("A"));
        assert!(
            names.contains("plumb renders on a: PLUMB_ADAPTER=A names it"),
            "{names}"
        );
        let broken = verdict(&two, Some(1), Some("b"));
        assert!(
            broken.contains("plumb cannot render on b: it is too old"),
            "{broken}"
        );
        let none = verdict(&two, None, Some("c"));
        assert!(none.contains("PLUMB_ADAPTER=c names none"), "{none}");
        two[1].problem = None;
        assert!(two[0].is_named("A [DRIVER") && !two[1].is_named("a ["));
    }
}
