#!/usr/bin/env python3
"""Writes a scene of many spheres to stdout: a landscape of beads over a tiled floor, before
a wall of dusk.

    scripts/make_spheres.py [--n 100000] [--width 1920] [--height 1080] [--seed 1] > spheres.txt

The spheres stand on a grid of cells, one a cell, from the front to the back; their height follows hills, their colour
the height (water, sand, grass, rock, snow), and one in 64 floats above the ground.

Every number comes from whole numbers alone, so any language can make the same file byte for byte. Lengths are counted
in ten-thousandths of a unit (10000 = 1 unit) and written with exactly four decimals. All divisions below are of
non-negative numbers and drop the remainder.

Random numbers: a linear congruential generator, state' = (1664525 * state + 1013904223) mod 2^32, whose first state is
the seed; rnd(m) steps it once and returns ((state >> 16) * m) >> 16, which is 0 .. m - 1 for m up to 65536.

Sphere i = 0 .. n - 1, with c the smallest whole number for which c * c >= n, and the field 480000 wide and 600000 deep:
    column = i mod c, row = i / c
    wx = 480000 / c, wz = 600000 / c                      (a cell)
    radius = wx * (30 + rnd(16)) / 100, at least 1
    x = 480000 * column / c + wx/4 + rnd(1 + min(wx/2, 65535)) - 160000
    z = -(20000 + 600000 * row / c + wz/4 + rnd(1 + min(wz/2, 65535)))
    ground = hill(480000 * column / c, 160000) * hill(600000 * row / c, 200000) / 65536     (0 .. 65536)
    height = ground * 50000 / 65536, or 8000 (the water) if that is more
    lift = 20000 + rnd(40000) if rnd(64) = 0, else 0
    y = -30000 + height + radius + lift
    material = by height + rnd(6000): below 14000 water, 20000 sand, 30000 grass, 41000 rock, else snow; a floating one: amber
where hill(u, period) is a wave of triangles smoothed by a square: v = u mod period, w = 65536 * v / period * 2, and if
w > 65536, w = 131072 - w; then hill = w * w / 65536.
The order of the rnd calls is as written: radius, x, z, lift (one or two calls), material.

The camera looks along -z from (8, 7.5, 12) through a screen 16 wide and 160000 * height / width high.
"""

import argparse
import sys

FIELD_WIDTH, FIELD_DEPTH = 480000, 600000

MATERIALS = [
    ("water", "3 8 16"),
    ("sand", "15 13 8"),
    ("grass", "5 13 4"),
    ("rock", "11 9 8"),
    ("snow", "22 22 24"),
    ("amber", "18 10 3"),
    ("ground_a", "5 6 8"),
    ("ground_b", "2 3 5"),
    ("dusk", "38 34 58"),
]


class Lcg:
    """The generator that the page above describes."""

    def __init__(self, seed):
        self.state = seed & 0xFFFFFFFF

    def rnd(self, m):
        self.state = (1664525 * self.state + 1013904223) & 0xFFFFFFFF
        return ((self.state >> 16) * m) >> 16


def decimal(v):
    """A length in ten-thousandths as text with four decimals."""
    a = abs(v)
    return f"{'-' if v < 0 else ''}{a // 10000}.{a % 10000:04}"


def hill(u, period):
    w = 65536 * (u % period) // period * 2
    if w > 65536:
        w = 131072 - w
    return w * w // 65536


def main():
    args = argparse.ArgumentParser(description="A scene of many spheres, to stdout.")
    args.add_argument("--n", type=int, default=100000, help="number of spheres (default 100000)")
    args.add_argument("--width", type=int, default=1920)
    args.add_argument("--height", type=int, default=1080)
    args.add_argument("--seed", type=int, default=1)
    a = args.parse_args()
    if a.n < 1 or a.width < 1 or a.height < 1:
        sys.exit("make_spheres.py: --n, --width and --height must be at least 1")

    out = sys.stdout.write
    out(
        f"# A landscape of {a.n} beads, made by scripts/make_spheres.py --n {a.n} --width {a.width} "
        f"--height {a.height} --seed {a.seed}\n"
    )
    out(
        f"camera cam1\n{{\n  pixeldim {a.width} {a.height}\n"
        f"  worlddim 16.0000 {decimal(max(1, 160000 * a.height // a.width))}\n  viewpoint 8.0000 7.5000 12.0000\n}}\n"
    )
    for name, ambient in MATERIALS:
        out(f"material {name}\n{{\n  ambient {ambient}\n}}\n")
    out(
        "tiled_plane floor\n{\n  material ground_a\n  normal 0 1 0\n  point 0 -3 0\n"
        "  dimension 2 2\n  altmaterial ground_b\n}\n"
    )
    out("plane sky\n{\n  material dusk\n  normal 0 0 1\n  point 0 0 -80\n}\n")

    random = Lcg(a.seed)
    c = 1
    while c * c < a.n:
        c += 1
    wx, wz = FIELD_WIDTH // c, FIELD_DEPTH // c
    for i in range(a.n):
        column, row = i % c, i // c
        u, v = FIELD_WIDTH * column // c, FIELD_DEPTH * row // c
        radius = max(1, wx * (30 + random.rnd(16)) // 100)
        x = u + wx // 4 + random.rnd(1 + min(wx // 2, 65535)) - 160000
        z = -(20000 + v + wz // 4 + random.rnd(1 + min(wz // 2, 65535)))
        ground = hill(u, 160000) * hill(v, 200000) // 65536
        height = max(8000, ground * 50000 // 65536)
        lift = 20000 + random.rnd(40000) if random.rnd(64) == 0 else 0
        y = -30000 + height + radius + lift
        shade = height + random.rnd(6000)
        material = 5 if lift else sum(shade >= limit for limit in (14000, 20000, 30000, 41000))
        out(
            f"sphere s{i}\n{{\n  material {MATERIALS[material][0]}\n"
            f"  center {decimal(x)} {decimal(y)} {decimal(z)}\n  radius {decimal(radius)}\n}}\n"
        )


if __name__ == "__main__":
    main()
