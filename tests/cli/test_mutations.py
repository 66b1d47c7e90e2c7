# SPDX-License-Identifier: Apache-2.0
"""Files of every kind that we read, cut short, with bits and words changed: no signal, no hang, no
memory without end, one line that
names a file, and nothing half written. The same few at every run; SWARD_MUTATIONS=N makes N of each
kind and command."""

import base64
import hashlib
import json
import os
import random
import shutil
import struct
import unittest

import numpy
import OpenEXR

import sward_cli
from geotiff import geotiff
from sward_cli import CliCase, TINY_PRESET
from test_files import png
from test_texgen_import import Grid, posts, write_vdb

EACH = int(os.environ.get("SWARD_MUTATIONS", 2))
MOST_CPU_S, MOST_MIB = 10, 1024
PLACE = {"epsg": 32632, "affine": (10, 0, 500000, 0, -10, 5500000)}
WORDS = [struct.pack("<I", v) for v in (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000000)] + [
    b"\x7f\xff\xff\xff",
    b"\xff\xff\xff\x7f\0\0\0\0",
]
SCENE = """\
[terrain]
elevation = "{elevation}"
{more}
[grass]
set = "set"
[camera.road]
position = [0, 1.7, 0]
"""


def mutate(data, rng):
    """One of: cut short, bits flipped, a word of an odd size written over, a piece taken out, a
    piece doubled."""
    out = bytearray(data)
    head = (
        min(len(out), 512) if rng.random() < 0.5 else len(out)
    )  # the first bytes hold most that is believed
    kind = rng.randrange(5)
    if kind == 0:
        return bytes(out[: rng.randrange(len(out))])
    if kind == 1:
        for _ in range(rng.choice((1, 1, 4, 32))):
            out[rng.randrange(head)] ^= 1 << rng.randrange(8)
        return bytes(out)
    at = rng.randrange(head)
    if kind == 2:
        word = rng.choice(WORDS)
        out[at : at + len(word)] = word[: len(out) - at]
    else:
        length = rng.randrange(1, 64)
        out[at : at + length] = b"" if kind == 3 else bytes(out[at : at + length]) * 2
    return bytes(out)


def triangle():
    """A mesh of one triangle as .glb."""
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}],
            "scene": 0,
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": 3,
                    "type": "VEC3",
                    "min": [0, 0, 0],
                    "max": [1, 1, 1],
                },
                {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
            ],
            "bufferViews": [
                {"buffer": 0, "byteLength": 36},
                {"buffer": 0, "byteOffset": 36, "byteLength": 6},
            ],
            "buffers": [{"byteLength": 44}],
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    data = struct.pack("<9f3H2x", 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 2)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(data), 0x004E4942)
        + data
    )
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


