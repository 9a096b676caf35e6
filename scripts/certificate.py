#!/usr/bin/env python3
"""What certifying costs, scene by scene.

For each scene (all in scenes/ without any named): how many pixels the GPU left doubtful, exact ties apart; what decided
them; whether the picture is the one of --backend cpu; kernel and whole frame over those of --precision fast, the best of
three each. A Markdown table on stdout. Needs target/release/plumb.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLUMB = ROOT / "target" / "release" / "plumb"


def render(scene, size, *options):
    """The report of one rendering, or None where plumb says no."""
    command = [PLUMB, "render", scene, "-o", "/dev/null", "--json", *options]
    if size:
        command += ["--size", size]
    done = subprocess.run(command, capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else None


def best(scene, size, precision):
    """The report with the shortest kernel, and the shortest frame, of three runs."""
    runs = [render(scene, size, "--backend", "gpu", "--precision", precision) for _ in range(3)]
    if None in runs:
        return None
    # All but what a process does once.
    once = ("instance", "device", "selftest", "close")
    frame = lambda run: run["seconds"]["total"] - sum(run["seconds"]["phases"][phase] for phase in once)
    return min(runs, key=kernel), min(map(frame, runs))


def kernel(run):
    """Seconds in kernels."""
    return run["seconds"]["beside"]["kernel"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", metavar="WxH", help="columns and rows, in place of the scenes' own")
    parser.add_argument("scene", nargs="*", type=pathlib.Path, help="scene files (all of ours that are right)")
    arguments = parser.parse_args()
    size = arguments.size
    scenes = arguments.scene or sorted(p for p in ROOT.glob("scenes/**/*.txt") if p.parent.name != "errors")
    ratios = []
    print(
        "| scene | doubtful % | of these ties % | f64 | many bits | tie | presumed | as on the CPU | kernel × | frame × |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    total = {"pixels": 0, "doubtful": 0, "tie": 0, "presumed": 0, "scenes": 0, "differ": 0}
    for scene in scenes:
        certified, fast = best(scene, size, "certified"), best(scene, size, "fast")
        cpu = render(scene, size, "--backend", "cpu")
        if None in (certified, fast, cpu):
            continue
        (report, frame), (raw, raw_frame) = certified, fast
        decided, pixels = report["decided"], report["pixels"]
        same = report["sha256"] == cpu["sha256"] and report["revoked"] is None
        doubtful = pixels - decided["gpu"]
        total["scenes"] += 1
        total["pixels"] += pixels
        total["doubtful"] += doubtful
        total["tie"] += decided["tie"]
        total["presumed"] += decided["presumed"]
        total["differ"] += not same
        kernels = kernel(report) / max(kernel(raw), 1e-9)
        ratios.append((100 * doubtful / pixels, kernels, frame / raw_frame))
        print(
            f"| {scene.stem} | {100 * (doubtful - decided['tie']) / pixels:.3f} | {100 * decided['tie'] / pixels:.3f} "
            f"| {decided['f64']} | {decided['multiprecision']} | {decided['tie']} | {decided['presumed']} "
            f"| {'yes' if same else 'NO'} | {kernels:.2f} | {frame / raw_frame:.2f} |",
            flush=True,
        )
    print(total, file=sys.stderr)
    if ratios:
        doubt, kernels, frame = map(statistics.median, zip(*ratios))
        print(f"medians: {doubt:.2f} % doubtful, kernel {kernels:.2f} ×, frame {frame:.2f} ×", file=sys.stderr)


if __name__ == "__main__":
    main()
