#!/usr/bin/env python3
"""Makes the measured part of docs/BENCH.md, and the plots in docs/bench/: python3 scripts/bench.py [--quick] [--docs FOLDER]

Runs `plumb bench --json` over the gallery, over hard scenes, and over scenes that grow: pixels, spheres, lights, mirrors.
What stands in BENCH.md between the two marks is written anew, everything else stays; with --docs the page goes to that
folder instead. Raw reports are kept in target/bench/. --quick proves that all of it works, in a minute or two; its figures
are good for nothing. All of it takes less than ten minutes on two cores that have nothing else to do.

Needs target/release/plumb (cargo build --release) and Python's standard library.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLUMB = ROOT / "target" / "release" / "plumb"
RAW = ROOT / "target" / "bench"
BEGIN = "<!-- measured: written by scripts/bench.py, from here -->"
END = "<!-- measured: to here -->"

GALLERY = [
    "notes/walls",
    "notes/tiles",
    "notes/procedural",
    "gallery/spheres_over_tiles",
    "gallery/ring",
    "gallery/molecule",
    "gallery/planet",
    "gallery/tiles_floor",
    "gallery/pplane_slanted",
    "gallery/procedural_all",
    "lit/shadows_balls",
    "lit/mirror_balls",
    "lit/glass_balls",
    "lit/stained_glass",
    "lit/spotlight_stage",
    "lit/texture_stretched",
]
HARD = [
    "hard/sphere_tiny_far",
    "hard/sphere_one_pixel",
    "hard/limb_million",
    "hard/sphere_huge_far",
    "hard/light_years",
    "hard/millimetres",
    "hard/tiles_far",
    "hard/tiles_far_unresolved",
    "hard/plane_grazing_extreme",
    "hard/coincident_slanted",
    "hard/spheres_nearly_equal",
    "hard/lit_shadow_tangent",
]
GALLERY_PLOT = ["notes/walls", "gallery/spheres_over_tiles", "gallery/molecule", "lit/mirror_balls"]
HARD_PLOT = ["hard/sphere_tiny_far", "hard/light_years", "hard/tiles_far", "hard/lit_shadow_tangent"]


# --- measuring ---------------------------------------------------------------------------------------------------------


class Bench:
    """Runs `plumb bench`, and keeps what it said."""

    def __init__(self, quick, plots):
        self.quick = quick
        self.plots = plots
        self.machine = None
        self.software = None

    def run(self, name, scenes, size=None, repeat=3, plot=None):
        """The reports of scene files, in order."""
        command = [str(PLUMB), "bench", "--json", "--repeat", "1" if self.quick else str(repeat)]
        if size:
            command += ["--size", f"{size[0]}x{size[1]}"]
        if plot:
            command += ["--plot", str(self.plots / plot)]
        command += [os.path.relpath(scene, ROOT) for scene in scenes]
        start = time.monotonic()
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(f"bench.py: {' '.join(command)} ended with {done.returncode}")
        (RAW / f"{name}.json").write_text(done.stdout)
        report = json.loads(done.stdout)
        self.machine, self.software = report["machine"], report["software"]
        print(f"bench.py: {name}: {time.monotonic() - start:.0f} s", file=sys.stderr)
        return report["scenes"]


def of_ours(names):
    return [ROOT / "scenes" / f"{name}.txt" for name in names]


def spheres(n):
    """The landscape of n beads."""
    path = RAW / f"spheres_{n}.txt"
    made = subprocess.run(
        [sys.executable, str(ROOT / "scripts" / "make_spheres.py"), "--n", str(n)], stdout=subprocess.PIPE, check=True
    )
    path.write_bytes(made.stdout)
    return path


ROOM = """\
camera cam { pixeldim 640 360 worlddim 16 9 viewpoint 8 4.5 12 }
material floor_a { ambient 1 1 1 diffuse 4 4 4 }
material floor_b { ambient 0.5 0.6 0.8 diffuse 2 2 3 }
material wall { ambient 1 1 1.5 diffuse 3 3 4 }
tiled_plane floor { material floor_a normal 0 1 0 point 0 -0.5 0 altmaterial floor_b dimension 2 2 }
plane back { material wall normal 0 0 1 point 0 0 -20 }
"""


def balls(n, mirrors):
    """n balls on a floor, some of them mirrors."""
    text = ""
    for i in range(n):
        specular = " specular 0.6" if i < mirrors else ""
        text += f"material m{i} {{ ambient 1 {i % 3} {i % 2} diffuse 3 {1 + i % 3} 2{specular} }}\n"
        x, z = 1.5 + 3.2 * (i % 5) + 0.3 * (i // 5 % 2), -3 - 3.5 * (i // 5)
        text += f"sphere s{i} {{ material m{i} center {x:.2f} 0.9 {z:.2f} radius 1.4 }}\n"
    return text


def lights(n, total=30.0):
    """n lights on a ring above, that give the same light together."""
    text = ""
    for i in range(n):
        turn = 2 * math.pi * i / n
        x, z, each = 8 + 6 * math.cos(turn), -8 + 6 * math.sin(turn), total / n
        text += f"light l{i} {{ location {x:.3f} 9 {z:.3f} emissivity {each:.4f} {each:.4f} {each:.4f} }}\n"
    return text


def lit_room(name, balls_there, mirrors, lights_there):
    path = RAW / f"{name}.txt"
    path.write_text(ROOM + balls(balls_there, mirrors) + lights(lights_there))
    return path


# --- tables ------------------------------------------------------------------------------------------------------------


def short(value):
    """Three digits that say something."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    if abs(value) >= 1e6 or abs(value) < 1e-3:
        return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e")
    decimals = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def way(scene, name):
    return next(way for way in scene["ways"] if way["way"] == name)


