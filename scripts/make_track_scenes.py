#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the masks of terrains/tracks/crop_circle.toml and mown.toml, and
terrains/tracks/herd.toml.

    make_track_scenes.py [DIRECTORY]     default: terrains/tracks beside this script's directory

A mask is an 8-bit grey PNG: how much lies, 0 to 255, or the way that it lies, 0 to 255 for 0 to 360
degrees of yaw. The same bytes every time."""

import math
import pathlib
import random
import struct
import sys
import zlib


def write_grey(path, rows):
    """`rows`: lists of values 0..1."""

    def chunk(name, data):
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    height, width = len(rows), len(rows[0])
    raw = b"".join(b"\0" + bytes(max(0, min(255, int(255 * v + 0.5))) for v in row) for row in rows)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(raw, 9))
        + chunk(b"IEND", b"")
    )


def yaw(x, z):
    """Of a way east and south: 0 north, a quarter east; 0..1 for a turn."""
    return (math.atan2(x, -z) / (2 * math.pi)) % 1.0


def crop_circle(x, z):
    """How much lies there and which way (m from the middle): a disc laid round, a ring laid the
    other way, six discs joined to it."""

    def inside(distance):
        return max(0.0, min(1.0, 0.5 - distance / 0.3))  # a third of a metre from standing to lying

    r = math.hypot(x, z)
    if r < 17:
        return inside(r - 14) if r > 0.01 else 1.0, yaw(-z + 0.35 * x, x + 0.35 * z)
    if r < 24:
        return min(inside(r - 22), inside(18 - r)), yaw(z, -x)
    for n in range(6):
        a = n * math.pi / 3
        cx, cz = 33 * math.cos(a), 33 * math.sin(a)
        d = math.hypot(x - cx, z - cz)
        if d < 8:
            return inside(d - 6), yaw(-(z - cz), x - cx)
        along, beside = x * math.cos(a) + z * math.sin(a), -x * math.sin(a) + z * math.cos(a)
        if 22 <= along < 27.5 and abs(beside) < 2:
            return inside(abs(beside) - 0.8), yaw(math.cos(a), math.sin(a))
    return 0.0, 0.0


def mown(x, z):
    """A field of stripes 6 m wide, laid by turns to the north and to the south."""
    stripe = math.floor((x + 96) / 6)
    return (1.0 if abs(x) < 96 and abs(z) < 96 else 0.0), (0.0 if stripe % 2 == 0 else 0.5)


def write_masks(directory, name, size_m, pixel_m, pattern):
    n = int(size_m / pixel_m)
    places = [(i + 0.5) * pixel_m - 0.5 * size_m for i in range(n)]
    found = [[pattern(x, z) for x in places] for z in places]
    write_grey(directory / f"{name}.png", [[lying for lying, way in row] for row in found])
    write_grey(directory / f"{name}_way.png", [[way for lying, way in row] for row in found])


HERD = """# SPDX-License-Identifier: Apache-2.0
# Forty animals cross the meadow from the west to the east, as spheres that the grass feels. Written
by scripts/make_track_scenes.py.
[terrain]
elevation = "../jacksboro/height.tif"
detail_m = 0.5

[grass]
set = "meadow.toml"

[sun]
azimuth_deg = 135
elevation_deg = 35

[wind]
speed_mps = 4
direction_deg = 270
gust = 0.4
seed = 7

[tracks]
recovery_per_s2 = 20
lasting_s = 21600

[camera.saddle]
position = [2496, 1.7, -1368]
agl = true
yaw_deg = 350
pitch_deg = -8
fov_deg = 60

[camera.hill30]
position = [2496, 30, -1350]
agl = true
yaw_deg = 0
pitch_deg = -28
fov_deg = 60
"""


def herd(seed=40):
    """Animals walk at 1.2 to 1.6 m/s, each on a way of its own that wanders."""
    dice = random.Random(seed)
    text = HERD
    for n in range(40):
        x, z = 2440 - dice.uniform(0, 24), -1392 + dice.uniform(-14, 14)
        speed, radius = dice.uniform(1.2, 1.6), dice.uniform(0.3, 0.5)
        keys = []
        for t in range(0, 61, 12):
            keys.append(f"{{ t = {t}, position = [{x:.2f}, {radius:.2f}, {z:.2f}] }}")
            x, z = x + 12 * speed, z + dice.uniform(-2.5, 2.5)
        text += f"\n[path.a{n}]\nkeys = [{', '.join(keys)}]\n[[object]]\nkind = \"sphere\"\npath = \"a{n}\"\nradius_m = {radius:.2f}\n"
    return text


def main():
    given = (
        sys.argv[1]
        if len(sys.argv) > 1
        else pathlib.Path(__file__).resolve().parent.parent / "terrains" / "tracks"
    )
    directory = pathlib.Path(given)
    write_masks(directory, "crop_circle", 80, 0.25, crop_circle)
    write_masks(directory, "mown", 192, 0.5, mown)
    (directory / "herd.toml").write_text(herd())


if __name__ == "__main__":
    main()
