# SPDX-License-Identifier: Apache-2.0
"""texgen as a tool: options, reports, inspect and verify, the same bytes at any number of
threads."""

import hashlib
import json
import re
import shutil
import struct

import sward_cli
from sward_cli import CliCase

FAST = ("--no-preview", "--no-volume")
PNG = b"\x89PNG\r\n\x1a\n"


class TexgenCase(CliCase):
    def setUp(self):
        super().setUp()
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)

    def texgen(self, *arguments, **options):
        return sward_cli.run("texgen", *arguments, cwd=self.dir, **options)

    def bake(self, name, *arguments):
        result = self.texgen("tiny.toml", "-o", name, "-q", *arguments)
        self.assert_done(result)
        self.assertEqual(result.err, "")
        return {path.name: path.read_bytes() for path in (self.dir / name).iterdir()}

    def refuse_texgen(self, code, pieces, *arguments):
        self.refuse(code, pieces, *arguments, program="texgen")


class Options(TexgenCase):
    def test_numbers(self):
        """A value out of range is refused with the option, what was found and the range, before any
        work."""
        ranges = {
            "--size": ("32", "2048"),
            "--layers": ("2", "256"),
            "--slices": ("2", "256"),
            "--variants": ("1", "16"),
            "--levels": ("1", "4"),
            "--seed": ("0", "9007199254740991"),
            "--threads": ("0", "1024"),
        }
        values = {
            "--size": ("0", "16385", "-1"),
            "--layers": ("0", "2049"),
            "--slices": ("0", "2049"),
            "--variants": ("0", "17"),
            "--levels": ("0", "5"),
            "--seed": ("-1", "9223372036854775807"),
            "--threads": ("-1", "1025"),
        }
        for option, (low, high) in ranges.items():
            for value in values[option]:
                with self.subTest(option=option, value=value):
                    self.refuse_texgen(
                        2, [option, value, low, high], "tiny.toml", "-o", "set", f"{option}={value}"
                    )
            for value in ("", "64px", "nan", "1e3", "0x40", "99999999999999999999", "1,5"):
                with self.subTest(option=option, value=value):
                    self.refuse_texgen(
                        2, [option, "expected"], "tiny.toml", "-o", "set", f"{option}={value}"
                    )
        self.refuse_texgen(
            2, ["--size 100", "power of two"], "tiny.toml", "-o", "set", "--size", "100"
        )

    def test_choices(self):
        for value in ("", "zip", "zstd:", "zstd:0", "zstd:20", "zstd:x", "bc:3", "BC"):
            with self.subTest(value=value):
                self.refuse_texgen(
                    2,
                    ["--compression", "zstd:19"],
                    "tiny.toml",
                    "-o",
                    "set",
                    "--compression",
                    value,
                )
        self.refuse_texgen(
            2, ["--export", "jpg", "png or exr"], "tiny.toml", "-o", "set", "--export", "jpg"
        )

    def test_usage(self):
        self.refuse_texgen(2, ["PRESET"])
        self.refuse_texgen(2, ["--output"], "tiny.toml")
        self.refuse_texgen(2, ["--output"], "tiny.toml", "-o", "")
        self.refuse_texgen(2, ["--bogus"], "tiny.toml", "-o", "set", "--bogus")
        self.refuse_texgen(2, ["--quiet", "--verbose"], "tiny.toml", "-o", "set", "-q", "-v")
        self.refuse_texgen(
            2, ["preview"], "tiny.toml", "-o", "set", "--no-preview", "--preview", "p.png"
        )
        self.refuse_texgen(2, ["--seed"], "tiny.toml", "-o", "set", "--seed", "1", "--seed", "2")
        self.refuse_texgen(2, ["SET"], "inspect")
        self.refuse_texgen(2, ["SET"], "verify")
        self.refuse_texgen(2, ["extra"], "verify", "set", "extra")
        self.refuse_texgen(2, ["before"], "-q", "verify", "set")
        self.refuse_texgen(5, ["no-such", "meadow"], "no-such", "-o", "set")

    def test_a_wrong_option_is_blamed(self):
        """The option that there is not, and not the value after it or what is missing because of
        it."""
        for words in (
            ["tiny.toml", "-n", "8", "-o", "set"],
            ["-n", "8", "tiny.toml", "-o", "set"],
            ["tiny.toml", "-n", "8"],
            ["seam", "a.png", "-n", "8", "-o", "b.png"],
            ["seam", "a.png", "-n", "8"],
            ["import", "-n", "8", "a.vdb", "-o", "set"],
            ["export", "set", "-n", "8"],
            ["inspect", "set", "-n", "8"],
            ["verify", "-n", "8", "set"],
            ["import", "-n", "-up", "q"],
        ):
            with self.subTest(words=words):
                self.refuse_texgen(2, ["error: -n: found an unknown option", "--help"], *words)
        self.refuse_texgen(
            2,
            ["error: --sise: found an unknown option", "perhaps --size"],
            "tiny.toml",
            "--sise",
            "64",
            "-o",
            "set",
        )
        self.refuse_texgen(
            2,
            ["error: --sizes=64: found", "perhaps --size"],
            "import",
            "a.vdb",
            "-o",
            "set",
            "--sizes=64",
        )
        self.refuse_texgen(
            2, ['error: --output: found "--size"'], "tiny.toml", "-o", "--size", "64"
        )
        self.refuse_texgen(
            2,
            ['error: --size: found "--levels"'],
            "tiny.toml",
            "-o",
            "set",
            "--size",
            "--levels",
            "2",
        )
        self.refuse_texgen(2, ["--output", "2 times"], "tiny.toml", "-o", "set", "-o", "other")

    def test_preset_values(self):
        """Nonsense in the preset is refused with file, line, key, value and range."""
        cases = [
            ("density_per_m2 = 300.0", "density_per_m2 = -1.0", 3, ["density_per_m2", "-1"]),
            ("density_per_m2 = 300.0", "density_per_m2 = nan", 3, ["density_per_m2", "nan"]),
            ("density_per_m2 = 300.0", "density_per_m2 = inf", 3, ["density_per_m2", "inf"]),
            (
                "density_per_m2 = 300.0",
                "density_per_m2 = 1e9",
                3,
                ["density_per_m2", "expected", "to 1000000 "],
            ),
            (
                "side_m = 1.0\ndensity_per_m2 = 300.0",
                "side_m = 64.0\ndensity_per_m2 = 1000000.0",
                4,
                ["density_per_m2", "4096000000", "200000"],
            ),
            ("size = 64", "size = 0", 3, ["texture.size", "2048"]),
            ("size = 64", "size = 16385", 3, ["texture.size", "16385", "2048"]),
            ("layers = 4", "layers = 0", 3, ["texture.layers", "256"]),
            ("layers = 4", "layers = 2049", 3, ["texture.layers", "2049", "256"]),
        ]
        for old, new, code, pieces in cases:
            with self.subTest(new=new):
                self.assertIn(old, sward_cli.TINY_PRESET)
                (self.dir / "bad.toml").write_text(sward_cli.TINY_PRESET.replace(old, new))
                self.refuse_texgen(code, ["bad.toml", *pieces], "bad.toml", "-o", "set")
                self.refuse_texgen(
                    code, ["bad.toml", *pieces], "bad.toml", "-o", "set", "--dry-run"
                )

    def test_help_names_every_option_of_the_manual(self):
        text = self.texgen("--help").out
        shown = set(re.findall(r"--[a-z-]+", text))
        manual = (sward_cli.SOURCE / "docs/texgen.md").read_text()
        for option in shown:
            self.assertIn(option, manual)