def at(found, *keys):
    """A figure somewhere in a report, None where there is none."""
    for key in keys:
        if found is None:
            return None
        found = found[key]
    return found


def ms(scene, name, kind="kernel"):
    """Median milliseconds."""
    seconds = at(way(scene, name), "seconds", kind, "median")
    return None if seconds is None else 1e3 * seconds


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "|" + "---|" * len(titles)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def stem(scene):
    return pathlib.Path(scene["scene"]).stem


def times_table(scenes):
    titles = [
        "scene",
        "size",
        "rays a pixel",
        "certified, kernel",
        "frame",
        "fast, kernel",
        "frame",
        "CPU certified",
        "CPU plain",
        "b²−4ac",
        "naive",
    ]
    rows = []
    for s in scenes:
        rows.append(
            [stem(s), f"{s['width']}×{s['height']}", short(s["rays"]["all"])]
            + [
                short(v)
                for v in (
                    ms(s, "gpu_certified"),
                    ms(s, "gpu_certified", "frame"),
                    ms(s, "gpu_fast"),
                    ms(s, "gpu_fast", "frame"),
                    ms(s, "cpu_certified"),
                    ms(s, "cpu_plain"),
                    ms(s, "f32_quadratic"),
                    ms(s, "f32_naive"),
                )
            ]
        )
    return table(titles, rows)


def errors_table(scenes):
    def wrong(s, name):
        error = way(s, name)["error"]
        if error is None:
            return "–"
        percent = short(error["wrong_percent"])
        return percent if error["wrong"] == 0 else f"{percent} ({error['worst']})"

    def t(s, name):
        found = way(s, name)["t"]
        return "–" if found is None else " / ".join(short(found[k]) for k in ("median", "percentile_99", "worst"))

    titles = [
        "scene",
        "doubtful %",
        "wrong %: certified",
        "fast",
        "b²−4ac",
        "naive",
        "t in ulp: certified",
        "fast",
        "b²−4ac",
        "naive",
    ]
    names = ("gpu_certified", "gpu_fast", "f32_quadratic", "f32_naive")
    rows = [
        [stem(s), short(way(s, "gpu_certified")["doubtful_percent"])]
        + [wrong(s, n) for n in names]
        + [t(s, n) for n in names]
        for s in scenes
    ]
    return table(titles, rows)


def processes_table(scene):
    """Cold and warm processes of a scene."""
    rows = []
    for name in ("gpu_certified", "gpu_fast", "cpu_certified"):
        seconds = way(scene, name)["seconds"]
        spread = lambda t: (
            "–" if t is None else f"{short(1e3 * t['median'])} ({short(1e3 * t['min'])}–{short(1e3 * t['max'])})"
        )
        rows.append([way(scene, name)["name"], spread(at(seconds, "cold")), spread(at(seconds, "warm"))])
    return table(["process, ms", "cold", "warm"], rows)


