#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of docs/texgen.md: a row of three pictures for every key of a preset, a sheet
a section, and the
sheets of the shipped presets. Each picture is a set that texgen bakes and `sward render` draws.

    scripts/texgen_pictures.py [--bin build/release/bin] [--only shape,head] [--out docs/gallery]

Needs Pillow. Takes about fifteen minutes on two cores.
"""

import argparse
import copy
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parent.parent
THUMB = (208, 138)
LABEL_WIDTH = 126
CAPTION = 17
INK, PAPER = (225, 225, 220), (34, 35, 36)
COLOURS = 160  # a sheet's palette: pictures of grass are noise to PNG otherwise

# Presets, as nested tables. A stand of few wide blades shows shape, a dense one shows colour and
# light.
FEW = {
    "patch": {"side_m": 2.0, "density_per_m2": 70.0, "variants": 1},
    "tufts": {"share": 0.0},
    "blade": {
        "length_m": [0.24, 0.28],
        "width_m": [0.010, 0.012],
        "lean_deg": [0.0, 10.0],
        "curvature_deg": [10.0, 25.0],
        "droop": [0.0, 0.1],
    },
    "colour": {"dry_share": 0.0, "variation": 0.3},
    "texture": {"size": 128, "layers": 4, "slices": 4, "levels": 2},
}
DENSE = {
    "patch": {"side_m": 2.0, "density_per_m2": 1400.0, "variants": 1},
    "texture": {"size": 128, "layers": 4, "slices": 4, "levels": 2},
}
TUFTS = dict(DENSE, patch={"side_m": 2.0, "density_per_m2": 700.0, "variants": 1})
# A few big bushes, so that the period shows.
SPARSE = {
    "patch": {"side_m": 2.0, "density_per_m2": 150.0, "variants": 1},
    "blade": {"width_m": [0.012, 0.018], "length_m": [0.12, 0.20], "lean_deg": [0.0, 30.0]},
    "tufts": {"share": 1.0, "blades": [60, 300], "radius_m": [0.05, 0.25]},
    "texture": DENSE["texture"],
}
HEADS = dict(FEW, element="seed_head", blade=dict(FEW["blade"], width_m=[0.016, 0.02]))
FLAT = {
    "patch": {"side_m": 2.0, "density_per_m2": 1400.0, "variants": 1},
    "texture": {"size": 256, "layers": 16, "slices": 16, "levels": 4},
}


@dataclass
class View:
    """Where the camera stands and what it draws."""

    height_m: float
    pitch_deg: float
    fov_deg: float
    yaw_deg: float = 300
    wind_mps: float = 0
    arguments: list = field(default_factory=list)


CLOSE = View(0.46, -19, 25, arguments=["--tiers", "blades", "--blades-distance", "1.7"])
WINDY = View(0.46, -19, 25, yaw_deg=0, wind_mps=12, arguments=CLOSE.arguments)
STAND = View(0.75, -33, 44, arguments=["--tiers", "blades", "--blades-distance", "6"])
ABOVE = View(2.6, -89, 40, arguments=["--tiers", "blades", "--blades-distance", "8"])
AGAINST = View(
    0.42, -14, 44, yaw_deg=135, arguments=["--tiers", "blades", "--blades-distance", "8"]
)
AWAY = View(0.42, -14, 44, yaw_deg=315, arguments=["--tiers", "blades", "--blades-distance", "8"])
HIGH = View(9, -89, 40, arguments=["--tiers", "blades", "--blades-distance", "15"])
SHELLS = View(1.0, -24, 36, arguments=["--tiers", "shells", "--force-tier", "0"])
STEEP = View(1.3, -60, 36, arguments=SHELLS.arguments)
FAR = View(30, -22, 30)


@dataclass
class Row:
    key: str  # as in docs/texgen.md
    unit: str
    base: dict
    view: View
    values: list


def rows():
    """Every key of a preset, by sheet."""
    white, rust = [0.45, 0.42, 0.36], [0.19, 0.06, 0.03]
    return {
        "patch": [
            Row("patch.density_per_m2", "blades/m2", DENSE, STAND, [150.0, 1400.0, 6000.0]),
            Row("patch.side_m", "m", SPARSE, HIGH, [1.2, 3.0, 8.0]),
            Row("patch.variants", "", SPARSE, HIGH, [1, 4, 16]),
            Row("seed", "", dict(FEW), CLOSE, [1, 2, 3]),
        ],
        "tufts": [
            Row(
                "tufts.share",
                "of the blades",
                dict(TUFTS, tufts={"radius_m": [0.03, 0.06], "blades": [40, 80]}),
                ABOVE,
                [0.0, 0.55, 1.0],
            ),
            Row(
                "tufts.radius_m",
                "m",
                dict(TUFTS, tufts={"share": 0.9, "blades": [40, 80]}),
                ABOVE,
                [[0.01, 0.03], [0.06, 0.12], [0.2, 0.4]],
            ),
            Row(
                "tufts.blades",
                "in a tuft",
                dict(TUFTS, tufts={"share": 0.9, "radius_m": [0.03, 0.07]}),
                ABOVE,
                [[3, 6], [30, 60], [150, 250]],
            ),
        ],
        "shape": [
            Row("blade.length_m", "m", FEW, CLOSE, [[0.06, 0.08], [0.18, 0.22], [0.34, 0.38]]),
            Row("blade.width_m", "m", FEW, CLOSE, [[0.002, 0.003], [0.008, 0.010], [0.024, 0.03]]),
            Row("blade.taper", "", FEW, CLOSE, [0.5, 2.0, 12.0]),
            Row("blade.lean_deg", "degrees", FEW, CLOSE, [[0.0, 2.0], [25.0, 30.0], [60.0, 65.0]]),
            Row(
                "blade.curvature_deg",
                "degrees",
                FEW,
                CLOSE,
                [[0.0, 2.0], [40.0, 50.0], [100.0, 110.0]],
            ),
            Row("blade.droop", "0 to 1", FEW, CLOSE, [[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]]),
            Row("blade.stiffness", "in wind", FEW, WINDY, [[0.0, 0.05], [0.5, 0.5], [0.95, 1.0]]),
        ],
        "head": [
            Row("element", "defaults", FEW, CLOSE, ["seed_head", "leaf", "flower"]),
            Row("head.from", "of the length", HEADS, CLOSE, [0.4, 0.7, 0.9]),
            Row("head.stalk", "of the width", HEADS, CLOSE, [0.05, 0.3, 0.8]),
            Row("head.fullness", "", HEADS, CLOSE, [0.25, 1.0, 4.0]),
        ],
        "colour": [
            Row(
                "colour.root",
                "reflectance",
                FEW,
                CLOSE,
                [[0.02, 0.02, 0.01], [0.052, 0.088, 0.022], rust],
            ),
            Row(
                "colour.tip",
                "reflectance",
                FEW,
                CLOSE,
                [[0.04, 0.09, 0.06], [0.078, 0.152, 0.032], rust],
            ),
            Row(
                "colour.dry",
                "at dry_share 0.5",
                dict(DENSE, colour={"dry_share": 0.5}),
                STAND,
                [[0.10, 0.06, 0.03], [0.215, 0.175, 0.08], white],
            ),
            Row("colour.dry_share", "of the blades", DENSE, STAND, [0.0, 0.3, 1.0]),
            Row("colour.variation", "0 to 1", DENSE, STAND, [0.0, 0.45, 1.0]),
            Row(
                "colour.head",
                "reflectance",
                HEADS,
                CLOSE,
                [[0.16, 0.13, 0.06], white, [0.12, 0.04, 0.10]],
            ),
        ],
        "light": [
            Row("light.kd", "diffuse", DENSE, AWAY, [0.3, 1.0, 1.8]),
            Row("light.pd", "its power", DENSE, AWAY, [0.2, 1.0, 8.0]),
            Row("light.ks", "glossy", DENSE, AWAY, [0.0, 0.06, 0.4]),
            Row(
                "light.ps",
                "its power (ks 0.4)",
                dict(DENSE, light={"ks": 0.4}),
                AWAY,
                [2.0, 18.0, 120.0],
            ),
            Row("light.translucency", "against the sun", DENSE, AGAINST, [0.0, 0.45, 1.0]),
        ],
        "texture": [
            Row("texture.size", "texels", FLAT, SHELLS, [64, 256, 512]),
            Row("texture.layers", "seen steeply", FLAT, STEEP, [2, 8, 32]),
            Row("texture.slices", "flat tier alone", FLAT, SHELLS, [4, 16, 48]),
            Row("texture.levels", "from 30 m", FLAT, FAR, [1, 2, 4]),
            Row("texture.height_map", "seen steeply", FLAT, STEEP, ["none", "linear", "top"]),
        ],
    }


# The shipped presets: camera (height, pitch, field of view), and whether the whole eye level fits.
PRESETS = {
    "meadow": View(1.7, -12, 60, wind_mps=4),
    "lawn": View(0.35, -12, 60, wind_mps=4),
    "wheat": View(1.7, -12, 60, wind_mps=4),
    "heath": View(1.4, -14, 60, wind_mps=4),
    "dry-steppe": View(1.7, -12, 60, wind_mps=4),
    "reeds": View(3.4, -10, 60, wind_mps=4),
    "fur": View(0.06, -30, 50, wind_mps=0),
}


def toml_value(value):
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return repr(value)


def toml_text(preset):
    """One [[species]] entry where `element` is given, since only a species may hold it."""
    preset = copy.deepcopy(preset)
    element = preset.pop("element", None)
    top = [f"{k} = {toml_value(v)}" for k, v in preset.items() if not isinstance(v, dict)]
    ours = ("tufts", "blade", "head", "colour", "light")
    lines = ['name = "picture"', *top]
    for prefix, wanted in (("", False), ("species.", True)):
        if wanted and element is not None:
            lines += ["[[species]]", f'element = "{element}"']
        for section, keys in preset.items():
            if isinstance(keys, dict) and (element is not None and section in ours) == wanted:
                lines += [
                    f"[{prefix}{section}]",
                    *(f"{k} = {toml_value(v)}" for k, v in keys.items()),
                ]
    return "\n".join(lines) + "\n"


def with_value(base, key, value):
    preset = copy.deepcopy(base)
    *section, name = key.split(".")
    table = preset.setdefault(section[0], {}) if section else preset
    table[name] = value
    if key == "texture.size":  # few texels allow few levels
        preset["texture"]["levels"] = 2
    return preset


class Studio:
    def __init__(self, binaries, folder):
        self.binaries, self.folder, self.count = Path(binaries).resolve(), Path(folder), 0

    def run(self, *command):
        subprocess.run([str(c) for c in command], check=True)

    def bake(self, preset):
        """`preset`: a shipped one's name or a file."""
        self.count += 1
        out = self.folder / f"set{self.count}"
        self.run(self.binaries / "texgen", preset, "-o", out, "--no-preview", "--no-volume", "-q")
        return out

    def render(self, grass, view, size):
        scene = self.folder / "scene.toml"
        terrain = ROOT / "terrains/jacksboro/height.tif"
        scene.write_text(f"""[terrain]
elevation = "{terrain}"
detail_m = 0
[grass]
set = "{grass}"
[wind]
speed_mps = {float(view.wind_mps)}
[camera.here]
position = [2535, {float(view.height_m)}, -1341]
yaw_deg = {view.yaw_deg}
pitch_deg = {view.pitch_deg}
fov_deg = {view.fov_deg}
""")
        out = self.folder / "picture.png"
        self.run(
            self.binaries / "sward",
            "render",
            scene,
            "-o",
            out,
            "--camera",
            "here",
            "-q",
            "--size",
            f"{2 * size[0]}x{2 * size[1]}",
            *view.arguments,
        )
        with Image.open(out) as picture:
            return picture.convert("RGB").resize(size, Image.Resampling.LANCZOS)

    def thumb(self, preset, view):
        file = self.folder / "picture.toml"
        file.write_text(toml_text(preset))
        return self.render(self.bake(file), view, THUMB)


