# SPDX-License-Identifier: Apache-2.0
"""Grass from 300 m to 4 km, where a pixel is longer on the ground than a ray's whole way through
the canopy and higher than the grass: it covers level ground to the horizon, and no bare pixel
stands on a crest."""

import json
import math
import struct
import tempfile
import unittest
from pathlib import Path

import numpy as np

import sward_image
from sward_image import main, sward_cli

SIZE = (96, 160)  # columns, rows: as many pixels a degree as a frame of 720 rows and 60 degrees
FOV = 2 * math.degrees(math.atan(SIZE[1] / 2 * math.tan(math.radians(30)) / 360))
SIDE, SPACING_M = 257, 32.0
NEAREST_M = 300


def seen(height_at, pitch_deg):
    """Coverage and distance along the axis (m; 0: sky) over land of these heights, 60 m above it
    and 3.5 km south of its middle, to the north."""
    with tempfile.TemporaryDirectory(prefix="sward-away-") as name:
        folder = Path(name)
        middle = (SIDE - 1) / 2
        heights = [
            height_at((column - middle) * SPACING_M, (row - middle) * SPACING_M)
            for row in range(SIDE)
            for column in range(SIDE)
        ]
        (folder / "flat.raw").write_bytes(struct.pack(f"<{SIDE * SIDE}f", *heights))
        (folder / "flat.json").write_text(
            json.dumps({"width": SIDE, "height": SIDE, "spacing_m": [SPACING_M, SPACING_M]})
        )
        camera = sward_image.camera("eye", (3, 60, 3500), pitch_deg, FOV)
        (folder / "scene.toml").write_text(sward_image.scene_text([camera], 0))
        arguments = ("render", "scene.toml", "-o", "out.exr", "--camera", "eye", "--time", "2")
        aovs = ("--size", f"{SIZE[0]}x{SIZE[1]}", "--aov", "color,coverage,depth", "-q")
        env = sward_cli.environment()
        result = sward_cli.run("sward", *arguments, *aovs, cwd=folder, env=env, timeout=1200)
        assert result.code == 0, result.err
        channels = sward_image.load_exr(folder / "out.exr")
        return channels["coverage"], channels["depth"]


class Away(unittest.TestCase):
    def test_level_ground_is_covered_to_the_horizon(self):
        coverage, distance = seen(lambda x, z: 100.0, -6)
        for low, high in ((NEAREST_M, 600), (600, 1200), (1200, 2400), (2400, 5000)):
            there = coverage[(distance > low) & (distance < high)]
            self.assertGreater(there.size, 2 * SIZE[0], f"{low} to {high} m")
            print(f"{low} to {high} m: coverage {there.mean():.3f}, least {there.min():.3f}")
            self.assertGreater(there.mean(), 0.97, f"{low} to {high} m")

    def test_no_crest_is_bare(self):
        def hills(x, z):
            return 100 + 12 * math.sin(z / 110) + 6 * math.sin(x / 150 + z / 260)

        coverage, distance = seen(hills, -3)
        # A pixel with sky in it is covered in part alone.
        land = distance > NEAREST_M
        inner = land & np.roll(land, 1, axis=0) & np.roll(land, 2, axis=0)
        bare = (coverage < 0.6) & inner
        print(f"{bare.sum()} of {inner.sum()} pixels are bare; mean {coverage[inner].mean():.3f}")
        self.assertGreater(inner.sum(), 4000)
        self.assertLess(bare.sum(), 0.001 * inner.sum())
        self.assertGreater(coverage[inner].mean(), 0.95)


if __name__ == "__main__":
    main()