def growth_table(what, values, scenes):
    titles = [
        what,
        "rays a pixel",
        "certified, Mpixel/s",
        "fast",
        "CPU certified",
        "CPU plain",
        "b²−4ac",
        "naive",
        "certified, frame ms",
        "process, warm, ms",
    ]
    rows = []
    for value, s in zip(values, scenes):
        speeds = [way(s, n)["mpixels_per_second"] for n in WAYS]
        rows.append(
            [value, short(s["rays"]["all"])]
            + [short(v) for v in speeds + [ms(s, "gpu_certified", "frame"), ms(s, "gpu_certified", "warm")]]
        )
    return table(titles, rows)


WAYS = {
    "gpu_certified": "GPU certified",
    "gpu_fast": "GPU fast",
    "cpu_certified": "CPU certified",
    "cpu_plain": "CPU plain f64",
    "f32_quadratic": "f32 b²−4ac",
    "f32_naive": "f32 naive",
}


# --- growth, drawn -----------------------------------------------------------------------------------------------------

DASHES = {
    "gpu_certified": "",
    "gpu_fast": "",
    "cpu_certified": "6 3",
    "cpu_plain": "6 3",
    "f32_quadratic": "2 3",
    "f32_naive": "2 3",
}


def marker(name, x, y):
    """The same shapes as in `plumb bench --plot`."""
    m, fill = 4, "black" if name in ("gpu_certified", "cpu_certified") else "white"
    style = f"fill='{fill}' stroke='black' stroke-width='1.3'"
    if name.startswith("gpu"):
        return f"<rect x='{x - m:.1f}' y='{y - m:.1f}' width='{2 * m}' height='{2 * m}' {style}/>"
    if name.startswith("cpu"):
        return f"<circle cx='{x:.1f}' cy='{y:.1f}' r='{m}' {style}/>"
    if name == "f32_quadratic":
        return f"<path d='M{x:.1f},{y - 1.2 * m:.1f} l{m},{2.2 * m:.1f} h{-2 * m} z' {style}/>"
    return f"<path d='M{x - m:.1f},{y - m:.1f} l{2 * m},{2 * m} m0,{-2 * m} l{-2 * m},{2 * m}' fill='none' stroke='black' stroke-width='1.8'/>"


def apart(places, least, low, high):
    """The places moved as little as need be to stand at least so far apart between two ends."""
    order = sorted(range(len(places)), key=lambda i: places[i])
    moved = [places[i] for i in order]
    for i in range(1, len(moved)):
        moved[i] = max(moved[i], moved[i - 1] + least)
    if moved:
        moved[-1] = min(moved[-1], high)
    for i in range(len(moved) - 2, -1, -1):
        moved[i] = min(moved[i], moved[i + 1] - least)
    return {i: max(y, low) for i, y in zip(order, moved)}


