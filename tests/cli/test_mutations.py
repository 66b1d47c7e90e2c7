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
from geopackage import geopackage
from geotiff import geotiff
from small_files import CHANNELS, CONTROLS, ENDLESS, MATRICES, RECORD, TRIANGLE
from sward_cli import CliCase, TINY_PRESET
from test_files import png
import test_texgen_import
from test_texgen_import import Grid, meta, posts, write_vdb

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


class Mutations(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()
        self.env = None

    def held(self, name, program, *arguments, output=None):
        """Runs a program on a file that may be anything. A refusal names what it was given and
        leaves the folder as it was."""
        before = sward_cli.snapshot(self.dir)
        result = sward_cli.run(program, *arguments, cwd=self.dir, env=self.env)
        if (
            result.code == 6 and arguments[0] == "view"
        ):  # read, and a display is all that is missing
            self.assertIn("display", result.err)
            return
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
            TRIANGLE,
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

    def test_land(self):
        """Areas and lines, as text and as a database."""
        geotiff(self.dir / "h.tif", 17, 17, lambda i, j: 100 + i, "f", **PLACE)
        road = [(500020, 5499850), (500100, 5499900), (500150, 5499950)]
        geopackage(self.dir / "r.gpkg", [(road, "road")] * 3)
        feature = {"type": "Feature", "properties": {"kind": "road"}}
        feature["geometry"] = {
            "type": "LineString",
            "coordinates": [[9.0002, 49.65], [9.001, 49.651]],
        }
        text = {"type": "FeatureCollection", "features": [feature] * 3}
        (self.dir / "r.geojson").write_text(json.dumps(text))
        for name in ("r.geojson", "r.gpkg"):
            self.terrain(
                "h.tif",
                f"[[terrain.line]]\nfile = '{name}'\nwidth_m = 6\nwhere = \"kind = 'road'\"\n"
                "ground = 'asphalt'\n",
            )
            self.assert_done(sward_cli.run(*self.INFO[:-1], cwd=self.dir))
            self.each(name, (self.dir / name).read_bytes(), self.INFO)
        # A table that is a view without an end, and pages that break after the first features.
        geopackage(self.dir / "r.gpkg", [], table=ENDLESS)
        self.refuse(4, ["r.gpkg: database"], *self.INFO[1:-1])
        geopackage(self.dir / "r.gpkg", [(road * 30, "road")] * 300)
        whole = (self.dir / "r.gpkg").read_bytes()
        half = len(whole) // 2
        (self.dir / "r.gpkg").write_bytes(whole[:half] + b"\xff" * 100000 + whole[half + 100000 :])
        self.refuse(3, ["r.gpkg: cannot decode"], *self.INFO[1:-1])

    def test_machines(self):
        """What drives, what flies, and what steers it: read before a window is asked for."""
        for name, option in (("car", "--drive"), ("trainer", "--fly"), ("helicopter", "--fly")):
            folder = "vehicles" if option == "--drive" else "aircraft"
            whole = (sward_cli.SOURCE / folder / f"{name}.toml").read_bytes()
            self.each(
                f"{name}.toml",
                whole,
                ("sward", "view", "scene.toml", option, f"./{name}.toml", None),
            )
        self.env = sward_cli.environment(XDG_CONFIG_HOME=str(self.dir))
        (self.dir / "sward").mkdir()
        self.each("sward/controls.toml", CONTROLS, ("sward", "view", "--list-joysticks", None))

    def test_flights(self):
        """Records, channels, a host's camera and what lay pressed: of render."""
        render = ("sward", "render", "scene.toml", "--size", "2x2", "--density", "0", "-q", "-o")
        for name, option, whole in (
            ("f.rec", "--replay", RECORD),
            ("c.toml", "--channels", CHANNELS),
            ("m.json", "--camera-matrices", MATRICES),
        ):
            command = tuple(
                word for word in render if option != "--channels" or word not in ("--size", "2x2")
            )
            if option == "--replay":
                command = (*command[:-1], "--frames", "0:0", "-o")
                output = "o%d.png"
            else:
                output = "o.png"
            made = {"--replay": "o0.png", "--channels": "o-a.png"}.get(option, "o.png")
            (self.dir / name).write_bytes(whole)
            self.assert_done(sward_cli.run(*command, output, option, name, cwd=self.dir))
            (self.dir / made).unlink()
            self.each(name, whole, (*command, output, option, name, made))

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


class Metadata(test_texgen_import.ImportCase):
    def test_light_of_the_metadata(self):
        """Taken where it is whole; refused by name where a term is missing, of another type or out
        of its range; passed over with a warning where its version is another."""
        terms = {"kd": 0.5, "pd": 2.0, "ks": 0.25, "ps": 40.0, "translucency": 0.125}

        def write(version=1, **changes):
            entries = [meta("light_version", "int32", struct.pack("<i", version))]
            for key, value in {**terms, **changes}.items():
                if value is not None:
                    kind = "float" if isinstance(value, float) else "double"
                    value = struct.pack("<f" if kind == "float" else "<d", value)
                    entries.append(meta("light_" + key, kind, value))
            write_vdb(self.dir / "l.vdb", Grid("density", posts(), entries=entries))

        write()
        self.import_set("l.vdb", "set")
        look = json.loads((self.dir / "set/set.json").read_text())["species"][0]["look"]
        self.assertEqual({key: look[key] for key in terms}, terms)
        for key, value in (
            ("kd", None),
            ("kd", -1.0),
            ("pd", 0.0),
            ("ks", float("nan")),
            ("ps", float("inf")),
            ("translucency", 1e30),
            ("translucency", 1),
        ):
            with self.subTest(key=key, value=value):
                write(**{key: value})
                self.refuse_texgen(3, ["l.vdb", "light_" + key], "import", "l.vdb", "-o", "bad")
        write(version=2, kd=float("nan"))
        result = self.texgen("inspect", "l.vdb")
        self.assert_done(result)
        self.assertIn("light_version 2", result.err)


if __name__ == "__main__":
    unittest.TestCase.maxDiff = 400
    sward_cli.main()
