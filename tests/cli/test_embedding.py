# SPDX-License-Identifier: Apache-2.0
"""The host of docs/embedding: built out of the tree from the installed package, by pkg-config and
beside the source tree; its picture looked at."""

import json
import math
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from PIL import Image

import sward_cli
from sward_cli import BIN, SOURCE

BUILD = BIN.parent
EMBEDDING = SOURCE / "docs/embedding"
WIDTH, HEIGHT = 320, 200
PUBLIC = ["blower.h", "camera.h", "error.h", "field.h", "log.h", "version.h", "view.h"]


def run(*command, **more):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, **more)
    assert result.returncode == 0, f"{command}: {result.stdout[-2000:]}{result.stderr[-4000:]}"
    return result.stdout


def read_ppm(path):
    data = path.read_bytes()
    magic, width, height, most = data.split(maxsplit=4)[:4]
    assert (magic, most) == (b"P6", b"255"), data[:20]
    return int(width), int(height), data[-3 * int(width) * int(height) :]


def banked_camera():
    """The host's camera as matrices, row by row."""
    pitch, roll = math.radians(-10), math.radians(25)
    ahead = (0, math.sin(pitch), -math.cos(pitch))
    level, above = (1, 0, 0), (0, math.cos(pitch), math.sin(pitch))
    right = [math.cos(roll) * level[i] - math.sin(roll) * above[i] for i in range(3)]
    up = [math.cos(roll) * above[i] + math.sin(roll) * level[i] for i in range(3)]
    eye = (0, 18, 0)  # the ground is 16.3 there
    rows = [
        [*axis, -sum(axis[i] * eye[i] for i in range(3))]
        for axis in (right, up, [-a for a in ahead])
    ]
    f = 1 / math.tan(math.radians(30))
    clip = [f * HEIGHT / WIDTH, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, 0.05000000074505806, 0, 0, -1, 0]
    return {"view_from_world": sum(rows, []) + [0, 0, 0, 1], "clip_from_view": clip}


class Embedding(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = Path(tempfile.mkdtemp(prefix="sward-host-"))
        cls.addClassCleanup(shutil.rmtree, cls.dir)
        cls.prefix = cls.dir / "prefix"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.set = sward_cli.tiny_set()
        cls.scene = cls.dir / "scene"
        cls.scene.mkdir()
        sward_cli.write_height(cls.scene / "height.raw")
        (cls.scene / "scene.toml").write_text(sward_cli.SCENE)
        shutil.copytree(cls.set, cls.scene / "set")

    def build(self, name, *options, **environment):
        build = self.dir / name
        env = dict(os.environ, **environment)
        run(
            "cmake",
            "-G",
            "Ninja",
            "-S",
            EMBEDDING,
            "-B",
            build,
            "-DCMAKE_BUILD_TYPE=Release",
            *options,
            env=env,
        )
        run("ninja", "-C", build, "host", env=env)
        out = self.dir / f"{name}.ppm"
        run(build / "host", self.scene / "scene.toml", self.set, out, env=sward_cli.environment())
        return read_ppm(out)

    def check(self, picture):
        width, height, rgb = picture
        self.assertEqual((width, height), (WIDTH, HEIGHT))
        pixels = [rgb[i : i + 3] for i in range(0, len(rgb), 3)]
        red = [i for i, p in enumerate(pixels) if p[0] > 150 and p[1] < 90 and p[2] < 90]
        self.assertGreater(len(set(pixels)), 200, "black, or next to it")
        self.assertGreater(len(red), WIDTH * HEIGHT // 100, "no box")
        self.assertLess(len(red), WIDTH * HEIGHT // 4)
        self.red = len(red)
        rows, columns = [i // WIDTH for i in red], [i % WIDTH for i in red]
        box = (min(columns), min(rows), max(columns), max(rows))
        return pixels, box

    def same_as_render(self, pixels, box):
        """Where the box is not, the host's picture is sward's own."""
        camera = self.dir / "camera.json"
        camera.write_text(json.dumps(banked_camera()))
        run(
            BIN / "sward",
            "render",
            self.scene,
            "--camera-matrices",
            camera,
            "--size",
            f"{WIDTH}x{HEIGHT}",
            "-o",
            self.dir / "own.png",
            env=sward_cli.environment(),
        )
        rgb = Image.open(self.dir / "own.png").convert("RGB").tobytes()
        differing = [i for i in range(WIDTH * HEIGHT) if pixels[i] != rgb[3 * i : 3 * i + 3]]
        outside = [
            i
            for i in differing
            if not (
                box[0] - 1 <= i % WIDTH <= box[2] + 1 and box[1] - 1 <= i // WIDTH <= box[3] + 1
            )
        ]
        self.assertGreater(len(differing), 100)
        self.assertEqual(outside, [])
        # Grass before the box: its own pixels are fewer than those that it changed.
        self.assertGreater(len(differing), self.red)

    def test_package(self):
        for name in PUBLIC:
            text = (self.prefix / "include/sward" / name).read_text()
            for line in text.splitlines():
                if line.startswith("#include"):
                    self.assertRegex(
                        line,
                        r'^#include (<[a-z_]+>|<glm/(vec|mat)[234x]*\.hpp>|"sward/[a-z]+\.h")$',
                    )
        self.assertEqual(sorted(p.name for p in (self.prefix / "include/sward").iterdir()), PUBLIC)
        picture = self.build("package", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        pixels, box = self.check(picture)
        self.same_as_render(pixels, box)

    def test_pkg_config(self):
        places = [p for p in self.prefix.rglob("pkgconfig") if p.is_dir()]
        self.assertEqual(len(places), 1)
        self.check(
            self.build("pkgconfig", "-DSWARD_BY_PKG_CONFIG=ON", PKG_CONFIG_PATH=str(places[0]))
        )

    def test_source_tree(self):
        # Unoptimised: what is asked is that it builds and draws, and optimising takes most of the
        # time.
        self.check(
            self.build("source", f"-DSWARD_SOURCE={SOURCE}", "-DCMAKE_CXX_FLAGS_RELEASE=-O0")
        )


if __name__ == "__main__":
    unittest.main()