def escape(text):
    return str(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def growth_plot(path, title, across, values, scenes, bench):
    """Speed against what grows: a line a way, named at its end. The axis is logarithmic but where something grows from 0."""
    lines = {}
    for name in WAYS:
        points = [(v, way(s, name)["mpixels_per_second"]) for v, s in zip(values, scenes)]
        points = [(v, speed) for v, speed in points if speed]
        if points:
            lines[name] = points
    width, height, left, top, right, bottom = 640, 400, 70, 64, 130, 52
    scale = float if 0 in values else math.log10
    x_from, x_to = scale(min(values)), scale(max(values))
    speeds = [speed for points in lines.values() for _, speed in points]
    y_from, y_to = math.floor(math.log10(min(speeds))), math.ceil(math.log10(max(speeds)) + 1e-9)
    y_to = max(y_to, y_from + 1)

    def x(v):
        return left + 8 + (scale(v) - x_from) / max(x_to - x_from, 1e-9) * (width - left - right - 16)

    def y(speed):
        return height - bottom - (math.log10(speed) - y_from) / (y_to - y_from) * (height - top - bottom)

    out = [
        f"<?xml version='1.0' encoding='UTF-8'?>\n<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' "
        f"viewBox='0 0 {width} {height}' font-family='DejaVu Sans, Helvetica, Arial, sans-serif' font-size='11'>",
        f"<title>{escape(title)}</title>",
        "<rect width='100%' height='100%' fill='white'/>",
        f"<text x='14' y='22' font-size='14' font-weight='bold'>{escape(title)}</text>",
    ]
    machine = bench.machine
    gpu = f"GPU: {machine['adapter']}, {machine['driver']}" if machine["adapter"] else "no GPU"
    out.append(f"<text x='14' y='37'>{escape(gpu)}</text>")
    out.append(f"<text x='14' y='51'>{escape('CPU: ' + machine['cpu'])}, {machine['threads']} threads</text>")
    for power in range(y_from, y_to + 1):
        for step in (1, 2, 5):
            speed = step * 10.0**power
            if speed > 10.0**y_to * 1.001:
                continue
            place = y(speed)
            out.append(f"<path d='M{left},{place:.1f} H{width - right}' stroke='#ddd' stroke-width='0.6'/>")
            if step == 1 or y_to - y_from < 3:
                out.append(f"<text x='{left - 6}' y='{place + 4:.1f}' text-anchor='end'>{speed:g}</text>")
    for v in values:
        out.append(f"<path d='M{x(v):.1f},{top} V{height - bottom}' stroke='#ddd' stroke-width='0.6'/>")
        text = f"{v:,}" if v >= 1000 else v
        out.append(f"<text x='{x(v):.1f}' y='{height - bottom + 15}' text-anchor='middle'>{text}</text>")
    out.append(
        f"<rect x='{left}' y='{top}' width='{width - left - right}' height='{height - top - bottom}' fill='none' stroke='black' stroke-width='0.8'/>"
    )
    middle = (top + height - bottom) / 2
    out.append(
        f"<text x='{(left + width - right) / 2:.1f}' y='{height - 16}' text-anchor='middle'>{escape(across)}</text>"
    )
    out.append(
        f"<text x='18' y='{middle}' text-anchor='middle' transform='rotate(-90 18 {middle})'>Mpixel/s of kernel time (log)</text>"
    )
    names = list(lines)
    ends = apart([y(lines[n][-1][1]) for n in names], 14, top + 6, height - bottom - 4)
    for i, name in enumerate(names):
        places = [(x(v), y(speed)) for v, speed in lines[name]]
        path_text = " L".join(f"{a:.1f},{b:.1f}" for a, b in places)
        dash = f" stroke-dasharray='{DASHES[name]}'" if DASHES[name] else ""
        out.append(f"<path d='M{path_text}' fill='none' stroke='black' stroke-width='1.2'{dash}/>")
        out += [marker(name, a, b) for a, b in places]
        a, b = places[-1]
        end = max(a, width - right) + 10
        out.append(f"<path d='M{a + 6:.1f},{b:.1f} L{end - 2:.1f},{ends[i]:.1f}' stroke='#888' stroke-width='0.6'/>")
        out.append(f"<text x='{end + 2:.1f}' y='{ends[i] + 4:.1f}'>{escape(WAYS[name])}</text>")
    out.append("</svg>\n")
    path.write_text("\n".join(out))


# --- the page ----------------------------------------------------------------------------------------------------------


def measured(bench, quick):
    """The measured part, as Markdown."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    size = (160, 120) if quick else None
    few = lambda names: names[:2] if quick else names
    parts = []
    gallery = bench.run("gallery", of_ours(few(GALLERY)), size)
    plotted = few(GALLERY_PLOT)
    bench.run("gallery_plot", of_ours(plotted), size, repeat=5, plot="gallery.svg")
    hard = bench.run("hard", of_ours(few(HARD)), (160, 120))
    bench.run("hard_plot", of_ours(few(HARD_PLOT)), (160, 120), repeat=5, plot="hard.svg")
    machine = bench.machine
    gpu = f"{machine['adapter']}, driver {machine['driver']}" if machine["adapter"] else machine["no_gpu"]
    clock = "the device's clock" if machine["timestamps"] else "the host's clock"
    parts.append(
        f"## Measured\n\n`python3 scripts/bench.py{' --quick' if quick else ''}`, {bench.software}. GPU: {gpu}; kernels by {clock}. "
        f"CPU: {machine['cpu']}, {machine['threads']} threads, {machine['system']}."
        + (f" Load before it began: {load:.1f}." if load is not None else "")
        + (
            "\n\n**A quick run on a busy machine: these figures show the form of the page, and nothing else.**"
            if quick
            else ""
        )
        + "\n\nTimes are in ms, medians of three runs. Wrong pixels are in percent, in brackets the worst channel; t, the distance along "
        "primary rays, is in units in the last place of f32: median / 99 % / worst, where the right object is seen.\n"
    )
    parts.append(
        "### Gallery\n\n"
        + times_table(gallery)
        + "\n"
        + errors_table(gallery)
        + "\n![Error against time, gallery](bench/gallery.svg)\n\n"
        f"`plumb render` as a process of its own, {stem(gallery[0])}, {gallery[0]['width']}×{gallery[0]['height']}, to a PPM on disk; cold: all caches of "
        "shaders and devices empty, warm: once more:\n\n" + processes_table(gallery[0])
    )
    parts.append(
        f"### Hard cases, {hard[0]['width']}×{hard[0]['height']}\n\n"
        + errors_table(hard)
        + "\n"
        + times_table(hard)
        + "\n![Error against time, hard cases](bench/hard.svg)\n"
    )

    def growth(key, heading, across, values, labels, scenes):
        growth_plot(bench.plots / f"{key}.svg", heading, across, values, scenes, bench)
        parts.append(f"### {heading}\n\n" + growth_table(across, labels, scenes) + f"\n![{heading}](bench/{key}.svg)\n")

    base = (80, 45) if quick else (320, 180)
    sizes = [(base[0] * 2**i, base[1] * 2**i) for i in range(5)]
    scenes = [bench.run(f"pixels_{w}", of_ours(["gallery/spheres_over_tiles"]), (w, h))[0] for w, h in sizes]
    growth(
        "pixels",
        "Pixels, four times as many four times",
        "pixels of spheres_over_tiles",
        [w * h for w, h in sizes],
        [f"{w}×{h}" for w, h in sizes],
        scenes,
    )

    counts = [10, 100, 1000] if quick else [10, 100, 1000, 10_000, 100_000, 1_000_000]
    size = (80, 45) if quick else (640, 360)
    scenes = [bench.run(f"spheres_{n}", [spheres(n)], size, repeat=3 if n < 100_000 else 1)[0] for n in counts]
    growth("spheres", f"Spheres, {size[0]}×{size[1]}", "spheres", counts, [f"{n:,}" for n in counts], scenes)

    counts = [1, 4] if quick else [1, 2, 4, 8, 16, 32, 64]
    size = (80, 45) if quick else (320, 180)
    scenes = bench.run("lights", [lit_room(f"lights_{n}", 5, 0, n) for n in counts], size)
    growth(
        "lights",
        f"Lights, {size[0]}×{size[1]}, five balls on a floor",
        "lights",
        counts,
        [str(n) for n in counts],
        scenes,
    )

    counts = [0, 4] if quick else [0, 1, 2, 5, 10, 15, 20]
    scenes = bench.run("mirrors", [lit_room(f"mirrors_{n}", 20, n, 2) for n in counts], size)
    growth(
        "mirrors",
        f"Mirrors, {size[0]}×{size[1]}, of twenty balls under two lights",
        "mirrors",
        counts,
        [str(n) for n in counts],
        scenes,
    )
    return "\n".join(parts)


def main():
    arguments = argparse.ArgumentParser(description="Makes the measured part of docs/BENCH.md.")
    arguments.add_argument("--quick", action="store_true", help="few scenes, small, once: to see that it works")
    arguments.add_argument(
        "--docs", type=pathlib.Path, default=ROOT / "docs", metavar="FOLDER", help="where BENCH.md and bench/ go (docs)"
    )
    given = arguments.parse_args()
    if not PLUMB.exists():
        sys.exit(f"bench.py: no {PLUMB}: cargo build --release")
    page = (ROOT / "docs" / "BENCH.md").read_text()
    if page.count(BEGIN) != 1 or page.count(END) != 1:
        sys.exit(f"bench.py: docs/BENCH.md needs the lines {BEGIN} and {END}, once each")
    plots = given.docs / "bench"
    plots.mkdir(parents=True, exist_ok=True)
    RAW.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    text = measured(Bench(given.quick, plots.resolve()), given.quick)
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    (given.docs / "BENCH.md").write_text(f"{before}{BEGIN}\n{text}{END}{after}")
    print(f"bench.py: {given.docs / 'BENCH.md'}, {time.monotonic() - start:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
