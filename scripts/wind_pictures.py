#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of docs/wind.md from the scenes in terrains/wind: the flow from above (line
integral convolution of what
`sward wind` writes, coloured by speed) at two moments, or beside the grass that `sward render`
draws at the second.

    build/venv/bin/python scripts/wind_pictures.py [--bin build/release/bin] [--only storm,arrows]
    [--out docs/gallery/wind]

Needs numpy, OpenEXR and Pillow, which the tests' environment has. Takes about five minutes on two
cores.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parent.parent
FLOW, GRASS = (420, 420), (640, 420)
CAPTION = 18
INK, PAPER, SOLID = (225, 225, 220), (34, 35, 36), (150, 146, 140)
COLOURS = 128  # a picture's palette: grass is noise to PNG otherwise
STREAK = 14  # pixels, both ways
# By scene: first moment (s; the second comes at twice that), metres across the flow's picture,
# speed (m/s) of the brightest colour
SCENES = {
    "obstacles": (5, 150, 14),
    "meeting": (4, 110, 12),
    "arrows": (4, 110, 10),
    "helicopter": (7, 100, 14),
    "cyclone": (7, 110, 18),
    "storm": (4, 150, 40),
}
WITH_GRASS = ("storm",)  # near enough that blades show
RAMP = np.array(
    [(18, 24, 48), (24, 74, 110), (34, 138, 132), (140, 196, 96), (252, 232, 150)], float
)


def ramp(x):
    x = np.clip(x, 0, 1) * (len(RAMP) - 1)
    low = np.minimum(x.astype(int), len(RAMP) - 2)
    return RAMP[low] + (RAMP[low + 1] - RAMP[low]) * (x - low)[..., None]


def sample(field, x, y):
    """Bilinear, held at the edges; x, y in cells, centres at whole numbers."""
    rows, columns = field.shape
    x, y = np.clip(x, 0, columns - 1.001), np.clip(y, 0, rows - 1.001)
    i, j = x.astype(int), y.astype(int)
    a, b = x - i, y - j
    return (field[j, i] * (1 - a) + field[j, i + 1] * a) * (1 - b) + (
        field[j + 1, i] * (1 - a) + field[j + 1, i + 1] * a
    ) * b


def flow_picture(path, metres, brightest):
    with OpenEXR.File(str(path), separate_channels=True) as file:
        cell = float(file.header()["cell_m"])
        u, v, solid = (
            np.array(file.channels()[name].pixels, float) for name in ("u", "v", "solid")
        )
    width, height = FLOW
    scale = metres / cell / width  # cells a pixel
    x = (np.arange(width) - 0.5 * width + 0.5) * scale + 0.5 * u.shape[1] - 0.5
    y = (np.arange(height) - 0.5 * height + 0.5) * scale + 0.5 * u.shape[0] - 0.5
    x, y = np.meshgrid(x, y)
    pu, pv = sample(u, x, y), sample(v, x, y)
    speed = np.hypot(pu, pv)
    noise = np.random.default_rng(1).random(speed.shape)
    total = noise.copy()
    for way in (1, -1):
        px, py = np.meshgrid(np.arange(width, dtype=float), np.arange(height, dtype=float))
        for _ in range(STREAK):
            a, b = sample(pu, px, py), sample(pv, px, py)
            # Slow air draws short streaks
            step = way / np.maximum(np.hypot(a, b), 0.15 * brightest)
            px, py = px + a * step, py + b * step
            total += sample(noise, px, py)
    grain = (total / (2 * STREAK + 1) - 0.5) * 4
    picture = ramp(speed / brightest) * np.clip(1 + 0.8 * grain, 0.3, 1.7)[..., None]
    picture[sample(solid, x, y) > 0.5] = SOLID
    return Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8))


def with_caption(left, right, text):
    picture = Image.new("RGB", (left.width + right.width + 4, FLOW[1] + CAPTION), PAPER)
    picture.paste(left, (0, 0))
    picture.paste(right, (FLOW[0] + 4, 0))
    ImageDraw.Draw(picture).text((6, FLOW[1] + 3), text, fill=INK, font=ImageFont.load_default())
    return picture.quantize(COLOURS, dither=Image.Dither.NONE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", default=ROOT / "build/release/bin", type=Path)
    parser.add_argument("--out", default=ROOT / "docs/gallery/wind", type=Path)
    parser.add_argument("--only", default=",".join(SCENES))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        png = Path(folder) / "grass.png"
        for name in options.only.split(","):
            time, metres, brightest = SCENES[name]
            scene = ROOT / "terrains/wind" / name
            run = [str(options.bin.resolve() / "sward")]
            flow = Path(folder) / "flow.%d.exr"
            subprocess.run(
                [
                    *run,
                    "wind",
                    scene,
                    "--time",
                    str(2 * time),
                    "--every",
                    str(time),
                    "-o",
                    flow,
                    "-q",
                ],
                check=True,
            )
            first, second = (flow_picture(str(flow) % n, metres, brightest) for n in (1, 2))
            text = (
                f"{metres} m from above, north up; speed from 0 (dark) to {brightest} m/s (bright)"
            )
            if name in WITH_GRASS:
                subprocess.run(
                    [
                        *run,
                        "render",
                        scene,
                        "--time",
                        str(2 * time),
                        "-o",
                        png,
                        "--size",
                        "%dx%d" % GRASS,
                        "-q",
                    ],
                    check=True,
                )
                with Image.open(png) as grass:
                    picture = with_caption(
                        second, grass.convert("RGB"), f"{name} at {2 * time} s: {text}"
                    )
            else:
                picture = with_caption(first, second, f"{name} at {time} and {2 * time} s: {text}")
            picture.save(options.out / f"{name}.png", optimize=True)
            print(name, (options.out / f"{name}.png").stat().st_size // 1000, "kB", flush=True)


if __name__ == "__main__":
    main()
