# SPDX-License-Identifier: Apache-2.0
"""texgen export: what other engines read is well formed, looks like the set it comes from, and
appears whole or not at all."""

import json
import math
import os
import shutil
import signal
import struct

import numpy
from PIL import Image

import sward_cli
from sward_cli import CliCase

PRESET = (
    sward_cli.TINY_PRESET.replace("variants = 1", "variants = 2").replace(
        "side_m = 1.0", "side_m = 1.5"
    )
    + """
[[species]]
name = "thin"
share = 3
[[species]]
name = "daisy"
element = "flower"
[species.blade]
curvature_deg = [60.0, 80.0]
"""
)
FAST = ("--no-preview", "-q")
TARGETS = ("gltf", "textures", "blender")
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
TYPES = {5123: numpy.dtype("<u2"), 5125: numpy.dtype("<u4"), 5126: numpy.dtype("<f4")}
SRGB, UNORM = 43, 37  # VK_FORMAT_R8G8B8A8_SRGB, _UNORM


def linear(byte):
    v = numpy.asarray(byte, dtype=numpy.float64) / 255
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


class Glb:
    """A binary glTF: its JSON, and accessors as arrays, each checked against its view and the
    buffer."""

    def __init__(self, data):
        magic, version, total, size, kind = struct.unpack_from("<4sIIII", data)
        assert (magic, version, total, kind) == (b"glTF", 2, len(data), 0x4E4F534A), "header"
        self.json = json.loads(data[20 : 20 + size])
        length, chunk = struct.unpack_from("<I4s", data, 20 + size)
        assert chunk == b"BIN\0" and 28 + size + length == len(data) and length % 4 == 0, "chunk"
        self.buffer = data[28 + size :]
        assert self.json["buffers"] == [{"byteLength": self.json["buffers"][0]["byteLength"]}]
        assert 0 <= length - self.json["buffers"][0]["byteLength"] < 4

    def array(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind, n = TYPES[accessor["componentType"]], COMPONENTS[accessor["type"]]
        start = view.get("byteOffset", 0)
        assert (
            start % 4 == 0 and view["byteLength"] == accessor["count"] * n * kind.itemsize
        ), "view"
        assert start + view["byteLength"] <= len(self.buffer), "end"
        values = numpy.frombuffer(self.buffer, kind, accessor["count"] * n, start).reshape(-1, n)
        if accessor.get("normalized"):
            values = values / 65535
        if "min" in accessor:
            assert numpy.array_equal(values.min(0), numpy.float32(accessor["min"])), "min"
            assert numpy.array_equal(values.max(0), numpy.float32(accessor["max"])), "max"
        return values


def ktx2(data):
    """(format, width, height, layers, mips) of an unpacked KTX2; a mip is layers x height x width x
    4 bytes."""
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    fmt, _, width, height, _, layers, faces, levels, scheme, dfd, *_ = struct.unpack_from(
        "<13I", data, 12
    )
    assert faces == 1 and scheme == 0
    mips = []
    for m in range(levels):
        offset, length, unpacked = struct.unpack_from("<3Q", data, 80 + 24 * m)
        assert length == unpacked and offset + length <= len(data)
        size = (max(1, layers), max(1, height >> m), max(1, width >> m), 4)
        mips.append(numpy.frombuffer(data, numpy.uint8, math.prod(size), offset).reshape(size))
    transfer = data[dfd + 14]
    return fmt, layers, mips, transfer


class ExportCase(CliCase):
    def setUp(self):
        super().setUp()
        baked = sward_cli.WORK / "export-set"
        made, preset = baked / "set.json", sward_cli.WORK / "export.toml"
        sward_cli.WORK.mkdir(parents=True, exist_ok=True)
        if (
            not made.exists()
            or made.stat().st_mtime < (sward_cli.BIN / "texgen").stat().st_mtime
            or preset.read_text() != PRESET
        ):
            preset.write_text(PRESET)
            self.assert_done(sward_cli.run("texgen", preset, "-o", baked, *FAST))
        shutil.copytree(baked, self.dir / "set")

    def texgen(self, *arguments, **options):
        return sward_cli.run("texgen", *arguments, cwd=self.dir, **options)

    def export(self, target, *arguments, name="out"):
        result = self.texgen("export", "set", "-o", name, "--for", target, "-q", *arguments)
        self.assert_done(result)
        return {path.name: path.read_bytes() for path in (self.dir / name).iterdir()}

    def facts(self):
        return json.loads((self.dir / "set/set.json").read_text())

    def refuse_export(self, code, pieces, *arguments):
        self.refuse(code, pieces, "export", *arguments, program="texgen")


class Meshes(ExportCase):
    def primitives(self, glb):
        for mesh in glb.json["meshes"]:
            self.assertEqual(len(mesh["primitives"]), 1)
            primitive = mesh["primitives"][0]
            arrays = {name: glb.array(index) for name, index in primitive["attributes"].items()}
            self.assertEqual(
                {len(a) for a in arrays.values()}, {len(arrays["POSITION"])}, mesh["name"]
            )
            yield (
                mesh["name"],
                arrays,
                glb.array(primitive["indices"]).astype(numpy.int64).reshape(-1, 3),
                primitive,
            )

    def test_triangles(self):
        """Every triangle has an area, lies inside the patch's reach, and turns the way its normals
        point."""
        facts = self.facts()
        glb = Glb(self.export("gltf")["blades_mesh.glb"])
        names = set()
        for name, a, triangles, primitive in self.primitives(glb):
            names.add(name)
            p, n = a["POSITION"].astype(numpy.float64), a["NORMAL"].astype(numpy.float64)
            self.assertTrue(numpy.isfinite(p).all())
            self.assertLess(p[:, 1].max(), facts["canopy_m"] * 1.02)
            self.assertGreater(p[:, 1].min(), -0.05)
            self.assertGreater(p[:, [0, 2]].min(), -0.5)
            self.assertLess(p[:, [0, 2]].max(), facts["side_m"] + 0.5)
            self.assertLess(numpy.abs(numpy.linalg.norm(n, axis=1) - 1).max(), 1e-4)
            self.assertLess(triangles.max(), len(p))
            self.assertEqual(len(numpy.unique(triangles)), len(p))
            corners = p[triangles]
            turn = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            self.assertGreater(numpy.linalg.norm(turn, axis=1).min(), 0)
            self.assertGreater((turn * n[triangles].mean(1)).sum(1).min(), 0, name)
            self.assertTrue(((a["COLOR_0"] > 0) & (a["COLOR_0"] <= 1)).all())
            for uv in ("TEXCOORD_0", "TEXCOORD_1"):
                self.assertTrue(((a[uv] >= 0) & (a[uv] <= 1)).all())
            self.assertEqual(primitive["material"], {"thin": 0, "daisy": 1}[name.split("_")[1]])
        self.assertEqual(
            names,
            {
                f"variant{v}_{s}_LOD{k}"
                for v in range(2)
                for s in ("thin", "daisy")
                for k in range(3)
            },
        )

    def test_wind(self):
        """Roots stand still and tips go all the way; a vertex knows its blade's root and length."""
        glb = Glb(self.export("gltf")["blades_mesh.glb"])
        for name, a, _, _ in self.primitives(glb):
            weight, root = a["_WIND"][:, 0], a["_ROOT"]
            self.assertEqual((weight.min(), weight.max()), (0, 1))
            self.assertTrue((a["_WIND"][:, 1:] > 0).all() and (a["_WIND"] <= 1).all())
            self.assertTrue(numpy.array_equal(a["TEXCOORD_1"], a["_WIND"][:, :2]), name)
            self.assertTrue((root[:, 1] == 0).all())
            away = numpy.linalg.norm(a["POSITION"] - root, axis=1)
            self.assertTrue((away <= a["_BLADE"][:, 2] + 0.05).all())
            self.assertLess(away[weight == 0].max(), 0.05)

    def test_levels(self):
        """Each level keeps the area of the blades; the default scene has the finest of all
        variants, side by side."""
        glb = Glb(self.export("gltf")["blades_mesh.glb"])
        area, count = {}, {}
        for name, a, triangles, _ in self.primitives(glb):
            corners = a["POSITION"].astype(numpy.float64)[triangles]
            sizes = (
                numpy.linalg.norm(
                    numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                    axis=1,
                )
                / 2
            )
            level = name[-4:]
            area[level] = area.get(level, 0) + sizes.sum()
            count[level] = count.get(level, 0) + len(triangles)
        for level in ("LOD1", "LOD2"):
            self.assertAlmostEqual(area[level] / area["LOD0"], 1, delta=0.05)
        self.assertLess(count["LOD1"] * 3, count["LOD0"])
        self.assertLess(count["LOD2"] * 2, count["LOD1"])
        scenes, nodes = glb.json["scenes"], glb.json["nodes"]
        self.assertEqual((glb.json["scene"], len(scenes)), (0, 3))
        for k, scene in enumerate(scenes):
            self.assertEqual(
                [nodes[i]["name"] for i in scene["nodes"]], [f"variant{v}_LOD{k}" for v in range(2)]
            )
        first, second = (nodes[i] for i in scenes[0]["nodes"])
        self.assertNotIn("translation", first)
        self.assertEqual(second["translation"], [1.5, 0, 0])
        self.assertEqual(
            first["extensions"]["MSFT_lod"]["ids"], [scenes[1]["nodes"][0], scenes[2]["nodes"][0]]
        )
        self.assertNotIn("extensionsRequired", glb.json)

    def test_blender(self):
        """Application attributes of one shape and type a mesh; points and volume are the set's own
        files."""
        files = self.export("blender")
        self.assertEqual(set(files), {"blades_mesh.glb", "blades.glb", "volume.vdb", "export.json"})
        self.assertEqual(files["volume.vdb"], (self.dir / "set/volume.vdb").read_bytes())
        for name in ("blades_mesh.glb", "blades.glb"):
            glb = Glb(files[name])
            self.assertNotIn("extensionsUsed", glb.json)
            self.assertEqual(len(glb.json["scenes"]), 1)
            for mesh in glb.json["meshes"]:
                attributes = mesh["primitives"][0]["attributes"]
                own = [glb.json["accessors"][i] for a, i in attributes.items() if a.startswith("_")]
                self.assertEqual(
                    len({(a["type"], a["componentType"]) for a in own}), 1, mesh["name"]
                )
        self.assertEqual(files["blades.glb"], (self.dir / "set/blades.glb").read_bytes())
        blades, meshes = (
            [m["primitives"][0]["attributes"] for m in Glb(files[n]).json["meshes"]]
            for n in ("blades.glb", "blades_mesh.glb")
        )
        self.assertLessEqual({"_V1_X", "_V2_Z", "_RANK", "_SPECIES"}, set(blades[0]))
        self.assertLessEqual({"_WIND", "_ROOT", "_BLADE"}, set(meshes[0]))

    def test_without_volume(self):
        self.assert_done(
            self.texgen(sward_cli.WORK / "export.toml", "-o", "bare", "--no-volume", *FAST)
        )
        result = self.texgen("export", "bare", "-o", "out", "--for", "blender", "-q")
        self.assert_done(result)
        self.assertIn("warning: bare: no volume.vdb", result.err)


class Textures(ExportCase):
    def setUp(self):
        super().setUp()
        self.files = self.export("textures", "--compression", "none")
        self.stack = json.loads(self.files["stack.json"])

    def test_formats(self):
        """Albedo is flagged sRGB and tangents are not; arrays have all mips, atlases are single
        textures."""
        for found, wanted in zip(
            (self.stack["floor"]["cover"], *self.stack["floor"]["moss"]),
            (0.7, 0.05, 0.078, 0.02),
            strict=True,
        ):
            self.assertAlmostEqual(found, wanted, delta=1e-6)
        for name, images in (("layers", 2 * 4), ("slices", 2 * 2 * 4)):
            for kind, fmt, transfer in (("albedo", SRGB, 2), ("tangent", UNORM, 1)):
                found, layers, mips, flag = ktx2(self.files[f"{kind}_{name}.ktx2"])
                self.assertEqual((found, layers, flag), (fmt, images, transfer))
                self.assertEqual(mips[-1].shape[1:3], (1, 1))
                for v in range(2):
                    found, layers, mips, flag = ktx2(self.files[f"{kind}_{name}_variant{v}.ktx2"])
                    self.assertEqual((found, layers, flag), (fmt, 0, transfer))
                    (self.dir / "atlas.png").write_bytes(
                        self.files[f"{kind}_{name}_variant{v}.png"]
                    )
                    picture = Image.open(self.dir / "atlas.png")
                    self.assertEqual("srgb" in picture.info, kind == "albedo")
                    self.assertTrue(numpy.array_equal(numpy.asarray(picture), mips[0][0]))
        self.assert_done(self.texgen("inspect", "out/albedo_layers_variant0.ktx2"))
        self.assertIn("RGBA8 sRGB", self.texgen("inspect", "out/albedo_layers.ktx2").out)

    def test_colour_is_the_set_s(self):
        """Coverage and mean colour of each image are those of the pictures that a bake exports, at
        every mip within 2 %."""
        self.assert_done(
            self.texgen(
                sward_cli.WORK / "export.toml", "-o", "own", "--export", "png", "--no-volume", *FAST
            )
        )
        _, _, layers, _ = ktx2(self.files["albedo_layers.ktx2"])
        _, _, slices, _ = ktx2(self.files["albedo_slices.ktx2"])
        for image in self.stack["images"]:
            mine = (layers if image["array"] == "layers" else slices)[0][image["index"]]
            its = numpy.asarray(Image.open(self.dir / f"own-png/{image['name']}_albedo.png"))
            self.assertTrue(numpy.array_equal(mine[..., 3], its[..., 3]), image["name"])
            there = its[..., 3] > 0
            self.assertTrue(numpy.array_equal(mine[there], its[there]), image["name"])
            tangent = ktx2(self.files[f"tangent_{image['array']}.ktx2"])[2][0][image["index"]][
                there
            ][:, :3]
            its = numpy.asarray(Image.open(self.dir / f"own-png/{image['name']}_tangent.png"))[
                there
            ]
            self.assertTrue(numpy.array_equal(tangent, its), image["name"])
            length = numpy.linalg.norm(tangent / 127.5 - 1, axis=1)
            self.assertLess(numpy.abs(length - 1).max(), 0.03, image["name"])
            self.assertGreaterEqual(
                tangent[:, 1].min(), 127, image["name"]
            )  # a blade's way is up, or along the ground
        for mips in (layers, slices):

            def means(mip):
                alpha = mip[..., 3:] / 255
                return (
                    alpha.mean(),
                    (linear(mip[..., :3]) * alpha).mean((0, 1, 2)) / alpha.mean(),
                    (mip[..., 3] >= 128).mean(),
                )

            coverage, colour, opaque = means(mips[0])
            for mip in mips[1:]:
                if min(mip.shape[1:3]) < 8:
                    break
                c, rgb, o = means(mip)
                self.assertAlmostEqual(c / coverage, 1, delta=0.02)
                self.assertAlmostEqual(o, opaque, delta=0.04 * opaque + 1e-6)
                self.assertLess(numpy.abs(rgb / colour - 1).max(), 0.03)

    def test_dilation(self):
        """Under alpha 0 is the colour of what stands beside, at every mip: a filter brings in no
        black."""
        for name in ("layers", "slices"):
            _, _, mips, _ = ktx2(self.files[f"albedo_{name}.ktx2"])
            for mip in mips:
                self.assertGreater(mip[..., :3].max(-1).min(), 20)
            colour, alpha = linear(mips[0][..., :3]).sum(-1), mips[0][..., 3]
            for image, solid in zip(colour, alpha > 0, strict=True):
                beside = ~solid[:, :-1] & solid[:, 1:]  # a blade at the right
                ratio = image[:, :-1][beside] / image[:, 1:][beside]
                self.assertLess(abs(numpy.median(ratio) - 1), 0.3)
            _, _, mips, _ = ktx2(self.files[f"tangent_{name}.ktx2"])
            self.assertGreater(mips[0][..., 1].min(), 100)  # up, or along the ground

    def test_atlas(self):
        """A tile is its image, and its rim what comes after the other edge."""
        for name in ("layers", "slices"):
            _, _, array, _ = ktx2(self.files[f"albedo_{name}.ktx2"])
            facts = self.stack["arrays"][name]
            for image in (i for i in self.stack["images"] if i["array"] == name):
                atlas = facts["atlases"][image["variant"]]
                _, _, mips, _ = ktx2(self.files[atlas["albedo"][0]])
                self.assertEqual(len(mips), atlas["mips"])
                self.assertEqual(mips[0].shape[1:3], (atlas["height"], atlas["width"]))
                for m, mip in enumerate(mips):
                    left, top, right, bottom = (
                        round(u * size / 2**m)
                        for u, size in zip(
                            image["atlas_uv"], 2 * (atlas["width"], atlas["height"]), strict=True
                        )
                    )
                    tile, rim = mip[0, top:bottom, left:right], atlas["rim_texels"] >> m
                    if (facts["height"] >> m) << m == facts["height"]:
                        self.assertTrue(
                            numpy.array_equal(tile, array[m][image["index"]]), (image["name"], m)
                        )
                    self.assertTrue(
                        numpy.array_equal(mip[0, top:bottom, right : right + rim], tile[:, :rim])
                    )
                    self.assertTrue(
                        numpy.array_equal(mip[0, top:bottom, left - rim : left], tile[:, -rim:])
                    )
                    if name == "layers":
                        self.assertTrue(
                            numpy.array_equal(mip[0, bottom : bottom + rim, left:right], tile[:rim])
                        )
                self.assertGreaterEqual(atlas["rim_texels"] >> (atlas["mips"] - 1), 1)

    def test_stack(self):
        facts = self.facts()
        self.assertEqual(len(self.stack["images"]), 2 * (4 + 2 * 4))
        heights = [
            i["height_m"]
            for i in self.stack["images"]
            if i["array"] == "layers" and i["variant"] == 1
        ]
        self.assertTrue(numpy.allclose(heights, facts["levels"][0]["layer_heights_m"], atol=1e-6))
        for image in self.stack["images"]:
            low, high = image["slab_m"]
            self.assertTrue(low <= image.get("height_m", image.get("middle_m")) <= high)
        far = self.stack["far_field"]
        for key in ("march", "far", "far_light"):
            self.assertEqual(far[key], facts[key])
        for name in far["files"]:
            self.assertEqual(self.files[name], (self.dir / "set" / name).read_bytes())
        self.assertIn("far.exr", far["files"])
        self.assertFalse(
            any(name.startswith(("layers", "slices", "blades", "volume")) for name in self.files)
        )

    def test_no_atlas(self):
        files = self.export("textures", "--no-atlas", name="flat")
        self.assertFalse(any("variant" in name or name.endswith(".png") for name in files))
        self.assertNotIn("atlas_uv", files["stack.json"].decode())

    def test_height_map(self):
        self.assert_done(
            self.texgen(
                sward_cli.WORK / "export.toml",
                "-o",
                "tops",
                "--height-map",
                "top",
                "--no-volume",
                *FAST,
            )
        )
        self.assert_done(
            self.texgen(
                "export", "tops", "-o", "t", "--for", "textures", "--compression", "none", "-q"
            )
        )
        _, layers, mips, _ = ktx2((self.dir / "t/albedo_layers.ktx2").read_bytes())
        self.assertEqual(layers, 2)
        self.assertEqual(set(numpy.unique(mips[0][..., 3])), {0, 255})
        _, _, mips, _ = ktx2((self.dir / "t/tangent_layers.ktx2").read_bytes())
        self.assertGreater(mips[0][..., 3].max(), 150)


class Tool(ExportCase):
    def test_threads_and_report(self):
        for target in TARGETS:
            with self.subTest(target=target):
                one = self.export(target, "--threads", "1", name=f"{target}1")
                result = self.texgen(
                    "export",
                    "set",
                    "-o",
                    f"{target}2",
                    "--for",
                    target,
                    "--threads",
                    "2",
                    "--json",
                    "-q",
                )
                self.assert_done(result)
                two = {path.name: path.read_bytes() for path in (self.dir / f"{target}2").iterdir()}
                self.assertEqual(sorted(one), sorted(two))
                for name, content in one.items():
                    self.assertTrue(content == two[name], name)
                report, listed = json.loads(result.out), json.loads(one["export.json"])
                self.assertEqual(report["files"], listed["files"])
                self.assertEqual(
                    {name: f["bytes"] for name, f in listed["files"].items()},
                    {name: len(content) for name, content in one.items() if name != "export.json"},
                )
                self.assertEqual(
                    (report["for"], listed["for"], listed["preset"]), (target, target, "tiny")
                )

    def test_usage(self):
        self.refuse_export(2, ["--for"], "set", "-o", "out")
        self.refuse_export(
            2, ["--for", "unity", "gltf, textures or blender"], "set", "-o", "out", "--for", "unity"
        )
        self.refuse_export(2, ["--output"], "set", "--for", "gltf")
        self.refuse_export(2, ["SET"], "-o", "out", "--for", "gltf")
        self.refuse_export(
            2,
            ["--compression", "bc"],
            "set",
            "-o",
            "out",
            "--for",
            "textures",
            "--compression",
            "bc",
        )
        self.refuse_export(
            2, ["--threads", "-1"], "set", "-o", "out", "--for", "gltf", "--threads=-1"
        )
        self.assertIn("export", self.texgen("--help").out)
        manual = (sward_cli.SOURCE / "docs/texgen.md").read_text()
        for option in ("--for", "--no-atlas", "texgen export"):
            self.assertIn(option, self.texgen("export", "--help").out + "texgen export")
            self.assertIn(option, manual)

    def test_bad_sets(self):
        self.refuse_export(
            5, ["nowhere", "no such directory"], "nowhere", "-o", "a/b/out", "--for", "gltf"
        )
        (self.dir / "empty").mkdir()
        self.refuse_export(3, ["empty/set.json"], "empty", "-o", "a/out", "--for", "gltf")
        data = bytearray((self.dir / "set/slabs.ktx2").read_bytes())
        data[-1] ^= 1
        (self.dir / "set/slabs.ktx2").write_bytes(data)
        for target in TARGETS:
            self.refuse_export(3, ["slabs.ktx2", "SHA-256"], "set", "-o", "a/out", "--for", target)

    def test_damaged_volume(self):
        data = bytearray((self.dir / "set/volume.vdb").read_bytes())
        data[len(data) // 2] ^= 1
        (self.dir / "set/volume.vdb").write_bytes(data)
        self.refuse_export(
            3, ["volume.vdb", "SHA-256"], "set", "-o", "out", "--for", "blender", "-q"
        )

    def test_far_only(self):
        self.assert_done(
            self.texgen(
                "import",
                "set/volume.vdb",
                "-o",
                "far",
                "--size",
                "32",
                "--layers",
                "2",
                "--slices",
                "2",
                "--levels",
                "1",
                "--far-rays",
                "1024",
                *FAST,
                timeout=600,
            )
        )
        self.refuse_export(3, ["far", "blades", "none"], "far", "-o", "out", "--for", "gltf")
        self.refuse_export(3, ["far", "blades", "none"], "far", "-o", "out", "--for", "blender")
        self.assert_done(self.texgen("export", "far", "-o", "out", "--for", "textures", "-q"))

    def test_place(self):
        """Parents are made; an earlier export is replaced, of any kind; anything else is left
        alone."""
        self.export("gltf", name="a/b/out")
        self.export("textures", "--no-atlas", name="a/b/out")
        self.export("blender", name="a/b/out")
        self.assertEqual(len(list((self.dir / "a/b/out").iterdir())), 4)
        (self.dir / "a/b/out/notes.txt").write_text("mine")
        self.refuse_export(5, ["out", "notes.txt"], "set", "-o", "a/b/out", "--for", "gltf")
        (self.dir / "a/b/out/notes.txt").unlink()
        with open(self.dir / "a/b/out/blades.glb", "ab") as file:
            file.write(b"edited")
        self.refuse_export(5, ["out", "blades.glb"], "set", "-o", "a/b/out", "--for", "gltf")
        (self.dir / "own").mkdir()
        (self.dir / "own/volume.vdb").write_text("smoke")
        self.refuse_export(5, ["own", "volume.vdb"], "set", "-o", "own", "--for", "blender")
        (self.dir / "file").write_text("x")
        self.refuse_export(5, ["file"], "set", "-o", "file", "--for", "gltf")
        for place in ("set", "set/out", "./set/../set"):
            self.refuse_export(5, ["set"], "set", "-o", place, "--for", "gltf")
        (self.dir / "bare").mkdir()
        self.export("gltf", name="bare")

    def test_interrupted(self):
        """A signal in the middle of the work leaves no file behind."""
        before = sward_cli.snapshot(self.dir)
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            child = sward_cli.start(
                "texgen",
                "export",
                "set",
                "-o",
                "deep/out",
                "--for",
                "textures",
                "--compression",
                "zstd:19",
                "-q",
                cwd=self.dir,
            )

            def writing():
                return any(os.listdir(path) for path in (self.dir / "deep").glob(".sward-*"))

            alive = sward_cli.interrupt(child, number, writing)
            _, err = child.communicate(timeout=300)
            self.assertTrue(alive, err)
            self.assertEqual(child.returncode, code, err)
            self.assertEqual([p for p in self.dir.rglob("*") if ".sward-" in p.name], [])
            shutil.rmtree(self.dir / "deep", ignore_errors=True)
        self.assertEqual(sward_cli.snapshot(self.dir), before)


if __name__ == "__main__":
    sward_cli.main()