class Bytes(TexgenCase):
    def test_threads(self):
        sets = [
            self.bake(f"set{i}", "--threads", threads, "--checknan")
            for i, threads in enumerate(("1", "2", "8", "2"))
        ]
        self.assertGreater(len(sets[0]), 7)
        for other in sets[1:]:
            self.assertEqual(sorted(sets[0]), sorted(other))
            for name, content in sets[0].items():
                self.assertTrue(content == other[name], name)
        changed = self.bake("seed", "--seed", "4", *FAST)
        self.assertFalse(sets[0]["layers.ktx2"] == changed["layers.ktx2"])

    def test_block_compression_at_any_thread_count(self):
        one = self.bake("one", "--compression", "bc", "--threads", "1", *FAST)
        two = self.bake("two", "--compression", "bc", "--threads", "2", *FAST)
        self.assertTrue(one == two)
        self.assertIn("layers_shape.ktx2", one)

    def test_compressions_hold_the_same(self):
        """Packing changes the files, not what is in them; bc keeps the ids' bytes."""
        reports = {}
        for name in ("none", "zstd", "zstd:12", "bc"):
            self.bake(name, "--compression", name, *FAST)
            self.assert_done(self.texgen("verify", name, "-q"))
            reports[name] = json.loads(self.texgen("inspect", name, "--json").out)
        sizes = {name: report["files"]["layers.ktx2"] for name, report in reports.items()}
        self.assertEqual(sizes["none"]["unpacked_bytes"], sizes["zstd"]["unpacked_bytes"])
        self.assertEqual(sizes["bc"]["unpacked_bytes"] * 2, sizes["zstd"]["unpacked_bytes"])
        self.assertGreater(sizes["none"]["bytes"], sizes["none"]["unpacked_bytes"])
        self.assertLess(sizes["zstd"]["bytes"], sizes["none"]["bytes"])
        self.assertLess(sizes["zstd:12"]["bytes"], sizes["zstd"]["bytes"])
        self.assertEqual(reports["none"]["gpu_bytes"], reports["zstd"]["gpu_bytes"])
        planes = {
            name: sum(level["gpu_bytes"] for level in report["levels"])
            for name, report in reports.items()
        }
        share = planes["bc"] / planes["zstd"]
        self.assertAlmostEqual(
            share, 0.75, delta=0.02
        )  # mips under 4 x 4 texels take a whole block


