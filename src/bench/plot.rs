//! The report as a picture: time across, error up, a panel a scene, a point a way, and the front that nothing beats.
//! Told apart by shape and fill, so that black and white will do.

use super::labels::{LINE, labels, text_width};
use super::markers::{MARK, mark, nested};
use super::statistics::pareto;
use super::svg::{Anchor, Svg};
use super::table::short;
use super::ways::Way;
use super::{Report, SceneReport};

/// A panel with its titles and axes.
const PANEL: (f64, f64) = (470.0, 370.0);
/// Around the plotted rectangle: left, top, right, bottom.
const MARGIN: [f64; 4] = [78.0, 34.0, 14.0, 50.0];
/// Above and below all panels, without the lines of text that stand there; and a line of it.
const HEAD: f64 = 28.0;
const FOOT: f64 = 26.0;
const CAPTION: f64 = 15.0;
/// Left and right of captions.
const EDGE: f64 = 14.0;
/// Height of the strip for pictures without a wrong pixel.
const FLOOR: f64 = 64.0;

/// Draws the report.
#[must_use]
pub fn plot(report: &Report) -> String {
    let count = report.scenes.len();
    let columns = match count {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let rows = count.div_ceil(columns).max(1);
    let width = (columns as f64 * PANEL.0).max(620.0);
    let room = width - 2.0 * EDGE;
    let machine = &report.machine;
    let gpu = match (&machine.adapter, &machine.driver) {
        (Some(adapter), Some(driver)) => format!("{adapter}, {driver}"),
        (Some(adapter), None) => adapter.clone(),
        (None, _) => "no GPU".to_owned(),
    };
    let cpu = format!("CPU: {}, {} threads", machine.cpu, machine.threads);
    let mut head = wrap(&format!("GPU: {gpu}"), room);
    head.extend(wrap(&cpu, room));
    let runs = match report.repeat {
        1 => "one run".to_owned(),
        n => format!("the median of {n} runs, whiskers the fastest and the slowest"),
    };
    let whiskers = format!("{runs}; a frame is from the scene to its bytes, compiling included");
    let left_out: Vec<String> = report.scenes.iter().flat_map(left_out).collect();
    let last = match left_out.as_slice() {
        [] => report.software.clone(),
        some => format!("{}; not available: {}", report.software, some.join(", ")),
    };
    let mut foot = wrap(&whiskers, room);
    foot.extend(wrap(&last, room));
    let top = HEAD + CAPTION * head.len() as f64;
    let bottom = top + rows as f64 * PANEL.1;
    let height = bottom + FOOT + CAPTION * foot.len() as f64;

    let mut svg = Svg::default();
    let title = "font-size='15' font-weight='bold'";
    svg.text((EDGE, 22.0), Anchor::Start, title, "Error against time");
    captions(&mut svg, HEAD + 11.0, &head);
    for (i, scene) in report.scenes.iter().enumerate() {
        let origin = (
            (i % columns) as f64 * PANEL.0,
            top + (i / columns) as f64 * PANEL.1,
        );
        panel(&mut svg, origin, scene);
    }
    let front = bottom + 14.0;
    svg.line(&[(EDGE, front - 4.0), (EDGE + 30.0, front - 4.0)], FRONT);
    let meaning = "the front: no way is both faster and nearer to the truth";
    svg.text((EDGE + 36.0, front), Anchor::Start, "", meaning);
    captions(&mut svg, front + CAPTION, &foot);
    svg.finish(width, height, "Error against time")
}

/// Lines of text, the first at this height.
fn captions(svg: &mut Svg, y: f64, lines: &[String]) {
    for (line, text) in lines.iter().enumerate() {
        let y = y + CAPTION * line as f64;
        svg.text((EDGE, y), Anchor::Start, "", text);
    }
}

/// A text in lines that are no wider than `room`; of a word that is wider alone, a path perhaps, its end.
fn wrap(text: &str, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        let word = &end_of(word, room);
        match lines.last_mut() {
            Some(line) if text_width(line) + text_width(word) + text_width(" ") <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.clone()),
        }
    }
    lines
}

/// The end of a text, if all of it is wider than `room`.
fn end_of(text: &str, room: f64) -> String {
    if text_width(text) <= room {
        return text.to_owned();
    }
    let mut end: Vec<char> = text.chars().rev().collect();
    while text_width(&end.iter().collect::<String>()) > room - text_width("…")
        && end.pop().is_some()
    {}
    end.push('…');
    end.iter().rev().collect()
}

const FRONT: &str = "stroke='#555' stroke-width='1.5' stroke-dasharray='6 3'";

/// Ways that have no point.
fn left_out(scene: &SceneReport) -> Vec<String> {
    let missing = scene.ways.iter().filter(|way| way.not_available.is_some());
    missing
        .map(|way| format!("{} ({})", way.name, scene.scene))
        .collect()
}

/// A way's place: time in ms with its spread, wrong pixels in percent.
struct Point {
    way: Way,
    ms: f64,
    spread: [f64; 2],
    error: f64,
}

