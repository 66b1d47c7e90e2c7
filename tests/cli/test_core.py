# SPDX-License-Identifier: Apache-2.0
"""The preset `core`: builds without the heavy libraries, links none of them, and renders .hgt and
raw elevation."""

import array
import json
import math
import subprocess

import sward_cli
from sward_cli import CliCase, SIZE, SOURCE

CORE = SOURCE / "build/core"
HEAVY = ("OpenImageIO", "gdal", "openvdb", "glfw", "OpenEXR", "tbb")


def setUpModule():
    """Configures and builds; ninja and ccache make a second run quick."""
    if not (CORE / "build.ninja").exists():
        subprocess.run(
            ["cmake", "--preset", "core"], cwd=SOURCE, check=True, stdout=subprocess.DEVNULL
        )
    subprocess.run(["ninja", "-C", str(CORE), "sward"], check=True)
    sward_cli.BIN = CORE / "bin"


class Core(CliCase):
    def picture(self, name):
        """(width, height, number of colours) of a PPM."""
        data = (self.dir / name).read_bytes()
        magic, width, height, most, pixels = data.split(maxsplit=4)[:4] + [data[-3 * 64 * 36 :]]
        self.assertEqual((magic, most), (b"P6", b"255"))
        colours = {pixels[i : i + 3] for i in range(0, len(pixels), 3)}
        return int(width), int(height), len(colours)

    def render_here(self):
        result = self.sward(
            "render", "scene.toml", "-o", "out.ppm", "--size", SIZE, "--stats", "s.json"
        )
        self.assert_done(result)
        width, height, colours = self.picture("out.ppm")
        self.assertEqual((width, height), (64, 36))
        self.assertGreater(colours, 20)
        stats = json.loads((self.dir / "s.json").read_text())
        self.assertEqual(stats["size"], [64, 36])
        self.assertGreater(len(stats["passes"]), 4)

    def test_raw(self):
        self.scene()
        self.render_here()

    def test_hgt(self):
        self.scene(sward_cli.SCENE.replace("height.raw", "N36W085.hgt"))
        row = array.array("h", (int(300 + 40 * math.sin(i / 60)) for i in range(1201)))
        row.byteswap()
        (self.dir / "N36W085.hgt").write_bytes(row.tobytes() * 1201)
        self.render_here()

    def test_links(self):
        linked = subprocess.run(
            ["ldd", str(CORE / "bin/sward")], check=True, capture_output=True, text=True
        ).stdout
        for name in HEAVY:
            self.assertNotIn(f"lib{name}", linked)

    def test_what_it_cannot(self):
        self.scene()
        self.refuse(6, ["view", "sward render"], "view", "scene.toml")
        self.refuse(2, ["--output", ".ppm"], "render", "scene.toml", "-o", "out.png")
        self.scene(sward_cli.SCENE.replace("height.raw", "height.tif"))
        self.refuse(3, ["height.tif", ".hgt"], "render", "scene.toml", "-o", "out.ppm")
        self.scene(sward_cli.SCENE.replace('"set"', '"grass.toml"'))
        (self.dir / "grass.toml").write_text(sward_cli.TINY_PRESET)
        self.refuse(3, ["grass.set", "texgen"], "render", "scene.toml", "-o", "out.ppm")
        self.assertIn("core build", self.sward("info").out)


if __name__ == "__main__":
    sward_cli.main()
