# SPDX-License-Identifier: Apache-2.0
"""`sward wind`: the local window as pictures of numbers, and what it refuses."""

import json
import struct
import zlib

import sward_cli
from sward_cli import SCENE, CliCase

WIND = (
    SCENE
    + """
[wind]
speed_mps = 5
direction_deg = 270
gust = 0
cells = 48
cell_m = 0.5
[[wind.arrow]]
id = "a"
root = [-6, 0]
tip = [-1, 0]
strength_mps = 12
radius_m = 3
[[wind.obstacle]]
circle = [6, 0, 2]
"""
)


def attributes(path):
    """Header of an OpenEXR file: name -> (type, bytes), and where its offset table begins."""
    data = path.read_bytes()
    assert struct.unpack("<I", data[:4])[0] == 20000630
    at, found = 8, {}
    while data[at]:
        name, at = read_name(data, at)
        kind, at = read_name(data, at)
        size = struct.unpack("<I", data[at : at + 4])[0]
        found[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    return found, at + 1


def read_name(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def channels(path):
    """A zip-compressed EXR of float channels: name -> rows of numbers."""
    header, at = attributes(path)
    names, offset, listed = [], 0, header["channels"][1]
    while listed[offset]:
        name, offset = read_name(listed, offset)
        assert struct.unpack("<I", listed[offset : offset + 4])[0] == 2, name  # float
        names.append(name)
        offset += 16
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"][1])
    width, height, data = x1 - x0 + 1, y1 - y0 + 1, path.read_bytes()
    rows = {name: [] for name in names}
    for block in range((height + 15) // 16):
        place = struct.unpack("<Q", data[at + 8 * block : at + 8 * block + 8])[0]
        size = struct.unpack("<i", data[place + 4 : place + 8])[0]
        lines = min(16, height - 16 * block)
        packed = data[place + 8 : place + 8 + size]
        raw = packed if size == lines * width * 4 * len(names) else unzip(packed)
        for line in range(lines):
            for i, name in enumerate(names):
                begin = (line * len(names) + i) * width * 4
                rows[name].append(struct.unpack(f"<{width}f", raw[begin : begin + 4 * width]))
    return rows


def unzip(packed):
    """EXR's zip: deflated, then differences, then two halves to interleave."""
    raw = bytearray(zlib.decompress(packed))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (len(raw) + 1) // 2
    out = bytearray(len(raw))
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


class Wind(CliCase):
    def wind(self, *arguments, **options):
        return self.sward("wind", "scene.toml", *arguments, **options)

    def test_window(self):
        self.scene(WIND)
        self.assert_done(self.wind("--time", "1.5", "-o", "w.exr", "--debug-gl"))
        header, _ = attributes(self.dir / "w.exr")
        facts = {
            name: float(header[name][1])
            for name in ("cell_m", "origin_x_m", "origin_z_m", "time_s")
        }
        self.assertEqual(
            facts, {"cell_m": 0.5, "origin_x_m": -12, "origin_z_m": -12, "time_s": 1.5}
        )
        c = channels(self.dir / "w.exr")
        self.assertEqual(sorted(c), ["divergence", "solid", "u", "v", "vorticity"])
        column, row = lambda x: int((x + 12) / 0.5), lambda z: int((z + 12) / 0.5)
        self.assertGreater(c["u"][row(0)][column(-0.5)], 9, "the arrow's gust, at its tip")
        self.assertAlmostEqual(c["u"][row(-10)][column(-10)], 5, delta=2)
        self.assertEqual(
            [c["solid"][row(0)][column(x)] for x in (3.5, 4.5, 7.5, 8.5)], [0, 1, 1, 0]
        )
        self.assertEqual(
            sum(map(sum, c["solid"])),
            sum(
                (x * 0.5 - 11.75 - 6) ** 2 + (z * 0.5 - 11.75) ** 2 <= 4
                for x in range(48)
                for z in range(48)
            ),
        )
        inner = [
            abs(c["divergence"][z][x])
            for z in range(8, 40)
            for x in range(8, 40)
            if c["solid"][z][x] == 0
        ]
        self.assertLess(sum(inner) / len(inner), 0.1)
        # Vorticity, as differences of the picture's own velocities say it too.
        z, x = row(3.0), column(0.0)
        curl = (c["v"][z][x + 1] - c["v"][z][x - 1] - c["u"][z + 1][x] + c["u"][z - 1][x]) / 1.0
        self.assertAlmostEqual(c["vorticity"][z][x], curl, delta=0.3 + 0.3 * abs(curl))
        # A jet to the east turns the air to either side: u falls away from its middle.
        self.assertLess(c["vorticity"][row(-1.75)][column(-0.5)], -0.5)
        self.assertGreater(c["vorticity"][row(1.75)][column(-0.5)], 0.5)

    def test_place_and_sequence(self):
        self.scene(WIND)
        self.assert_done(
            self.wind("--time", "0.25", "--every", "0.1", "--at", "6,3.2", "-o", "w.%02d.exr")
        )
        names = sorted(path.name for path in self.dir.glob("w.*"))
        self.assertEqual(names, ["w.00.exr", "w.01.exr", "w.02.exr"])
        header, _ = attributes(self.dir / "w.02.exr")
        self.assertEqual(float(header["time_s"][1]), 0.2)
        self.assertAlmostEqual(float(header["origin_x_m"][1]), 6 - 12, delta=2)
        self.assert_done(self.wind("--time", "0.2", "--at", "6,3.2", "-o", "again.%d.exr"))
        self.assertEqual(
            (self.dir / "again.0.exr").read_bytes(),
            (self.dir / "w.02.exr").read_bytes(),
            "the same bits",
        )

    def test_meshes(self):
        self.scene(
            WIND.replace("circle = [6, 0, 2]", 'mesh = "wall.gltf"\nplace = [6, 0]\nheight_m = 1')
        )
        quad = struct.pack("<12f", 0, 0, -3, 0, 0, 3, 0, 2, 3, 0, 2, -3)
        (self.dir / "wall.bin").write_bytes(quad + struct.pack("<6H", 0, 1, 2, 0, 2, 3))
        gltf = {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"byteLength": 60, "uri": "wall.bin"}],
            "bufferViews": [
                {"buffer": 0, "byteLength": 48},
                {"buffer": 0, "byteOffset": 48, "byteLength": 12},
            ],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            ],
        }
        (self.dir / "wall.gltf").write_text(json.dumps(gltf))
        self.assert_done(self.wind("--time", "0.05", "-o", "w.exr"))
        solid = channels(self.dir / "w.exr")["solid"]
        rows = [z for z in range(48) if sum(solid[z])]
        self.assertLessEqual(abs(len(rows) - 12), 2, "a sheet of 6 m")
        self.assertTrue(all(sum(solid[z]) <= 2 for z in rows), "a cell or two thick")
        for path in self.dir.glob("w.exr"):
            path.unlink()
        gltf["buffers"][0]["uri"] = "../wall.bin"
        (self.dir / "wall.gltf").write_text(json.dumps(gltf))
        self.refuse(
            3,
            ["wall.gltf", "buffer's URI", "../wall.bin"],
            "wind",
            "scene.toml",
            "--time",
            "1",
            "-o",
            "w.exr",
        )
        (self.dir / "wall.gltf").unlink()
        self.refuse(5, ["wall.gltf"], "wind", "scene.toml", "--time", "1", "-o", "w.exr")
        (self.dir / "wall.gltf").write_text("[" * 30000)
        self.refuse(4, ["wall.gltf", "nesting"], "wind", "scene.toml", "--time", "1", "-o", "w.exr")

    def test_refusals(self):
        self.scene(WIND)
        whole = ["wind", "scene.toml", "--time", "1", "-o", "w.exr"]
        for code, pieces, arguments in [
            (2, ["--output"], whole[:4]),
            (2, ["--time"], ["wind", "scene.toml", "-o", "w.exr"]),
            (2, ["SCENE"], ["wind", "--time", "1", "-o", "w.exr"]),
            (2, ["--output", "w.png", ".exr"], whole[:5] + ["w.png"]),
            (2, ["--output", "%d or %04d"], whole + ["--every", "0.5"]),
            (2, ["--every", "0"], whole + ["--every", "0"]),
            (2, ["--time", "nan"], ["wind", "scene.toml", "--time", "nan", "-o", "w.exr"]),
            (2, ["--at", "3"], whole + ["--at", "3"]),
            (2, ["--at"], whole + ["--at", "1,2,3"]),
            (2, ["--at", "1e9"], whole + ["--at", "1e9,0"]),
            (2, ["--aov"], whole + ["--aov", "depth"]),
            (
                4,
                ["--every"],
                ["wind", "scene.toml", "--time", "1e9", "--every", "0.001", "-o", "w.%d.exr"],
            ),
            (5, ["nowhere"], whole[:5] + ["/proc/nowhere/w.exr"]),
            (5, ["gone.toml"], ["wind", "gone.toml", "--time", "1", "-o", "w.exr"]),
        ]:
            with self.subTest(arguments):
                self.refuse(code, pieces, *arguments)
        self.scene(WIND.replace("radius_m = 3", "radius_m = 0"))
        self.refuse(
            3, ["scene.toml:21", "wind.arrow[0].radius_m", "found 0", "0.01 to 1000 m"], *whole
        )
        self.scene(WIND.replace("circle = [6, 0, 2]", "circle = [6, 0, 20]"))
        self.refuse(3, ["wind.obstacle[0].circle", "whole window"], *whole)


if __name__ == "__main__":
    sward_cli.main()
