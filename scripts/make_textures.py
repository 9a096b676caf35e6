#!/usr/bin/env python3
"""Writes the textures that the scenes use: scenes/textures/*.ppm, binary PPM, a few KB each.

Only integers are calculated with, so the same bytes come out everywhere:

    scripts/make_textures.py            writes them
    scripts/make_textures.py --check    exit 1 if a file there is not what would be written
"""

import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "textures"


def noise(x, y, seed=0):
    """A byte that looks random and depends on its arguments only."""
    n = (x * 374761393 + y * 668265263 + seed * 2246822519) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return (n >> 16) & 0xFF


def mix(a, b, share, whole):
    """Colour a at share 0, b at share = whole."""
    return tuple((p * (whole - share) + q * share) // whole for p, q in zip(a, b))


def darker(color, by):
    return tuple(max(0, min(255, c - by)) for c in color)


def bricks(x, y):
    """32 x 32, can be repeated: four courses of bricks, every second one shifted."""
    course, row = divmod(y, 8)
    brick, column = divmod((x + 8 * (course % 2)) % 32, 16)
    if row == 7 or column == 15:
        return darker((176, 168, 155), noise(x, y) // 10)
    tone = noise(brick, course, 1) // 6
    return darker((204, 104, 78), tone + noise(x, y, 2) // 9 + (14 if row == 6 or column == 14 else 0))


def wood(x, y):
    """48 x 32, can be repeated: four planks with a grain."""
    plank, row = divmod(y, 8)
    shifted = (x + 19 * plank) % 48
    if row == 7 or shifted == 0:
        return (70, 42, 24)
    grain = noise(shifted // 6, y, 3) // 6 + noise(shifted // 2, y, 4) // 16
    return darker((206 - 9 * plank % 25, 150, 96), grain + 12 * (plank % 2))


def painting(x, y):
    """72 x 54: the sun sets over hills and a lake, in a gilt frame."""
    edge = min(x, y, 71 - x, 53 - y)
    if edge < 4:
        return [(112, 78, 24), (222, 178, 74), (250, 216, 120), (128, 92, 34)][edge]
    sun = (x - 46) ** 2 + (y - 25) ** 2
    sky = mix((44, 58, 122), (252, 158, 84), max(0, y - 4), 30)
    if sun < 40:
        sky = (255, 240, 170)
    elif sun < 220:
        sky = mix((255, 214, 130), sky, sun - 40, 180)
    far = 26 + abs((x * 5) % 46 - 23) // 4
    near = 31 + abs((x * 2 + 30) % 72 - 36) // 5
    if y > 40:
        glitter = abs(x - 46) < 3 + (y - 40) and noise(x // 2, y, 5) > 110
        return (250, 206, 128) if glitter else darker((58, 78, 124), 2 * (y - 40) + noise(x // 3, y, 6) // 16)
    if y >= near:
        return darker((46, 84, 58), noise(x, y, 7) // 10)
    if y >= far:
        return mix((112, 84, 120), (150, 108, 120), y - far, 14)
    return sky


def rug(x, y):
    """64 x 40: nested borders around a row of lozenges."""
    edge = min(x, y, 63 - x, 39 - y)
    if edge < 8:
        return [
            (196, 164, 92),
            (196, 164, 92),
            (122, 22, 34),
            (122, 22, 34),
            (28, 44, 88),
            (28, 44, 88),
            (208, 186, 130),
            (122, 22, 34),
        ][edge]
    # Lozenges 16 wide around the middle row, ring in ring.
    ring = abs((x - 8) % 16 - 8) * 3 // 2 + abs(y * 2 - 39) // 2
    color = (
        [
            (226, 198, 120),
            (226, 198, 120),
            (28, 60, 108),
            (28, 60, 108),
            (206, 84, 60),
            (206, 84, 60),
            (206, 84, 60),
            (216, 190, 132),
        ][min(ring // 2, 7)]
        if ring < 14
        else (150, 30, 40)
    )
    return darker(color, noise(x, y, 8) // 14)


def night(x, y):
    """64 x 48: stars over a horizon's last light."""
    sky = mix((8, 10, 40), (58, 40, 96), y, 47)
    star = noise(x, y, 9)
    if star > 250:
        return (255, 250, 230)
    if star > 244:
        return mix(sky, (210, 220, 255), 1, 2)
    return sky


def window(x, y):
    """48 x 48: a rose window, in leaded colours."""
    u, v = 2 * x - 47, 2 * y - 47
    far = u * u + v * v
    for radius in (12, 26, 40, 46):
        if abs(far - radius * radius) < 3 * radius:
            return (30, 28, 26)
    if far > 46 * 46:
        return (30, 28, 26) if abs(u) < 2 or abs(v) < 2 else (54, 82, 176)
    # Which twelfth of the turn: by the signs, and by comparing with tan 30 = 4/7 and tan 60 = 7/4.
    a, b = abs(u), abs(v)
    third = 0 if 7 * b < 4 * a else 1 if 4 * b < 7 * a else 2
    lead = far > 144 and (abs(7 * b - 4 * a) < 9 or abs(4 * b - 7 * a) < 9 or b < 2 or a < 2)
    if lead:
        return (30, 28, 26)
    quarter = (0 if v < 0 else 2) + (0 if (u < 0) == (v < 0) else 1)
    petal = quarter * 3 + (third if quarter % 2 == 0 else 2 - third)
    inner = [(250, 214, 90), (226, 60, 52), (60, 140, 220)]
    outer = [(232, 120, 40), (70, 170, 96), (150, 70, 176)]
    if far < 144:
        return (255, 236, 150)
    return inner[petal % 3] if far < 676 else outer[(petal + 1) % 3] if far < 1600 else (236, 222, 190)


def texels(x, y):
    """4 x 2: eight colours whose bytes are easy to calculate with."""
    top = [(128, 0, 0), (0, 128, 0), (0, 0, 128), (128, 128, 128)]
    bottom = [(64, 0, 0), (0, 64, 0), (0, 0, 64), (192, 192, 192)]
    return (top, bottom)[y][x]


TEXTURES = [
    (bricks, 32, 32),
    (wood, 48, 32),
    (painting, 72, 54),
    (rug, 64, 40),
    (night, 64, 48),
    (window, 48, 48),
    (texels, 4, 2),
]


def main():
    wrong = 0
    FOLDER.mkdir(exist_ok=True)
    for texture, width, height in TEXTURES:
        pixels = bytes(c for y in range(height) for x in range(width) for c in texture(x, y))
        picture = b"P6 %d %d 255\n" % (width, height) + pixels
        path = FOLDER / f"{texture.__name__}.ppm"
        if "--check" not in sys.argv[1:]:
            path.write_bytes(picture)
        elif not path.is_file() or path.read_bytes() != picture:
            print(f"{path.name} is not what would be written", file=sys.stderr)
            wrong = 1
    return wrong


if __name__ == "__main__":
    sys.exit(main())