def font(size):
    return ImageFont.load_default(size)


def shown(value):
    return (
        " to ".join(f"{v:g}" for v in value)
        if isinstance(value, list) and len(value) == 2
        else ", ".join(f"{v:g}" for v in value)
        if isinstance(value, list)
        else value
        if isinstance(value, str)
        else f"{value:g}"
    )


def key_sheet(studio, sheet_rows):
    width = LABEL_WIDTH + 3 * (THUMB[0] + 4)
    step = THUMB[1] + CAPTION + 4
    sheet = Image.new("RGB", (width, step * len(sheet_rows)), PAPER)
    draw = ImageDraw.Draw(sheet)
    for i, row in enumerate(sheet_rows):
        y = i * step
        section, _, name = row.key.rpartition(".")
        draw.text((8, y + 46), f"[{section}]" if section else "", fill=INK, font=font(12))
        draw.text((8, y + 61), name, fill=(255, 255, 255), font=font(15))
        draw.text((8, y + 82), row.unit, fill=INK, font=font(11))
        for j, value in enumerate(row.values):
            x = LABEL_WIDTH + j * (THUMB[0] + 4)
            sheet.paste(studio.thumb(with_value(row.base, row.key, value), row.view), (x, y + 2))
            draw.text(
                (x + THUMB[0] / 2, y + 2 + THUMB[1] + CAPTION / 2),
                shown(value),
                fill=INK,
                font=font(12),
                anchor="mm",
            )
    return sheet