fn points(scene: &SceneReport) -> Vec<Point> {
    let point = |way: &super::WayReport| {
        let frame = &way.seconds.as_ref()?.frame;
        Some(Point {
            way: way.way,
            ms: 1e3 * frame.median,
            spread: [1e3 * frame.min, 1e3 * frame.max],
            error: way.error.as_ref()?.wrong_percent,
        })
    };
    scene.ways.iter().filter_map(point).collect()
}

/// How values become places in a panel.
#[derive(Debug)]
struct Axes {
    /// Left, top, right, bottom of what is plotted, the strip for no error included.
    frame: [f64; 4],
    /// Powers of ten at both ends: of ms, and of percent.
    time: [f64; 2],
    error: [f64; 2],
}

impl Axes {
    fn new((x, y): (f64, f64), scene: &SceneReport, points: &[Point]) -> Self {
        let [left, top, right, bottom] = MARGIN;
        let times = || points.iter().flat_map(|p| p.spread).filter(|t| *t > 0.0);
        let least = times().fold(f64::INFINITY, f64::min).log10() - 0.15;
        let most = times().fold(0.0, f64::max).log10() + 0.15;
        let time = if least.is_finite() && most.is_finite() {
            // At least a decade, or small differences look large.
            let missing = (1.0 - (most - least)).max(0.0) / 2.0;
            [least - missing, most + missing]
        } else {
            [0.0, 1.0]
        };
        let pixel = (100.0 / scene.pixels().max(1) as f64).log10().floor();
        Self {
            frame: [x + left, y + top, x + PANEL.0 - right, y + PANEL.1 - bottom],
            time,
            // The axis runs from one pixel to all of them.
            error: [pixel.min(1.0), 2.0],
        }
    }

    fn x(&self, ms: f64) -> f64 {
        let [left, _, right, _] = self.frame;
        let [from, to] = self.time;
        let share = (ms.max(1e-9).log10() - from) / (to - from);
        left + share.clamp(0.0, 1.0) * (right - left)
    }

    fn y(&self, percent: f64) -> f64 {
        let [_, top, _, bottom] = self.frame;
        if percent <= 0.0 {
            return bottom - FLOOR / 2.0;
        }
        let [from, to] = self.error;
        let share = (percent.log10() - from) / (to - from);
        let lowest = bottom - FLOOR - 8.0;
        lowest - share.clamp(0.0, 1.0) * (lowest - top - 8.0)
    }
}

fn panel(svg: &mut Svg, origin: (f64, f64), scene: &SceneReport) {
    let points = points(scene);
    let axes = Axes::new(origin, scene, &points);
    draw_axes(svg, &axes, scene);
    let places: Vec<(f64, f64)> = points
        .iter()
        .map(|p| (axes.x(p.ms), axes.y(p.error)))
        .collect();
    let beaten: Vec<(f64, f64)> = points.iter().map(|p| (p.ms, p.error)).collect();
    let front = pareto(&beaten);
    let [_, top, right, _] = axes.frame;
    if let (Some(first), Some(last)) = (front.first(), front.last()) {
        let mut stairs = vec![(places[*first].0, top)];
        for &i in &front {
            let (x, y) = places[i];
            stairs.push((x, stairs[stairs.len() - 1].1));
            stairs.push((x, y));
        }
        stairs.push((right, places[*last].1));
        svg.line(&stairs, FRONT);
    }
    let sizes = nested(&places);
    for (point, &(_, y)) in points.iter().zip(&places) {
        let [from, to] = point.spread.map(|ms| axes.x(ms));
        svg.line(&[(from, y), (to, y)], "stroke='black' stroke-width='0.8'");
        for end in [from, to] {
            svg.line(
                &[(end, y - 3.0), (end, y + 3.0)],
                "stroke='black' stroke-width='0.8'",
            );
        }
    }
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| sizes[b].total_cmp(&sizes[a]));
    for i in order {
        mark(svg, points[i].way, places[i], sizes[i]);
    }
    let texts: Vec<String> = points
        .iter()
        .map(|p| format!("{}, {} ms", p.way.name(), short(p.ms)))
        .collect();
    for ((text, label), &(x, y)) in texts
        .iter()
        .zip(labels(&texts, &places, &sizes, axes.frame))
        .zip(&places)
    {
        let [left, top, right, bottom] = label;
        if top > y + 2.0 * LINE
            || bottom < y - 2.0 * LINE
            || left > x + 3.0 * MARK
            || right < x - 3.0 * MARK
        {
            let near = (x.clamp(left, right), y.clamp(top + 2.0, bottom - 2.0));
            svg.line(&[(x, y), near], "stroke='#888' stroke-width='0.6'");
        }
        svg.rectangle(
            [left, top, right - left, bottom - top],
            "fill='white' fill-opacity='0.75'",
        );
        svg.text((left + 2.0, bottom - 3.0), Anchor::Start, "", text);
    }
}