class Reports(TexgenCase):
    def test_bake_as_json(self):
        result = self.texgen("tiny.toml", "-o", "set", "-q", "--json", *FAST)
        self.assert_done(result)
        report = json.loads(result.out)
        self.assertEqual(report["preset"], "tiny")
        self.assertEqual(report["blades"], 300)
        files = {path.name: path.stat().st_size for path in (self.dir / "set").iterdir()}
        del files["set.json"]
        self.assertEqual({name: file["bytes"] for name, file in report["files"].items()}, files)
        inspected = json.loads(self.texgen("inspect", "set", "--json").out)
        for key in (
            "blades",
            "levels",
            "files",
            "gpu_bytes",
            "images",
            "canopy_m",
            "species",
            "seed",
        ):
            self.assertEqual(report[key], inspected[key], key)

    def test_dry_run(self):
        """It writes nothing, and what it foretells is what a bake then makes."""
        before = sward_cli.snapshot(self.dir)
        for extra in ((), ("--compression", "bc")):
            with self.subTest(extra=extra):
                result = self.texgen("tiny.toml", "-o", "set", "--dry-run", "--json", *FAST, *extra)
                self.assert_done(result)
                self.assertEqual(sward_cli.snapshot(self.dir), before)
                told = json.loads(result.out)
                made = json.loads(
                    self.texgen("tiny.toml", "-o", "set", "-q", "--json", *FAST, *extra).out
                )
                shutil.rmtree(self.dir / "set")
                for key in ("blades", "images", "gpu_bytes", "variants"):
                    self.assertEqual(told[key], made[key], key)
                self.assertAlmostEqual(told["canopy_m"], made["canopy_m"], delta=1e-6)
                self.assertEqual(told["levels"], [dict(level) for level in made["levels"]])
                for name, file in told["files"].items():
                    # How many digits the ranks' bounds have in the GLB's header is not known before
                    # blades have ranks.
                    self.assertAlmostEqual(
                        file["unpacked_bytes"],
                        made["files"][name].get("unpacked_bytes", made["files"][name]["bytes"]),
                        delta=128 if name == "blades.glb" else 0,
                        msg=name,
                    )
                self.assertGreater(told["peak_bytes"], 1 << 20)
        text = self.texgen("tiny.toml", "-o", "set", "--dry-run")
        self.assert_done(text)
        for piece in ("300 blades", "level 1", "layers.ktx2", "volume.vdb", "GPU", "memory"):
            self.assertIn(piece, text.out)
        before = sward_cli.snapshot(self.dir)
        for arguments in (("-o", "nowhere/set"), ()):
            self.assert_done(self.texgen("tiny.toml", *arguments, "--dry-run"))
        self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_dry_run_of_many_blades(self):
        many = sward_cli.TINY_PRESET.replace(
            "density_per_m2 = 300.0", "density_per_m2 = 50000.0"
        ).replace("side_m = 1.0", "side_m = 2.0")
        (self.dir / "many.toml").write_text(many)
        result = self.texgen("many.toml", "--dry-run", "--json")
        self.assert_done(result)
        self.assertEqual(json.loads(result.out)["blades"], 200000)
        self.assertLess(result.cpu_s, 2)

    def test_list(self):
        result = self.texgen("--list")
        self.assert_done(result)
        lines = result.out.splitlines()
        self.assertEqual(
            len(lines), len(list((sward_cli.SOURCE / "texgen/presets").glob("*.toml")))
        )
        self.assertTrue(
            any(line.startswith("meadow ") and len(line) > 30 for line in lines), result.out
        )

    def test_size_lowers_levels(self):
        text = self.texgen("meadow", "--dry-run", "--size", "64")
        self.assert_done(text)
        self.assertIn("--size 64: 3 levels instead of 4", text.err)
        self.refuse_texgen(
            2, ["--size 64, --levels 4"], "meadow", "--dry-run", "--size", "64", "--levels", "4"
        )

    def test_empty_preset(self):
        (self.dir / "empty.toml").write_text("# nothing yet\n")
        result = self.texgen("empty.toml", "--dry-run")
        self.assert_done(result)
        self.assertIn("nothing is set", result.err)

    def test_parents(self):
        self.assert_done(self.texgen("tiny.toml", "-o", "a/b/set", "-q", *FAST))
        self.assertTrue((self.dir / "a/b/set/set.json").exists())
        (self.dir / "bad.vdb").write_bytes(b"no volume")
        self.refuse_texgen(3, ["bad.vdb"], "import", "bad.vdb", "-o", "c/d/set")

    def test_replacing_keeps_what_it_did_not_write(self):
        self.bake("set", *FAST)
        path = self.dir / "set/set.json"
        root = json.loads(path.read_text())
        root["files"]["notes.txt"] = {"bytes": 4, "sha256": "0" * 64}
        path.write_text(json.dumps(root))
        (self.dir / "set/notes.txt").write_text("mine")
        self.refuse_texgen(5, ["notes.txt"], "tiny.toml", "-o", "set", "-q", *FAST)

    def test_preview_elsewhere(self):
        made = self.bake("set", "--no-volume", "--preview", "sheet.png")
        self.assertNotIn("preview.png", made)
        self.assertTrue((self.dir / "sheet.png").read_bytes().startswith(PNG))
        self.refuse_texgen(
            5, ["--preview", "inside"], "tiny.toml", "-o", "set", "--preview", "set/p.png"
        )

    def test_inspect(self):
        self.bake("set", "--no-preview")
        text = self.texgen("inspect", "set").out
        for piece in (
            '"tiny"',
            "300 blades",
            "level 0   64 x 64",
            "layers_1.ktx2",
            "volume.vdb",
            "GPU",
        ):
            self.assertIn(piece, text)
        array = json.loads(self.texgen("inspect", "set/slices.ktx2", "--json").out)
        self.assertEqual(
            (array["format"], array["width"], array["images"], array["mips"]), ("RGBA8", 64, 16, 7)
        )
        self.assertIn("64 x 64 texels", self.texgen("inspect", "set/layers.ktx2").out)
        volume = json.loads(self.texgen("inspect", "set/volume.vdb", "--json").out)
        self.assertIn("density", str(volume["grids"]))
        self.assertGreater(volume["active_voxels"], 1000)
        self.assertIn("density", self.texgen("inspect", "set/volume.vdb").out)
        self.refuse_texgen(5, ["none"], "inspect", "none")
        self.refuse_texgen(5, ["none.vdb"], "inspect", "none.vdb")
        self.refuse_texgen(3, ["tiny.toml"], "inspect", "tiny.toml")
        (self.dir / "text.ktx2").write_text("no texture")
        self.refuse_texgen(3, ["text.ktx2"], "inspect", "text.ktx2")
        (self.dir / "text.vdb").write_text("no volume")
        self.refuse_texgen(3, ["text.vdb"], "inspect", "text.vdb")