class Mutations(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def held(self, name, program, *arguments, output=None):
        """Runs a program on a file that may be anything. A refusal names what it was given and
        leaves the folder as it was."""
        before = sward_cli.snapshot(self.dir)
        result = sward_cli.run(program, *arguments, cwd=self.dir)
        self.assertIn(result.code, (0, 3, 4, 5), result.err)
        self.assertLess(result.cpu_s, MOST_CPU_S)
        self.assertLess(result.mib, MOST_MIB)
        self.assertEqual(sward_cli.temporaries(self.dir), {})
        lines = [line for line in result.err.splitlines() if not line.startswith("warning: ")]
        if result.code:
            self.assertEqual(len(lines), 1, result.err)
            self.assertRegex(lines[0], r"^error: [^:]*" + name)
            self.assertEqual(sward_cli.snapshot(self.dir), before)
        elif output:
            path = self.dir / output
            self.assertTrue(path.exists())
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def each(self, name, whole, *runs, of=None):
        """Mutations of the file `name`, under each of the commands: (program, its arguments ...,
        output or None)."""
        path = self.dir / name
        rng = random.Random(f"{name} {runs[0]}")
        for number in range(EACH * len(runs)):
            *command, output = runs[number % len(runs)]
            path.write_bytes(mutate(whole, rng))
            with self.subTest(name=name, number=number, command=" ".join(command)):
                try:
                    self.held(of or name, *command, output=output)
                except AssertionError:
                    print(f"{name} as base64: {base64.b64encode(path.read_bytes())[:4000]}")
                    raise
        path.write_bytes(whole)

    def terrain(self, elevation, more=""):
        (self.dir / "scene.toml").write_text(SCENE.format(elevation=elevation, more=more))

    INFO = ("sward", "info", "scene.toml", None)

    def test_elevation(self):
        geotiff(self.dir / "h.tif", 17, 17, lambda i, j: 100 + i, "h", **PLACE, nodata=-9999)
        (self.dir / "h.asc").write_text(
            "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 30\nNODATA_value -9999\n"
            + "1 2 3 4 5\n" * 4
        )
        (self.dir / "N36W085.hgt").write_bytes(b"\0\7" * 1201 * 1201)
        floats = numpy.ones((9, 9), dtype=numpy.float32)
        OpenEXR.File(
            {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"Y": floats}
        ).write(str(self.dir / "h.exr"))
        for name in ("h.tif", "h.asc", "N36W085.hgt", "h.exr"):
            self.terrain(name, "size_m = [80, 80]" if name == "h.exr" else "")
            self.each(name, (self.dir / name).read_bytes(), self.INFO)
        self.terrain("height.raw")
        for name in ("height.raw", "height.json"):
            self.each(name, (self.dir / name).read_bytes(), self.INFO, of="height")

    def test_masks(self):
        geotiff(self.dir / "h.tif", 17, 17, lambda i, j: 100 + i, "f", **PLACE)
        geotiff(self.dir / "m.tif", 17, 17, lambda i, j: 255 * (i > 5), "B", **PLACE)
        (self.dir / "m.png").write_bytes(
            png(16, 16, b"".join(b"\0" + bytes(range(0, 256, 16)) for _ in range(16)))
        )
        for name in ("m.tif", "m.png"):
            for classes in ("", "[terrain.classes]\n0 = 0.5"):
                self.terrain("h.tif", f'mask = "{name}"\n{classes}')
                self.each(name, (self.dir / name).read_bytes(), self.INFO, of=r"(m\.|scene.toml)")

    def test_text(self):
        self.each(
            "scene.toml",
            (sward_cli.SCENE + "[sun]\nazimuth_deg = 12\n").encode(),
            self.INFO,
            of=r"(scene\.toml|height|set|.*)",
        )
        self.each("p.toml", TINY_PRESET.encode(), ("texgen", "p.toml", "--dry-run", "-q", None))

    def test_mesh(self):
        self.terrain(
            "height.raw",
            '[[object]]\nkind = "mesh"\nmesh = "m.glb"\nposition = [0, 0, 0]\ncollides = false',
        )
        self.each(
            "m.glb",
            triangle(),
            (
                "sward",
                "render",
                "scene.toml",
                "-o",
                "out.png",
                "--size",
                "16x9",
                "--density",
                "0",
                "-q",
                "out.png",
            ),
        )

    def test_sets(self):
        """Files whose size and hash are right again in set.json, and set.json itself."""
        text = (self.dir / "set/set.json").read_text()
        verify = ("texgen", "verify", "set", "-q", None)
        for name in (
            "blades.glb",
            "layers.ktx2",
            "columns.ktx2",
            "slab_fibres_2.ktx2",
            "correction.ktx2",
            "far.ktx2",
        ):
            whole, rng = (self.dir / "set" / name).read_bytes(), random.Random(name)
            for number in range(EACH):
                bad = mutate(whole, rng)
                (self.dir / "set" / name).write_bytes(bad)
                root = json.loads(text)
                root["files"][name] = {
                    **root["files"][name],
                    "bytes": len(bad),
                    "sha256": hashlib.sha256(bad).hexdigest(),
                }
                (self.dir / "set/set.json").write_text(json.dumps(root))
                with self.subTest(name=name, number=number):
                    self.held(f"({name}|set.json)", *verify[:-1])
            if name.endswith("ktx2"):
                self.each(f"set/{name}", whole, ("texgen", "inspect", f"set/{name}", None))
            (self.dir / "set" / name).write_bytes(whole)
        self.each(
            "set/set.json", text.encode(), verify, ("texgen", "inspect", "set", None), of="set"
        )

    def test_volumes(self):
        values = posts(32, 4)
        write_vdb(
            self.dir / "v.vdb",
            Grid("density", values),
            Grid("Cd", {at: (0.2, 0.3, 0.1) for at in values}, 3),
        )
        whole = (self.dir / "v.vdb").read_bytes()
        self.each(
            "v.vdb",
            whole,
            ("texgen", "inspect", "v.vdb", None),
            ("texgen", "seam", "v.vdb", "-o", "s.vdb", "-q", "s.vdb"),
        )
        rng = random.Random(9)
        for number in range(
            EACH
        ):  # what is whole after all takes seconds to import: most of these are cut
            (self.dir / "v.vdb").write_bytes(mutate(whole[: rng.randrange(64, len(whole))], rng))
            with self.subTest(number=number):
                self.held(
                    "v.vdb",
                    "texgen",
                    "import",
                    "v.vdb",
                    "-o",
                    "new",
                    "--size",
                    "32",
                    "--far-rays",
                    "256",
                    "--no-preview",
                    "-q",
                    output="new",
                )

    def test_stacks(self):
        (self.dir / "stack").mkdir()
        picture = png(32, 32, b"".join(b"\0" + bytes(range(0, 256, 8)) for _ in range(32)))
        described = json.dumps(
            {"side_m": 1, "canopy_m": 0.4, "images": [{"file": "a.png"}, {"file": "b.png"}]}
        ).encode()
        for name, whole in (("a.png", picture), ("b.png", picture), ("stack.json", described)):
            (self.dir / "stack" / name).write_bytes(whole)
        seam = ("texgen", "seam", "stack", "-o", "new", "-q", "new")
        for name, whole in (("a.png", picture), ("b.png", picture), ("stack.json", described)):
            self.each(f"stack/{name}", whole, seam, of="stack")


if __name__ == "__main__":
    unittest.TestCase.maxDiff = 400
    sward_cli.main()