def preset_sheet(studio, names, size=(640, 360)):
    sheet = Image.new("RGB", (2 * size[0] + 4, (len(names) + 1) // 2 * (size[1] + 4)), PAPER)
    draw = ImageDraw.Draw(sheet)
    for i, name in enumerate(names):
        x, y = i % 2 * (size[0] + 4), i // 2 * (size[1] + 4)
        sheet.paste(studio.render(studio.bake(name), PRESETS[name], size), (x, y))
        draw.text(
            (x + 10, y + 8),
            name,
            fill=(255, 255, 255),
            font=font(20),
            stroke_width=2,
            stroke_fill=(0, 0, 0),
        )
    return sheet


def save(sheet, path, colours):
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.quantize(colours, Image.Quantize.MEDIANCUT, kmeans=2, dither=Image.Dither.NONE).save(
        path, optimize=True
    )
    print(f"{path} {path.stat().st_size // 1024} KB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", default=ROOT / "build/release/bin")
    parser.add_argument("--only", default="", help="sheets, by comma: patch, ..., presets")
    parser.add_argument("--out", default=ROOT / "docs/gallery")
    options = parser.parse_args()
    only = [s for s in options.only.split(",") if s]
    with tempfile.TemporaryDirectory() as folder:
        studio = Studio(options.bin, folder)
        for name, sheet_rows in rows().items():
            if not only or name in only:
                save(
                    key_sheet(studio, sheet_rows),
                    Path(options.out) / "texgen" / f"{name}.png",
                    COLOURS,
                )
        if not only or "presets" in only:
            names = list(PRESETS)
            save(preset_sheet(studio, names[:4]), Path(options.out) / "presets.png", 256)
            save(preset_sheet(studio, names[4:]), Path(options.out) / "presets2.png", 256)


if __name__ == "__main__":
    main()