class Verify(TexgenCase):
    def setUp(self):
        super().setUp()
        self.bake("set", "--compression", "bc")

    def test_good(self):
        result = self.texgen("verify", "set", "--json")
        self.assert_done(result)
        report = json.loads(result.out)
        self.assertTrue(report["ok"])
        self.assertEqual(report["files"], len(list((self.dir / "set").iterdir())) - 1)

    def test_every_file_flipped_cut_or_gone(self):
        for path in sorted((self.dir / "set").iterdir()):
            if path.name == "set.json":
                continue
            whole = path.read_bytes()
            flipped = bytearray(whole)
            flipped[len(flipped) // 2] ^= 1
            for content in (bytes(flipped), whole[:-1], whole[:100], b"", None):
                with self.subTest(name=path.name, size=-1 if content is None else len(content)):
                    path.unlink()
                    if content is not None:
                        path.write_bytes(content)
                    self.refuse_texgen(3, [path.name, "set.json"], "verify", "set")
                    path.write_bytes(whole)
        self.assert_done(self.texgen("verify", "set", "-q"))

    def test_volume_is_refused_by_its_hash_before_it_is_parsed(self):
        path = self.dir / "set/volume.vdb"
        whole = path.read_bytes()
        for at in (0, 30, 200, len(whole) // 2):
            bad = bytearray(whole)
            bad[at] ^= 0x40
            path.write_bytes(bad)
            self.refuse_texgen(3, ["volume.vdb", "SHA-256"], "inspect", "set/volume.vdb")
        path.write_bytes(whole[: len(whole) // 2])
        self.refuse_texgen(3, ["volume.vdb", "size"], "inspect", "set/volume.vdb")

    def test_descriptions(self):
        path = self.dir / "set/set.json"
        whole = path.read_text()
        root = json.loads(whole)
        name = "layers.ktx2"
        away = json.loads(whole)
        away["files"]["../tiny.toml"] = away["files"][name]
        other = json.loads(whole)
        del other["files"][name]
        shares = json.loads(whole)
        shares["far"][0]["coverage"] = 1.5
        for text in (
            "",
            "{}",
            "[" * 5000,
            whole[: len(whole) // 2],
            json.dumps(dict(root, version=1)),
            json.dumps(dict(root, files=[])),
            json.dumps(away),
            json.dumps(other),
            json.dumps(shares),
        ):
            with self.subTest(text=text[:40]):
                path.write_text(text)
                self.refuse_texgen(3, ["set.json"], "verify", "set")
        path.unlink()
        self.refuse_texgen(3, ["set.json"], "verify", "set")
        self.refuse_texgen(5, ["no-such"], "verify", "no-such")

    def test_blades_with_vectors(self):
        """blades.glb as sets held it once, with vectors in one attribute, holds the same blades."""
        path = self.dir / "set"
        self.bake("set", *FAST)
        glb = (path / "blades.glb").read_bytes()
        self.assertEqual(glb.count(b'"_V1_X"'), 1)
        (size,) = struct.unpack_from("<I", glb, 12)
        root, data = json.loads(glb[20 : 20 + size]), bytearray(glb[28 + size :])
        attributes = root["meshes"][0]["primitives"][0]["attributes"]
        for name in ("_V1", "_V2"):
            parts = []
            for axis in "XYZ":
                view = root["bufferViews"][
                    root["accessors"][attributes.pop(f"{name}_{axis}")]["bufferView"]
                ]
                at = view.get("byteOffset", 0)
                parts.append(
                    struct.unpack(
                        f"<{view['byteLength'] // 4}f", data[at : at + view["byteLength"]]
                    )
                )
            values = [v for point in zip(*parts, strict=True) for v in point]
            root["bufferViews"].append(
                {"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(values)}
            )
            root["accessors"].append(
                {
                    "bufferView": len(root["bufferViews"]) - 1,
                    "componentType": 5126,
                    "count": len(values) // 3,
                    "type": "VEC3",
                }
            )
            attributes[name] = len(root["accessors"]) - 1
            data += struct.pack(f"<{len(values)}f", *values)
        root["buffers"][0]["byteLength"] = len(data)
        self.assert_done(self.texgen("export", "set", "-o", "new", "--for", "gltf", "-q"))
        self.replace(path, root, data)
        self.assert_done(self.texgen("verify", "set", "-q"))
        self.assert_done(self.texgen("export", "set", "-o", "old", "--for", "gltf", "-q"))
        meshes = [(self.dir / name / "blades_mesh.glb").read_bytes() for name in ("new", "old")]
        self.assertTrue(meshes[0] == meshes[1])
        del attributes["_V2"]
        self.replace(path, root, data)
        self.refuse_texgen(3, ["blades.glb", "_V2"], "verify", "set")

    @staticmethod
    def replace(path, root, data):
        """Another blades.glb of this JSON and data, listed as if it were the set's own."""
        text = json.dumps(root).encode()
        text += b" " * (-len(text) % 4)
        glb = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data))
        glb += (
            struct.pack("<I4s", len(text), b"JSON")
            + text
            + struct.pack("<I4s", len(data), b"BIN\0")
            + data
        )
        (path / "blades.glb").write_bytes(glb)
        facts = json.loads((path / "set.json").read_text())
        facts["files"]["blades.glb"] = {
            "bytes": len(glb),
            "sha256": hashlib.sha256(glb).hexdigest(),
        }
        (path / "set.json").write_text(json.dumps(facts))

    def test_foreign_file_is_told(self):
        (self.dir / "set/notes.txt").write_text("mine")
        result = self.texgen("verify", "set")
        self.assert_done(result)
        self.assertIn("warning", result.err)
        self.assertIn("notes.txt", result.err)

    def test_failure_as_json(self):
        path = self.dir / "set/blades.glb"
        path.write_bytes(path.read_bytes()[:-4])
        result = self.texgen("verify", "set", "--json")
        self.assertEqual(result.code, 3)
        report = json.loads(result.out)
        self.assertFalse(report["ok"])
        self.assertIn("blades.glb", report["error"])


if __name__ == "__main__":
    sward_cli.main()
