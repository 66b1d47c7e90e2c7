# SPDX-License-Identifier: Apache-2.0
"""How high grass stands above a crest against the sky, in the march and in every blade as geometry:

    python tests/image/skyline.py [--distances 20,60,120] [-- ARGUMENTS OF SWARD]

The height is what the grass hides of the sky over each metre of bare crest: coverage, summed up
over the rows that show sky where nothing
grows. SWARD_BIN_DIR names the folder of the programs."""

import argparse
import json
import math
import struct
import tempfile
from pathlib import Path

import numpy as np

import sward_image
from sward_image import sward_cli

ROWS, COLUMNS, FOV = 96, 160, 8.8  # as a window of this size in a frame of 720 rows and 60 degrees
RISE = math.tan(math.radians(10))
REFERENCE = ("--tiers", "reference", "--reference-distance", "400", "--reference-grid", "2")


def write_crest(folder, distance):
    """A ridge along x that falls off by 10 degrees to both sides, and an eye `distance` metres
    before it, 1.7 m above the ground."""
    side, spacing = 129, 4.0
    heights = [
        100 - RISE * abs(row - (side - 1) / 2) * spacing for row in range(side) for _ in range(side)
    ]
    (folder / "flat.raw").write_bytes(struct.pack(f"<{side * side}f", *heights))
    (folder / "flat.json").write_text(
        json.dumps({"width": side, "height": side, "spacing_m": [spacing, spacing]})
    )
    pitch = math.degrees(math.atan((RISE * distance - 1.7 + 0.15) / distance))
    (folder / "scene.toml").write_text(
        sward_image.scene_text([sward_image.camera("eye", (3, 1.7, distance), pitch, FOV)], 0)
    )


def coverage_and_sky(folder, arguments):
    """Of each pixel: share of grass; true where the first sample shows sky."""
    result = sward_cli.run(
        "sward",
        "render",
        "scene.toml",
        "-o",
        "out.exr",
        "--camera",
        "eye",
        "--time",
        "2",
        "--size",
        f"{COLUMNS}x{ROWS}",
        "--aov",
        "color,coverage,tier",
        "-q",
        *arguments,
        cwd=folder,
        env=sward_cli.environment(),
        timeout=1200,
    )
    assert result.code == 0, f"{arguments}: {result.err}"
    channels = sward_image.load_exr(folder / "out.exr")
    return channels["coverage"], channels["tier"] > 6.5


def heights(distance, builds):
    """Mean height in metres of the grass above the crest for each build's arguments."""
    with tempfile.TemporaryDirectory(prefix="sward-skyline-") as name:
        folder = Path(name)
        write_crest(folder, distance)
        _, sky = coverage_and_sky(folder, ("--density", "0", "--tiers", "blades"))
        assert (
            0.2 < sky.mean() < 0.8
        ), f"the crest is not in the picture: {sky.mean():.2f} of it is sky"
        metre_px = ROWS / 2 / math.tan(math.radians(FOV / 2)) / distance
        return [
            float((coverage_and_sky(folder, arguments)[0] * sky).sum(axis=0).mean() / metre_px)
            for arguments in builds
        ]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--distances", default="20,60,120", help="metres, with commas")
    parser.add_argument("arguments", nargs="*", help="of sward, after --")
    options = parser.parse_args()
    for distance in map(float, options.distances.split(",")):
        truth, found = heights(distance, (REFERENCE, options.arguments))
        print(
            f"{distance:5.0f} m: truth {truth:.3f} m, found {found:.3f} m, ratio {found / truth:.3f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