fn draw_axes(svg: &mut Svg, axes: &Axes, scene: &SceneReport) {
    let [left, top, right, bottom] = axes.frame;
    let middle = (left + right) / 2.0;
    let size = format!(", {}×{}", scene.width, scene.height);
    // Bold letters are wider. A path that is too long keeps its end, which is the file's name.
    let room = (PANEL.0 - 2.0 * EDGE) / 1.15 - text_width(&size);
    let title = end_of(&scene.scene, room) + &size;
    svg.text(
        (middle, top - 10.0),
        Anchor::Middle,
        "font-weight='bold'",
        &title,
    );
    let strip = [left, bottom - FLOOR, right - left, FLOOR];
    svg.rectangle(strip, "fill='url(#hatch)' stroke='#999' stroke-width='0.6'");
    svg.text(
        (left - 6.0, bottom - FLOOR / 2.0 + 4.0),
        Anchor::End,
        "font-weight='bold'",
        "none",
    );
    let grid = "stroke='#ddd' stroke-width='0.6'";
    for power in axes.error[0] as i32..=axes.error[1] as i32 {
        let percent = 10f64.powi(power);
        let y = axes.y(percent);
        svg.line(&[(left, y), (right, y)], grid);
        let text = if power < -3 {
            format!("1e{power} %")
        } else {
            format!("{percent} %")
        };
        svg.text((left - 6.0, y + 4.0), Anchor::End, "", &text);
    }
    let [from, to] = axes.time;
    for power in from.floor() as i32..=to.ceil() as i32 {
        for step in [1.0, 2.0, 5.0] {
            let ms = step * 10f64.powi(power);
            if !(from..=to).contains(&ms.log10()) {
                continue;
            }
            let x = axes.x(ms);
            svg.line(&[(x, top), (x, bottom)], grid);
            // Over many decades only the powers of ten have room.
            if step == 1.0 || to - from < 3.0 {
                let text = format!("{}", (ms * 1e9).round() / 1e9);
                svg.text((x, bottom + 14.0), Anchor::Middle, "", &text);
            }
        }
    }
    let frame = [left, top, right - left, bottom - top];
    svg.rectangle(frame, "fill='none' stroke='black' stroke-width='0.8'");
    let across = "time of a frame, ms (log)";
    svg.text((middle, bottom + 32.0), Anchor::Middle, "", across);
    let (x, y) = (left - 62.0, (top + bottom) / 2.0);
    let turned = format!("transform='rotate(-90 {x:.1} {y:.1})'");
    svg.text((x, y), Anchor::Middle, &turned, "wrong pixels (log)");
}

#[cfg(test)]
mod tests {
    use super::super::svg::tests::well_formed;
    use super::super::tests::report;
    use super::*;

    #[test]
    fn the_plot_is_a_document_with_everything_in_it() {
        let report = report();
        let text = plot(&report);
        assert!(well_formed(&text).unwrap() > 60);
        for word in [
            "room.txt, 40×30",
            "GPU: Card, Driver 1",
            "GPU certified, 2.00 ms",
            "f32 naive, 1.00 ms",
            "time of a frame, ms (log)",
            "wrong pixels (log)",
            ">none<",
            "not available: CPU plain f64 (room.txt)",
        ] {
            assert!(text.contains(word), "no {word:?} in {text}");
        }
        let mut several = report.clone();
        several.scenes = vec![report.scenes[0].clone(); 5];
        assert_eq!(plot(&several).matches("room.txt, 40×30").count(), 5);
        several.scenes.clear();
        assert!(well_formed(&plot(&several)).is_ok());
    }

    #[test]
    fn more_error_is_higher_and_more_time_farther_right() {
        let report = report();
        let scene = &report.scenes[0];
        let axes = Axes::new((0.0, 0.0), scene, &points(scene));
        assert!(axes.y(0.0) > axes.y(0.1) && axes.y(0.1) > axes.y(100.0));
        assert!(axes.x(1.0) < axes.x(2.0));
        // One pixel of 1,200 is above the strip.
        assert!(axes.y(100.0 / 1200.0) < axes.frame[3] - FLOOR);
    }

    /// Of one panel the picture is narrow, and names of machines are long.
    #[test]
    fn no_caption_leaves_the_picture() {
        let mut report = report();
        report.machine.adapter = Some("A card with a name that goes on ".repeat(5));
        report.scenes[0].scene = format!("{}room.txt", "folder/".repeat(30));
        let text = plot(&report);
        let number = |of: &str, line: &str| -> f64 {
            let (_, rest) = line.split_once(of).unwrap();
            rest.split('\'').nth(1).unwrap().parse().unwrap()
        };
        let width = number(
            "<svg",
            text.replace("xmlns='http://www.w3.org/2000/svg'", "")
                .as_str(),
        );
        let mut captions = 0;
        for line in text.lines().filter(|line| line.starts_with("<text")) {
            let (_, told) = line.split_once('>').unwrap();
            let told = told.trim_end_matches("</text>");
            if line.contains("text-anchor='start'") && number("<text x", line) == EDGE {
                captions += 1;
                assert!(EDGE + text_width(told) <= width, "{told}");
            }
        }
        assert!(captions > 6, "{captions}");
        assert!(
            text.contains("folder/room.txt, 40×30") && text.contains(">…"),
            "{text}"
        );
    }
}
