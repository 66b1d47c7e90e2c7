# SPDX-License-Identifier: Apache-2.0
"""Ground and masks that lie somewhere: what is drawn where, what `info` says of it, and poses by
latitude and longitude."""

import json
import re
import struct

import numpy
import OpenEXR
from PIL import Image

import sward_cli
from geotiff import geotiff
from sward_cli import CliCase

UTM32, WGS84 = 32632, 4326
TERRAIN = """\
[terrain]
elevation = "height.tif"
detail_m = 0
{more}
[grass]
set = "set"
[camera.default]
position = [0, 1.7, 0]
[camera.tele]
position = [0, 30, 150]
agl = false
fov_deg = {fov}
"""


class Ground(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def terrain(self, more="", fov=10):
        (self.dir / "scene.toml").write_text(TERRAIN.format(more=more, fov=fov))

    def picture(self, camera, aov, size, *arguments):
        result = self.render(
            "-o", "out.exr", "--camera", camera, "--aov", aov, "--size", size, *arguments
        )
        self.assert_done(result)
        with OpenEXR.File(str(self.dir / "out.exr"), separate_channels=True) as file:
            return numpy.array(file.channels()[aov].pixels)

    def depth(self, camera):
        return self.picture(camera, "depth", "101x101", "--density", "0")[50, 50]

    def coverage(self, camera):
        return self.picture(camera, "coverage", "33x33", "--samples", "1").mean()

    def info(self):
        result = self.sward(
            "info",
            "scene.toml",
            env=sward_cli.environment(__EGL_VENDOR_LIBRARY_DIRS="/nonexistent"),
        )
        self.assert_done(result)
        return {line[:10].strip(): line[11:] for line in result.out.splitlines()}

    def test_longitudes_from_0_to_360(self):
        geotiff(
            self.dir / "height.tif",
            101,
            81,
            lambda i, j: 250 + i,
            "h",
            WGS84,
            (5e-4, 0, 286, 0, -5e-4, 40),
        )
        self.terrain()
        self.assertAlmostEqual(self.depth("abs:0,400,0,0,-90"), 100, delta=1)
        self.assertAlmostEqual(self.depth("abs:-1000,400,0,0,-90"), 100 + 1000 / 42.7, delta=1)

    def test_mask_on_the_dems_grid(self):
        """At the zone's edge UTM's grid is turned by two degrees: grass stands south of a row of
        the grid, and no other."""
        affine = (30, 0, 735000, 0, -30, 5500000)
        geotiff(self.dir / "height.tif", 161, 161, lambda i, j: 50, "f", UTM32, affine)
        geotiff(self.dir / "mask.tif", 161, 161, lambda i, j: 255 * (j >= 20), "B", UTM32, affine)
        self.terrain('mask = "mask.tif"')
        # Row 20 begins 60.5 rows, 1816 m, north of the middle; along it the frame's z grows by the
        # meridian's convergence.
        turned = 2.51 / 57.2958
        for x in (-1500, 0, 1500):
            edge = -1815 + x * turned
            self.assertGreater(self.coverage(f"{x},6,{edge + 25},0,-90"), 0.02, x)
            self.assertLess(self.coverage(f"{x},6,{edge - 25},0,-90"), 0.002, x)

    def test_classes_in_another_crs(self):
        geotiff(
            self.dir / "height.tif",
            101,
            101,
            lambda i, j: 100 + j,
            "f",
            UTM32,
            (10, 0, 500000, 0, -10, 5500000),
        )
        lat, lon = 49.645, 9.0069  # somewhere in it
        geotiff(
            self.dir / "mask.tif",
            400,
            400,
            lambda i, j: 30 if i >= 200 else 7,
            "h",
            WGS84,
            (1e-4, 0, lon - 0.02, 0, -1e-4, lat + 0.02),
            -1,
        )
        self.terrain('mask = "mask.tif"\n[terrain.classes]\n30 = 1.0')
        rows = self.info()
        self.assertIn("UTM zone 32N", rows["crs"])
        self.assertRegex(rows["posts"], r"^101 x 101, 10\.00")
        self.assertRegex(rows["extent"], r"^100\d\.?\d* m x 100\d\.?\d* m")
        self.assertRegex(rows["heights"], r"^(99\.9|100\.0)\d to (199\.9|200\.0)\d m")
        latitude, longitude = map(float, re.match(r"([-\d.]+), ([-\d.]+)", rows["origin"]).groups())
        self.assertAlmostEqual(latitude, 49.6480, delta=2e-4)
        self.assertAlmostEqual(longitude, 9.0070, delta=2e-4)
        shares = {
            name: float(value.split()[0])
            for name, value in rows.items()
            if name.startswith("class")
        }
        self.assertEqual(set(shares), {"class 7", "class 30"})
        self.assertAlmostEqual(sum(shares.values()), 100, delta=0.01)
        self.assertAlmostEqual(shares["class 30"], 50, delta=3)
        step = 8 / 72300  # degrees of longitude that are eight metres here
        self.assertGreater(self.coverage(f"geo:{lat},{lon + step},6,0,-90"), 0.02)
        # The far field takes the density where a ray enters the canopy, up to half a metre from the
        # root.
        self.assertLess(self.coverage(f"geo:{lat},{lon - step},6,0,-90"), 0.006)

    def test_poses_on_earth(self):
        geotiff(
            self.dir / "height.tif",
            101,
            101,
            lambda i, j: 100 + i,
            "f",
            UTM32,
            (10, 0, 500000, 0, -10, 5500000),
        )
        self.terrain()
        latitude, longitude = re.match(r"([-\d.]+), ([-\d.]+)", self.info()["origin"]).groups()
        self.assertAlmostEqual(self.depth(f"geo:{latitude},{longitude},20,0,-90"), 20, delta=0.1)
        self.assertAlmostEqual(
            self.depth(f"abs:geo:{latitude},{longitude},400,0,-90"), 250, delta=0.1
        )
        scene = (self.dir / "scene.toml").read_text()
        (self.dir / "scene.toml").write_text(
            scene + f"[camera.here]\ngeo = [{latitude}, {longitude}, 30]\npitch_deg = -90\n"
            f"[[object]]\nkind = 'sphere'\ngeo = [{latitude}, {longitude}, 0]\nradius_m = 5\n"
        )
        self.assertAlmostEqual(self.depth("here"), 25, delta=0.1)
        self.refuse(
            2,
            ["--camera", "geo:"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--camera",
            "geo:1,2,3",
        )
        self.refuse(
            2,
            ["--camera", "latitude"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--camera",
            "geo:91,2,3,4,5",
        )
        self.refuse(
            2,
            ["--camera", "km from"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--camera",
            "geo:10,9,3,4,5",
        )
        (self.dir / "scene.toml").write_text(sward_cli.SCENE)
        self.refuse(
            2,
            ["--camera", "no place on Earth"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--camera",
            "geo:1,2,3,4,5",
        )

    def test_a_narrow_tower(self):
        """Posts that stand out between the vertices of a block are not culled with it."""
        side = 801
        posts = [
            60.0 if 394 <= i <= 406 and 390 <= j <= 402 else 0.0
            for j in range(side)
            for i in range(side)
        ]
        (self.dir / "height.raw").write_bytes(struct.pack(f"<{len(posts)}f", *posts))
        (self.dir / "height.json").write_text(
            json.dumps({"width": side, "height": side, "spacing_m": [1, 1]})
        )
        for fov in (30, 8, 4):
            (self.dir / "scene.toml").write_text(
                TERRAIN.replace("height.tif", "height.raw").format(more="", fov=fov)
            )
            depth = self.depth("tele")
            self.assertAlmostEqual(depth, 147, delta=4, msg=fov)

    def test_hills_through_a_long_lens(self):
        """Hills of 400 m on posts of 20 m, 5.5 km away: the ground stands where the formula says,
        to about a pixel."""
        side, eye, pitch = 401, numpy.array([0, 400, 3200]), numpy.radians(-4.2)
        wave = 2 * numpy.pi / 400
        place = (numpy.arange(side) - side // 2) * 20
        posts = 40 * numpy.sin(wave * place[None, :]) * numpy.sin(wave * place[:, None])
        (self.dir / "height.raw").write_bytes(posts.astype("<f4").tobytes())
        (self.dir / "height.json").write_text(
            json.dumps({"width": side, "height": side, "spacing_m": [20, 20]})
        )
        text = TERRAIN.replace("height.tif", "height.raw").format(more="", fov=1)
        text = text.replace(
            "position = [0, 30, 150]", "position = [0, 400, 3200]\npitch_deg = -4.2"
        )
        (self.dir / "scene.toml").write_text(text)
        for width, height, grass in ((101, 101, "0"), (160, 90, "1")):
            depth = self.picture("tele", "depth", f"{width}x{height}", "--density", grass)
            focal = 0.5 * height / numpy.tan(numpy.radians(0.5))
            right = (numpy.arange(width) + 0.5 - width / 2)[None, :] / focal
            up = (height / 2 - numpy.arange(height) - 0.5)[:, None] / focal
            x = right * depth
            y = eye[1] + depth * (up * numpy.cos(pitch) + numpy.sin(pitch))
            z = eye[2] - depth * (numpy.cos(pitch) - up * numpy.sin(pitch))
            pixels = (y - 40 * numpy.sin(wave * x) * numpy.sin(wave * z)) * focal / depth
            self.assertGreater(depth.min(), 4000)
            self.assertLess(depth.max(), 7000)
            self.assertLess(numpy.sqrt((pixels**2).mean()), 0.7)
            self.assertLess(
                numpy.abs(pixels).max(), 2.1
            )  # on an edge it is the depth of the first sample, half a pixel aside

    def test_a_strip_stays_unbroken(self):
        """A bare strip of 8 m in a mask of 1 m, seen from 80 m up at 400 to 600 m."""
        geotiff(
            self.dir / "height.tif",
            65,
            65,
            lambda i, j: 0,
            "f",
            UTM32,
            (20, 0, 500000, 0, -20, 5500000),
        )
        geotiff(
            self.dir / "mask.tif",
            1280,
            1280,
            lambda i, j: 0 if 636 <= i < 644 else 255,
            "B",
            UTM32,
            (1, 0, 500010, 0, -1, 5499990),
        )
        self.terrain('mask = "mask.tif"')
        picture = self.picture("0,80,500,0,-9", "coverage", "320x180", "--samples", "1")
        depth = self.picture(
            "0,80,500,0,-9", "depth", "320x180", "--samples", "1", "--density", "0"
        )
        rows = [j for j in range(180) if 400 < depth[j, 160] < 600]
        self.assertGreater(len(rows), 4)
        for j in rows:
            self.assertLess(picture[j, 159:161].min(), 0.1, j)
            self.assertGreater(picture[j, 100:130].mean(), 0.15, j)

    def test_classes_as_an_ascii_grid(self):
        """Landcover as text, with a `.prj` in place; garbage in it is refused with its line, as of
        heights."""
        geotiff(
            self.dir / "height.tif",
            65,
            65,
            lambda i, j: 100,
            "f",
            UTM32,
            (10, 0, 500000, 0, -10, 5500000),
        )
        rows = "\n".join(
            " ".join("30" if i < 16 else "-9999" if i < 20 else "7" for i in range(65))
            for _ in range(65)
        )
        head = "ncols 65\nnrows 65\nxllcorner 500000\nyllcorner 5499350\ncellsize 10\n"
        (self.dir / "cover.asc").write_text(head + rows + "\n")
        (self.dir / "cover.prj").write_text(
            'PROJCS["UTM32",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
            'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
            'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],'
            'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]'
        )
        self.terrain('mask = "cover.asc"\n[terrain.classes]\n30 = 1.0\n7 = 0.5')
        shares = {
            name: float(value.split()[0])
            for name, value in self.info().items()
            if name.startswith(("class", "no value"))
        }
        for name, wanted in (("class 30", 15.5 / 64), ("class 7", 44.5 / 64), ("no value", 4 / 64)):
            self.assertAlmostEqual(shares[name], 100 * wanted, delta=0.5)
        (self.dir / "cover.asc").write_text(head + rows[:-1] + "x\n")
        self.refuse(3, ["cover.asc:70", "x"], "info", "scene.toml")

    def test_masks_of_any_number_of_bits(self):
        """1, 4, 12 and 16 bits reach 1 at their own full scale; a scale that the file says holds
        instead, within 0 to 1."""
        place = {"epsg": UTM32, "affine": (10, 0, 500000, 0, -10, 5500000)}
        geotiff(self.dir / "height.tif", 33, 33, lambda i, j: 100, "f", **place)
        self.terrain('mask = "mask.tif"')
        for bits, kind, full, more in (
            (1, "B", 1, {"bits": 1}),
            (4, "B", 15, {"bits": 4}),
            (12, "H", 4095, {"bits": 12}),
            (16, "H", 65535, {}),
            (8, "B", 200, {"scale": 0.005}),
            (16, "h", 10000, {"scale": 0.0001}),
        ):
            with self.subTest(bits=bits, full=full):
                geotiff(
                    self.dir / "mask.tif",
                    33,
                    33,
                    lambda i, j: full * (j < 16),
                    kind,
                    **place,
                    **more,
                )
                self.assertAlmostEqual(
                    float(self.info()["mask"].split()[-1]), 15.5 / 32, delta=0.02
                )
        geotiff(self.dir / "mask.tif", 33, 33, lambda i, j: 200, "B", **place, scale=0.01)
        self.refuse(3, ["mask.tif", "0 to 1"], "info", "scene.toml")

    def test_a_refusal_is_one_line(self):
        """A warning about what is refused a moment later is dropped, and a library's message is not
        lost behind the file's name."""
        Image.new("RGB", (8, 8)).save(self.dir / "height.tif")
        self.terrain("height_m = [0, 10]")
        self.refuse(3, ["terrain.size_m"], "info", "scene.toml")
        self.terrain("height_m = [0, 10]\nsize_m = [80, 80]")
        result = self.sward("info", "scene.toml")
        self.assert_done(result)
        self.assertIn("3 bands", result.err)
        deep = self.dir / ("d" * 60) / ("e" * 60)
        deep.mkdir(parents=True)
        (deep / "height.tif").write_bytes(b"II*\0" + b"\xff" * 40)
        self.terrain()
        scene = (
            (self.dir / "scene.toml")
            .read_text()
            .replace('"height.tif"', f'"{deep.relative_to(self.dir)}/height.tif"')
        )
        (self.dir / "scene.toml").write_text(scene)
        result = self.sward("info", "scene.toml")
        self.assert_refusal(result, 3, "directory")
        self.assertEqual(result.err.count("eeee/height.tif"), 1, result.err)

    def test_vertical_units_and_voids(self):
        geotiff(
            self.dir / "height.tif",
            33,
            33,
            lambda i, j: -32000 if i == j == 16 else 100,
            "h",
            UTM32,
            (10, 0, 500000, 0, -10, 5500000),
        )
        self.terrain()
        self.assertEqual(self.info()["heights"], "100.00 to 100.00 m")


if __name__ == "__main__":
    sward_cli.main()
