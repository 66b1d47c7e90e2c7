# SPDX-License-Identifier: Apache-2.0
"""Hostile files: whatever a scene, its elevation, its mask, its set or a preset may be, one line
names the file."""

import base64
import json
import os
import shutil
import struct
import zlib

import sward_cli
from sward_cli import CliCase, SCENE, SIZE, TINY_PRESET

GIGABYTE = 1 << 30


def png(width, height, rows=b"", depth=8, colour=0):
    """A PNG whose header may promise more than its data holds."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )


class Files(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def refuse_scene(self, code, pieces, scene="scene.toml", **options):
        self.refuse(code, pieces, "render", scene, "-o", "out.png", "--size", SIZE, **options)

    def make_any(self, path):
        """Every kind of thing that may stand under a file's name: (what, code, prefix of the
        command)."""

        def remove():
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)

        remove()
        yield "missing", {5}, ()
        path.write_bytes(b"")
        yield "empty", {3}, ()
        path.write_text("this is text, and not what it should be\n")
        yield "text", {3}, ()
        with open(path, "wb") as sparse:
            sparse.truncate(5 * GIGABYTE)
        yield "sparse", {3, 4}, ()
        remove()
        os.mkfifo(path)
        yield "FIFO", {3, 5}, ()
        remove()
        path.mkdir()
        yield "directory", {3, 5}, ()
        remove()
        path.symlink_to(path.name)
        yield "loop", {5}, ()
        remove()
        path.write_bytes(b"x" * 100)
        path.chmod(0)
        yield "no permission", {5}, sward_cli.without_root()

    def refuse_any(self, name, scene="scene.toml", absent=None):
        """The file `name` of the scene as everything that it must not be. `absent`: the code where
        it is not there at all."""
        for what, codes, prefix in self.make_any(self.dir / name):
            with self.subTest(name=name, what=what):
                codes = {absent} if absent is not None and what in ("missing", "loop") else codes
                before = sward_cli.snapshot(self.dir)
                result = self.sward("render", scene, "-o", "out.png", "--size", SIZE, prefix=prefix)
                self.assertIn(result.code, codes, result.err)
                self.assert_refusal(result, result.code, *([] if result.code == absent else [name]))
                self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_scene_file(self):
        self.refuse_any("other.toml", scene="other.toml")

    def test_elevation(self):
        (self.dir / "scene.toml").write_text(SCENE.replace("height.raw", "hills.tif"))
        self.refuse_any("hills.tif")
        (self.dir / "scene.toml").write_text(SCENE.replace("height.raw", "N36W085.hgt"))
        self.refuse_any("N36W085.hgt")

    def test_raw(self):
        self.refuse_any(
            "height.json", absent=3
        )  # posts without a header may be 16-bit ones, whose size the scene has to say
        sward_cli.write_height(self.dir / "height.raw")
        posts = (self.dir / "height.raw").read_bytes()
        for keep in (0, 1, len(posts) // 2, len(posts) - 1):
            (self.dir / "height.raw").write_bytes(posts[:keep])
            self.refuse_scene(3, ["height.raw", f"{keep} bytes" if keep else "empty"])
        for value in ("1e30", "inf", "-inf"):
            (self.dir / "height.raw").write_bytes(
                posts[:40] + struct.pack("<f", float(value)) + posts[44:]
            )
            self.refuse_scene(3, ["height.raw", "column 10", "row 0"])

    def test_names(self):
        for name in ("two words", "gr\u00fcn \u8349", "line\nbreak", "tab\t", "\u202edrows"):
            folder = self.dir / name
            folder.mkdir()
            with self.subTest(name=name):
                self.refuse_scene(5, ["scene.toml"], scene=f"{name}/scene.toml")
                shutil.copy(self.dir / "scene.toml", folder)
                shutil.copytree(self.dir / "set", folder / "set")
                self.refuse_scene(5, ["height"], scene=name)
                sward_cli.write_height(folder / "height.raw")
                self.assert_done(
                    self.sward("render", name, "-o", f"{name}/out.png", "--size", SIZE)
                )
            shutil.rmtree(folder)

    def test_scene_keys(self):
        """Each fault is told with the file, the line and the key."""
        faults = [
            ("[terain]\n", ["terain", "terrain"]),
            ("[terrain]\nelevaton = 'h'\n", [":2", "elevaton", "elevation"]),
            ("[terrain]\nelevation = 5\n", [":2", "elevation"]),
            (SCENE + "[sun]\nazimuth_deg = nan\n", ["azimuth_deg", "nan"]),
            (SCENE + "[sun]\nelevation_deg = 'high'\n", ["elevation_deg"]),
            (SCENE + "[wind]\nspeed_mps = -1\n", ["speed_mps"]),
            (SCENE + "[wind]\nspeed_mps = 1e400\n", ["scene.toml"]),
            (SCENE + "[wind]\nspeed_mps = 1\nspeed_mps = 2\n", ["scene.toml:"]),
            (SCENE + "[wind\n", ["scene.toml:"]),
            (SCENE + "a = [" * 5000, ["scene.toml"]),
            (SCENE + "[grass2]\n", ["grass2", "grass"]),
            (SCENE.replace('set = "set"', "set = 'set'\ndensity = 2"), ["density"]),
            (SCENE.replace('set = "set"', "set = ''"), ["set"]),
            (SCENE.replace("position = [0, 1.7, 0]", "position = [0, 1.7]"), ["position"]),
            (SCENE + "[path.empty]\nkeys = []\n", ["keys"]),
            (
                SCENE
                + "[[wind.arrow]]\nid='a'\nparent='b'\nroot=[0,0]\ntip=[1,0]\nstrength_mps=1\nradius_m=1\n"
                "[[wind.arrow]]\nid='b'\nparent='a'\nroot=[0,0]\ntip=[1,0]\nstrength_mps=1\nradius_m=1\n",
                ["parent"],
            ),
            ("\xff\xfe\n", ["scene.toml"]),
        ]
        for text, pieces in faults:
            with self.subTest(text=text[-60:]):
                (self.dir / "scene.toml").write_bytes(text.encode("latin-1"))
                self.refuse_scene(3, ["scene.toml", *pieces])

    def test_grass_set(self):
        (self.dir / "scene.toml").write_text(SCENE.replace('"set"', '"nothing"'))
        self.refuse_scene(5, ["grass.set", "nothing"])
        (self.dir / "scene.toml").write_text(SCENE)
        good = sward_cli.tiny_set()
        for path in sorted(good.iterdir()):
            if path.name == "far.exr":
                continue  # for tools: the renderer reads far.ktx2
            content = path.read_bytes()
            damages = {
                "removed": None,
                "empty": b"",
                "cut": content[: len(content) // 2],
                "short": content[:-1],
                "longer": content + b"\0",
                "flipped": content[: len(content) // 2]
                + bytes([content[len(content) // 2] ^ 1])
                + content[len(content) // 2 + 1 :],
            }
            for what, damaged in damages.items():
                target = self.dir / "set" / path.name
                if path.name == "set.json" and what in ("short", "longer", "flipped"):
                    continue  # a blank, or a letter of a name: no fault in JSON
                with self.subTest(file=path.name, what=what):
                    target.unlink(missing_ok=True)
                    if damaged is not None:
                        target.write_bytes(damaged)
                    before = sward_cli.snapshot(self.dir)
                    result = self.render()
                    self.assertIn(result.code, (3, 5), result.err)
                    self.assert_refusal(result, result.code, path.name)
                    self.assertEqual(sward_cli.snapshot(self.dir), before)
            shutil.copy(path, self.dir / "set" / path.name)

    def test_images(self):
        """Pictures as elevation and mask: promises that the data does not keep, sizes past every
        limit."""
        text = SCENE.replace('"height.raw"', '"hills.png"\nsize_m = [100, 100]\nheight_m = [0, 50]')
        (self.dir / "scene.toml").write_text(text)
        good = png(4, 4, b"\0\0\1\0\2\0\3\0\4" * 4, depth=16)
        cases = {
            "zero": (png(0, 0), {3, 4}),
            "wide": (png(1000001, 1, b"\0"), {3, 4}),
            "huge": (png(30000, 30000, bytes(900000)), {3, 4}),
            "one": (png(1, 1, b"\0\0\0", 16), {3}),
            "truncated": (good[:50], {3}),
            "no data": (png(64, 64), {3}),
            "header alone": (good[:33], {3}),
        }
        for what, (content, codes) in cases.items():
            with self.subTest(what=what):
                (self.dir / "hills.png").write_bytes(content)
                result = self.render()
                self.assertIn(result.code, codes, result.err)
                self.assert_refusal(result, result.code, "hills.png")
                self.assertFalse((self.dir / "out.png").exists())
        (self.dir / "hills.png").write_bytes(good)
        self.assert_done(self.render())
        (self.dir / "scene.toml").write_text(SCENE.replace("[grass]", 'mask = "mask.png"\n[grass]'))
        self.refuse_any("mask.png")

    def test_preset(self):
        for what, codes, prefix in self.make_any(self.dir / "grass.toml"):
            if what == "empty":
                continue  # every key of a preset has a default
            with self.subTest(what=what):
                before = sward_cli.snapshot(self.dir)
                result = sward_cli.run(
                    "texgen", "grass.toml", "-o", "made", cwd=self.dir, prefix=prefix
                )
                self.assertIn(result.code, codes, result.err)
                self.assert_refusal(result, result.code, "grass.toml")
                self.assertEqual(sward_cli.snapshot(self.dir), before)
        (self.dir / "grass.toml").chmod(0o644)
        faults = [
            ("seed = 3", "sed = 3", "sed"),
            ("side_m = 1.0", "side_m = nan", "side_m"),
            ("side_m = 1.0", "side_m = -1.0", "side_m"),
            ("size = 64", "size = 100000", "size"),
            ("density_per_m2 = 300.0", "density_per_m2 = 1e30", "density_per_m2"),
            ("length_m = [0.15, 0.3]", "length_m = [0.3, 0.15]", "length_m"),
            ("length_m = [0.15, 0.3]", "length_m = 1", "length_m"),
        ]
        for old, new, key in faults:
            with self.subTest(new=new):
                (self.dir / "grass.toml").write_text(TINY_PRESET.replace(old, new))
                before = sward_cli.snapshot(self.dir)
                result = sward_cli.run("texgen", "grass.toml", "-o", "made", cwd=self.dir)
                self.assertIn(result.code, (3, 4), result.err)
                self.assert_refusal(result, result.code, "grass.toml", key)
                self.assertEqual(sward_cli.snapshot(self.dir), before)


class Messages(CliCase):
    """Each names the file, what was found and what was expected, where a library would have said
    something else."""

    def gltf(self, buffer, version="2.0"):
        """A triangle in a buffer, as the surface of a scene; the scene's name."""
        view = {"buffer": 0, "byteLength": 36}
        accessor = {
            "bufferView": 0,
            "componentType": 5126,
            "count": 3,
            "type": "VEC3",
            "min": [0, 0, 0],
            "max": [1, 0, 1],
        }
        root = {
            "asset": {"version": version},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [accessor],
            "bufferViews": [view],
            "buffers": [{"byteLength": 36, **buffer}],
        }
        (self.dir / "m.gltf").write_text(json.dumps(root))
        (self.dir / "scene.toml").write_text('[terrain]\nsurface = "m.gltf"\n')
        return "scene.toml"

    def test_gltf(self):
        points = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 0, 1)).decode()
        whole = {"uri": "data:application/octet-stream;base64," + points}
        self.assert_done(self.sward("info", self.gltf(whole)))
        self.refuse(
            3,
            ["m.gltf", 'asset.version: found "1.0", expected "2.0"'],
            "info",
            self.gltf(whole, "1.0"),
        )
        self.refuse(
            3,
            ["m.gltf", 'buffer\'s URI: found "", expected the name of a file'],
            "info",
            self.gltf({"uri": ""}),
        )
        self.refuse(3, ["m.gltf", "buffer's URI: found none"], "info", self.gltf({}))
        for uri in (
            "data:;base64",
            "data:;base64," + points,
            "data:text/html;base64," + points,
            "data:",
        ):
            self.refuse(
                3,
                [
                    "m.gltf",
                    "buffer's URI: found data:",
                    "expected data:application/octet-stream;base64",
                ],
                "info",
                self.gltf({"uri": uri}),
            )
        self.refuse(
            5,
            ["m.gltf: buffer ", "gone.bin", "No such file"],
            "info",
            self.gltf({"uri": "gone.bin"}),
        )

    def test_empty_keys(self):
        self.scene()
        for text, name in (
            (SCENE.replace("[grass]", '"" = 1\n[grass]'), 'terrain.""'),
            ('"" = 1\n' + SCENE, '""'),
        ):
            (self.dir / "scene.toml").write_text(text)
            self.refuse(
                3, ["scene.toml:", f"unknown key: found {name}, expected"], "info", "scene.toml"
            )
        for text, name in (('"" = 1\n', '""'), ('[blade]\n"" = 1\n', 'blade.""')):
            (self.dir / "p.toml").write_text(text)
            self.refuse(
                3,
                ["p.toml:", f"unknown key: found {name}, expected"],
                "p.toml",
                "--dry-run",
                program="texgen",
            )


if __name__ == "__main__":
    sward_cli.main()
