# SPDX-License-Identifier: Apache-2.0
"""texgen import and seam as tools: the same set at any number of threads, volumes and stacks that
are not quite right, and damaged
ones, which no library may be the first to see."""

import hashlib
import json
import random
import struct

import numpy
import OpenEXR
from PIL import Image

import sward_cli
from sward_cli import CliCase

FAST = ("--no-preview", "-q")
FEW = ("--far-rays", "1024")  # where the far field's noise is not the question


def text(words):
    return struct.pack("<I", len(words)) + words.encode()


def meta(name, kind, value):
    return text(name) + text(kind) + struct.pack("<I", len(value)) + value


def transform(voxel, shift=(0.0, 0.0, 0.0)):
    scale = struct.pack("<3d", voxel, voxel, voxel)
    return text("UniformScaleTranslateMap") + struct.pack("<3d", *shift) + scale + bytes(96)


class Grid:
    """A grid of OpenVDB's format, unpacked, as it stands in a file: values in whole leaves of one
    node."""

    def __init__(self, name, values, components=1, matrix=None, entries=()):
        self.name, self.values, self.components = name, values, components
        self.kind = "Tree_float_5_4_3" if components == 1 else "Tree_vec3s_5_4_3"
        self.transform = matrix or transform(0.01)
        self.entries = entries

    def leaves(self):
        out = {}
        for (x, y, z), value in self.values.items():
            out.setdefault((x // 8, y // 8, z // 8), {})[(x % 8 * 8 + y % 8) * 8 + z % 8] = value
        return dict(sorted(out.items()))

    def node(self, children, cells):
        bits = bytearray(cells // 8)
        for child in children:
            bits[child // 8] |= 1 << child % 8
        return bytes(bits) + bytes(cells // 8) + b"\x06" + bytes(cells * 4 * self.components)

    def mask(self, leaf):
        bits = bytearray(64)
        for cell in leaf:
            bits[cell // 8] |= 1 << cell % 8
        return bytes(bits)

    def encode(self):
        """Head and tree, and the leaves' values. All voxels lie in 0..127."""
        leaves = self.leaves()
        head = struct.pack("<I", 0) + struct.pack("<I", 1 + len(self.entries))
        head += meta("class", "string", b"fog volume") + b"".join(self.entries) + self.transform
        head += (
            struct.pack("<i", 1) + bytes(4 * self.components) + struct.pack("<II3i", 0, 1, 0, 0, 0)
        )
        order = sorted((x * 16 + y) * 16 + z for x, y, z in leaves)
        head += self.node([0], 32768) + self.node(order, 4096)
        blocks = b""
        for index in order:
            leaf = leaves[(index // 256, index // 16 % 16, index % 16)]
            head += self.mask(leaf)
            cells = [leaf.get(i, (0.0,) * self.components) for i in range(512)]
            blocks += (
                self.mask(leaf)
                + b"\x06"
                + b"".join(struct.pack(f"<{self.components}f", *cell) for cell in cells)
            )
        return head, blocks


def write_vdb(path, *grids):
    out = (
        b" BDV\0\0\0\0"
        + struct.pack("<III", 224, 10, 0)
        + b"\1"
        + b"0" * 36
        + struct.pack("<Ii", 0, len(grids))
    )
    for grid in grids:
        out += text(grid.name) + text(grid.kind) + text("")
        head, blocks = grid.encode()
        at = len(out) + 24
        out += struct.pack("<3q", at, at + len(head), at + len(head) + len(blocks)) + head + blocks
    path.write_bytes(out)


def posts(side=32, height=12, value=1.0):
    """Posts of two voxels on a grid of eight: periodic."""
    return {
        (x, y, z): (value,)
        for x in range(side)
        for y in range(height)
        for z in range(side)
        if x % 8 in (3, 4) and z % 8 in (3, 4)
    }


class ImportCase(CliCase):
    def texgen(self, *arguments, **options):
        return sward_cli.run("texgen", *arguments, cwd=self.dir, **options)

    def refuse_texgen(self, code, pieces, *arguments, **options):
        self.refuse(code, pieces, *arguments, program="texgen", **options)

    def content(self, name):
        return {path.name: path.read_bytes() for path in (self.dir / name).iterdir()}

    def own_volume(self):
        """volume.vdb of a small set, packed as texgen packs it."""
        preset = sward_cli.TINY_PRESET.replace("density_per_m2 = 300.0", "density_per_m2 = 60.0")
        (self.dir / "tiny.toml").write_text(preset)
        self.assert_done(self.texgen("tiny.toml", "-o", "own", *FAST))
        return self.dir / "own/volume.vdb"

    def import_set(self, file, name, *arguments):
        result = self.texgen(
            "import", file, "-o", name, "--period", "0.32", *FAST, *FEW, *arguments
        )
        self.assert_done(result)
        self.assert_done(self.texgen("verify", name, "-q"))
        return result


class Import(ImportCase):
    def test_threads(self):
        """The default and 1 to 16 threads make the same bytes, of a foreign volume and of our
        own."""
        write_vdb(self.dir / "posts.vdb", Grid("density", posts()))
        sets = []
        for threads in (0, 1, 2, 16):
            self.import_set("posts.vdb", f"set{threads}", "--threads", threads)
            sets.append(self.content(f"set{threads}"))
        self.own_volume()
        for threads in (0, 1, 5):
            self.assert_done(
                self.texgen(
                    "import",
                    "own/volume.vdb",
                    "-o",
                    f"again{threads}",
                    *FAST,
                    *FEW,
                    "--threads",
                    threads,
                )
            )
        for one, other in [
            *((sets[0], s) for s in sets[1:]),
            *((self.content("again0"), self.content(f"again{n}")) for n in (1, 5)),
        ]:
            self.assertEqual(sorted(one), sorted(other))
            for name, bytes_ in one.items():
                self.assertTrue(bytes_ == other[name], name)

    def test_preview_and_report(self):
        write_vdb(self.dir / "posts.vdb", Grid("density", posts()))
        result = self.texgen(
            "import", "posts.vdb", "-o", "deep/down/set", "--period", "0.32", "--json", *FEW
        )
        self.assert_done(result)
        report = json.loads(result.out)
        self.assertEqual((report["voxels"], round(report["side_m"], 3)), (len(posts()), 0.32))
        self.assertTrue((self.dir / "deep/down/set/preview.png").exists())

    def test_colours(self):
        """A grid of any of the three names gives the species its colour."""
        values = posts()
        for name in ("colour", "color", "Cd"):
            write_vdb(
                self.dir / "c.vdb",
                Grid("density", values),
                Grid(name, {at: (0.5, 0.1, 0.2) for at in values}, 3),
            )
            self.import_set("c.vdb", name)
            look = json.loads((self.dir / name / "set.json").read_text())["species"][0]["look"]
            for found, wanted in zip(look["root"], (0.5, 0.1, 0.2)):
                self.assertAlmostEqual(found, wanted, delta=0.01)

    def test_own_volume_covers_and_colours_as_its_set(self):
        """Within a point and 2 %, at every elevation and in the mean over them, with shared voxels,
        a few blades of another colour, and none that shines as plain grass does."""
        preset = sward_cli.TINY_PRESET.replace(
            "density_per_m2 = 300.0", "density_per_m2 = 1500.0"
        ).replace("size = 64", "size = 128")
        for tiny, fur in (
            ("far_rays = 1024", "far_rays = 16384"),
            ("levels = 2", "levels = 1"),
            ("ks = 0.05", "ks = 0.09"),
            ("ps = 16.0", "ps = 30.0"),
            ("translucency = 0.35", "translucency = 0.2"),
        ):
            preset = preset.replace(tiny, fur)  # far from plain grass's
        preset += "[[species]]\nname = 'green'\nshare = 5\n[[species]]\nname = 'red'\nshare = 1\n[species.colour]\nroot = [0.5, 0.02, 0.02]\ntip = [0.7, 0.03, 0.02]\n"
        (self.dir / "two.toml").write_text(preset)
        few = ("--layers", "2", "--slices", "2", "--levels", "1", *FAST)
        self.assert_done(self.texgen("two.toml", "-o", "own", *few, timeout=600))
        self.assert_done(self.texgen("import", "own/volume.vdb", "-o", "back", *few, timeout=600))
        made, back = (
            json.loads(self.texgen("inspect", name, "--json").out)["far"]
            for name in ("own", "back")
        )
        for one, other in zip(made, back):
            self.assertAlmostEqual(
                one["coverage"], other["coverage"], delta=0.01, msg=one["elevation_deg"]
            )
        light = []
        for name in ("own", "back"):
            with OpenEXR.File(str(self.dir / name / "far.exr"), separate_channels=True) as file:
                channels = file.channels()
                light.append(
                    numpy.array(
                        [
                            [channels[f"{kind}.{c}"].pixels[: len(made)].mean() for c in "RGB"]
                            for kind in ("sun", "sky")
                        ]
                    )
                )
        self.assertLess(numpy.abs(light[1] / light[0] - 1).max(), 0.02, light)
        look = json.loads((self.dir / "back/set.json").read_text())["species"][0]["look"]
        self.assertGreater(light[1][0][0], light[1][0][1], "red blades are seen")
        self.assertLess(look["root"][0], 0.3, "though most blades are of another colour")
        for term, value in (("ks", 0.09), ("ps", 30), ("translucency", 0.2)):
            self.assertAlmostEqual(look[term], value, delta=1e-4)

    def test_rounding_is_told_once(self):
        values = posts()
        values[(0, 0, 0)], values[(1, 0, 0)], values[(2, 0, 0)] = (-1e-4,), (1e-40,), (-1e-30,)
        write_vdb(self.dir / "n.vdb", Grid("density", values))
        for arguments in (
            ("inspect", "n.vdb"),
            ("import", "n.vdb", "-o", "set", "--period", "0.32", "--no-preview", *FEW),
        ):
            result = self.texgen(*arguments)
            self.assert_done(result)
            warnings = [line for line in result.err.splitlines() if line.startswith("warning")]
            self.assertEqual(len(warnings), 1, result.err)
            self.assertIn("3 voxels", warnings[0])
        values[(0, 0, 0)] = (-0.5,)
        write_vdb(self.dir / "n.vdb", Grid("density", values))
        self.refuse_texgen(3, ["n.vdb", "voxel (0, 0, 0)", "-0.5"], "import", "n.vdb", "-o", "bad")

    def test_seam_writes_what_inspect_reads(self):
        values = posts(30, 6)
        values[(1, 1, 1)] = (-1e-4,)
        write_vdb(self.dir / "n.vdb", Grid("density", values))
        self.assert_done(self.texgen("seam", "n.vdb", "-o", "up/s.vdb", "--cut", "6"))
        self.assert_done(self.texgen("inspect", "up/s.vdb"))

    def test_options(self):
        write_vdb(self.dir / "posts.vdb", Grid("density", posts()))
        for value in ("0.05", "0.325", "500"):
            self.refuse_texgen(
                2,
                ["--period", value, "voxels"],
                "import",
                "posts.vdb",
                "-o",
                "set",
                "--period",
                value,
            )
        self.refuse_texgen(2, ["--side"], "import", "posts.vdb", "-o", "set", "--side", "1")
        self.refuse_texgen(2, ["--cut"], "seam", "posts.vdb", "-o", "o.vdb", "--cut", "0.9")
        self.refuse_texgen(2, ["--cut"], "import", "posts.vdb", "-o", "set", "--seam", "--cut", "2")


class Stack(ImportCase):
    def test_exported_pictures_come_back(self):
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        self.assert_done(
            self.texgen("tiny.toml", "-o", "own", "--export", "png", "--no-volume", *FAST)
        )
        self.assert_done(self.texgen("import", "own-png", "-o", "back", *FAST, *FEW))
        self.assert_done(self.texgen("verify", "back", "-q"))
        made, back = (
            json.loads(self.texgen("inspect", name, "--json").out) for name in ("own", "back")
        )
        self.assertAlmostEqual(made["side_m"], back["side_m"], delta=1e-6)
        self.assertAlmostEqual(made["far"][0]["coverage"], back["far"][0]["coverage"], delta=0.05)

    def test_seam_of_small_pictures(self):
        """An eighth of 10 texels is too narrow a border: three are cut. Of 8 texels no third can
        be."""
        for side in (10, 8):
            (self.dir / str(side)).mkdir()
            for i in range(3):
                Image.new("RGBA", (side, side), (40, 90, 20, 255)).save(
                    self.dir / str(side) / f"l{i}.png"
                )
        self.assert_done(self.texgen("seam", "10", "-o", "out", "-q"))
        with Image.open(self.dir / "out/l0.png") as picture:
            self.assertEqual(picture.size, (7, 7))
        self.refuse_texgen(3, ["8 texels", "at least 9"], "seam", "8", "-o", "bad")

    def test_seam_describes_its_stack(self):
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        self.assert_done(
            self.texgen(
                "tiny.toml", "-o", "own", "--export", "png", "--no-volume", "--no-wrap", *FAST
            )
        )
        self.assert_done(self.texgen("seam", "own-png", "-o", "seamless", "-q"))
        stack = json.loads((self.dir / "seamless/stack.json").read_text())
        self.assertAlmostEqual(stack["side_m"], 56 / 64)
        self.assertEqual(len(stack["images"]), 4)
        self.assert_done(self.texgen("import", "seamless", "-o", "set", *FAST, *FEW))
        for image in stack["images"]:
            del image["height_m"]
        del stack["side_m"]
        (self.dir / "seamless/stack.json").write_text(json.dumps(stack))
        self.refuse_texgen(3, ["stack.json", "side_m", "--side"], "import", "seamless", "-o", "new")
        self.assert_done(
            self.texgen("import", "seamless", "-o", "even", "--side", "0.875", *FAST, *FEW)
        )
        self.refuse_texgen(2, ["--up"], "import", "seamless", "-o", "new", "--up", "z")

    def test_descriptions(self):
        folder = self.dir / "stack"
        folder.mkdir()
        self.refuse_texgen(3, ["stack.json"], "import", "stack", "-o", "set")
        for words in (
            "",
            "[]",
            "{}",
            '{"images": []}',
            '{"images": [3]}',
            '{"images": [{"file": "../a.png"}]}',
            "[" * 90000,
            '{"side_m": -1, "images": [{"file": "a.png"}]}',
            '{"images": [{"file": "a.png"}, {"file": "b.png", "height_m": 1}]}',
        ):
            with self.subTest(words=words[:40]):
                (folder / "stack.json").write_text(words)
                self.refuse_texgen(3, ["stack.json"], "import", "stack", "-o", "set")
        (folder / "stack.json").write_text(
            '{"side_m": 1, "canopy_m": 1, "images": [{"file": "a.png"}]}'
        )
        self.refuse_texgen(5, ["a.png"], "import", "stack", "-o", "set")


class Hostile(ImportCase):
    def refused(self, path, *arguments):
        result = self.texgen(*arguments)
        self.assertIn(result.code, (0, 3, 4), (result.code, result.err))
        if result.code:
            self.assert_refusal(result, result.code, path)

    def test_lengths(self):
        """Every chunk's length, a string's, a count, negative and huge: refused by name, soon and
        small."""
        whole = self.own_volume().read_bytes()
        odd = [
            struct.pack("<q", v) for v in (-1, -70, 0x10000000, 1 << 40, -(1 << 63), (1 << 63) - 1)
        ]
        rng = random.Random(5)
        places = [
            73,
            80,
            104,
            112,
            120,
            132,
            *(rng.randrange(8, 1400) for _ in range(30)),
            *(rng.randrange(1400, len(whole) - 8) for _ in range(60)),
        ]
        for number, at in enumerate(places):
            bad = bytearray(whole)
            bad[at : at + 8] = odd[number % len(odd)]
            (self.dir / "bad.vdb").write_bytes(bad)
            with self.subTest(at=at):
                self.refused("bad.vdb", "inspect", "bad.vdb")

    def test_every_grid_is_looked_at(self):
        """Damage in a grid that nobody asks for is told too; so is an end that is not where the
        table of grids says."""
        values = posts(16, 4)
        write_vdb(
            self.dir / "two.vdb",
            Grid("density", values),
            Grid("other", {at: (0.5,) for at in values}),
        )
        whole = (self.dir / "two.vdb").read_bytes()
        self.assert_done(self.texgen("inspect", "two.vdb"))
        leaf = len(whole) - 64 - 1 - 2048  # the last: mask, kind of its values, values
        end = whole.rindex(struct.pack("<q", len(whole)))
        for at, new in (
            (leaf, b"\xff" * 8),
            (leaf + 64, b"\x09"),
            (end, struct.pack("<q", len(whole) - 8)),
        ):
            with self.subTest(at=at):
                (self.dir / "bad.vdb").write_bytes(whole[:at] + new + whole[at + len(new) :])
                self.refuse_texgen(3, ["bad.vdb", "other"], "inspect", "bad.vdb")
        rng = random.Random(7)
        for size in (0, 64, 192, *(rng.randrange(len(whole)) for _ in range(20)), len(whole) - 1):
            (self.dir / "cut.vdb").write_bytes(whole[:size])
            with self.subTest(size=size):
                self.refuse_texgen(3, ["cut.vdb"], "inspect", "cut.vdb")

    def test_bytes(self):
        whole = self.own_volume().read_bytes()
        rng = random.Random(6)
        for number in range(60):
            bad = bytearray(whole)
            for _ in range(1 + number % 5):
                bad[rng.randrange(len(bad))] = rng.randrange(256)
            (self.dir / "bad.vdb").write_bytes(bad)
            with self.subTest(number=number):
                self.refused(
                    "bad.vdb",
                    "seam" if number % 2 else "inspect",
                    "bad.vdb",
                    *(("-o", "s.vdb", "-q") if number % 2 else ()),
                )

    def test_resigned_set(self):
        """A set whose hashes are right again is verified all the same."""
        volume = self.own_volume()
        bad = bytearray(volume.read_bytes())
        bad[-200:-192] = struct.pack("<q", -70)
        volume.write_bytes(bad)
        path = self.dir / "own/set.json"
        root = json.loads(path.read_text())
        root["files"]["volume.vdb"]["sha256"] = hashlib.sha256(bad).hexdigest()
        path.write_text(json.dumps(root))
        result = self.texgen("verify", "own")
        self.assertIn(result.code, (0, 3), result.err)

    def test_transforms(self):
        for voxel in (0.0, 1e-9, 1e-5, float("nan"), float("inf"), 1e300):
            write_vdb(self.dir / "t.vdb", Grid("density", posts(16, 4), matrix=transform(voxel)))
            for arguments in (
                ("import", "t.vdb", "-o", "set"),
                ("seam", "t.vdb", "-o", "s.vdb", "--cut", "4"),
            ):
                with self.subTest(voxel=voxel, command=arguments[0]):
                    self.refuse_texgen(3, ["t.vdb", "transform"], *arguments)

    def test_other_files(self):
        for name, content in (
            ("e.vdb", b""),
            ("s.vdb", b" BDV"),
            ("t.vdb", b"words"),
            ("v.vdb", b" BDV\0\0\0\0" + struct.pack("<I", 200) + bytes(90)),
        ):
            (self.dir / name).write_bytes(content)
            self.refuse_texgen(3, [name], "inspect", name)
        with open(self.dir / "sparse.vdb", "wb") as file:
            file.truncate(3 << 30)
        self.refuse_texgen(3, ["sparse.vdb"], "import", "sparse.vdb", "-o", "set")


if __name__ == "__main__":
    sward_cli.main()
