# SPDX-License-Identifier: Apache-2.0
"""A still scene gives still pictures, and the figures of the other image tests catch what they are
for: a pop that means
miss, a black frame, a number that is none."""

import unittest

import numpy as np
import OpenEXR
from PIL import Image

import metrics
import sward_image
from sward_image import ImageCase, camera


def noise(shape, seed=1):
    """A field as fine as grass, 0..255."""
    return np.round(np.random.default_rng(seed).uniform(60, 120, (*shape, 3)))


class Still(ImageCase):
    @classmethod
    def scene(cls):
        return sward_image.scene_text([camera("road", (0.7, 1.5, 4), -21, 16.4)])

    def test_twice(self):
        """Blades and the far field in one picture, in wind: the same bytes."""
        arguments = ("--camera", "road", "--time", "2.5")
        first, stats = self.render("a.png", *arguments)
        self.assertTrue(
            first.read_bytes() == self.render("b.png", *arguments)[0].read_bytes(),
            "different bytes",
        )
        sward_image.load_png(first)
        self.assertGreater(stats["blades"]["drawn"], 0)
        self.assertGreater(sum(stats["fragments"].values()), 0)

    def test_there_and_back(self):
        """Tiers chosen from half a metre ahead leave no trace in the next frame drawn from the eye
        itself."""
        arguments = ("--camera", "road", "--time", "2.5", "--aov", "color,tier")
        first = sward_image.load_exr(self.render("a.exr", *arguments)[0])
        ahead = sward_image.load_exr(
            self.render("b.exr", *arguments, "--lod-eye", "0.7,1.5,3.5")[0]
        )
        back = sward_image.load_exr(self.render("c.exr", *arguments)[0])
        self.assertTrue((first["tier"] != ahead["tier"]).any())
        self.assertTrue((first["color"] == back["color"]).all())


class Loader(ImageCase):
    @classmethod
    def scene(cls):
        return ""

    def save_png(self, pixels):
        Image.fromarray(pixels.astype(np.uint8)).save(self.dir / "t.png")
        return self.dir / "t.png"

    def save_exr(self, pixels):
        channels = {
            name: np.ascontiguousarray(pixels[..., i], dtype=np.float32)
            for i, name in enumerate("RGB")
        }
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, channels).write(str(self.dir / "t.exr"))
        return self.dir / "t.exr"

    def test_good(self):
        pixels = noise((36, 64))
        self.assertTrue((sward_image.load_png(self.save_png(pixels)) == pixels).all())
        self.assertTrue((sward_image.load_exr(self.save_exr(pixels))["color"] == pixels).all())

    def test_black(self):
        black = np.zeros((36, 64, 3))
        self.assertRaisesRegex(
            metrics.NoPicture, "black", sward_image.load_png, self.save_png(black)
        )
        self.assertRaisesRegex(
            metrics.NoPicture, "black", sward_image.load_exr, self.save_exr(black)
        )
        self.assertRaisesRegex(
            metrics.NoPicture, "colour", sward_image.load_png, self.save_png(black + 40)
        )

    def test_not_finite(self):
        for value in (np.nan, np.inf):
            pixels = noise((36, 64))
            pixels[20, 30, 1] = value
            self.assertRaisesRegex(
                metrics.NoPicture, "finite", sward_image.load_exr, self.save_exr(pixels)
            )
            self.assertRaises(metrics.NoPicture, metrics.pair, pixels, noise((36, 64)))

    def test_missing(self):
        self.assertRaises(FileNotFoundError, sward_image.load_png, self.dir / "none.png")
        self.assertRaises(RuntimeError, sward_image.load_exr, self.dir / "none.exr")
        self.assertRaises(metrics.NoPicture, metrics.pair, noise((36, 64)), noise((36, 60)))


class Figures(unittest.TestCase):
    def test_identical(self):
        picture = noise((180, 320))
        self.assertEqual(
            metrics.pair(picture, picture),
            {"tile16": 0, "signed8": 0, "flip": 0, "over16_percent": 0},
        )

    def test_pop(self):
        """A tree of 2 x 40 pixels in 640 x 360: too small for any mean, caught by the local maxima
        wherever it stands."""
        before = noise((360, 640))
        for x, y in ((300, 150), (317, 163), (0, 0), (638, 320)):
            after = before.copy()
            after[y : y + 40, x : x + 2] = 0
            figures = metrics.pair(before, after)
            self.assertLess(metrics.mean_difference(before, after), 0.05)
            self.assertLess(figures["over16_percent"], metrics.PAIR_LIMITS["over16_percent"])
            self.assertIn("tile16", metrics.over_limits(figures))
            self.assertIn("signed8", metrics.over_limits(figures))

    def test_each_limit(self):
        """What each figure alone is for: a shift of brightness that is even, noise without one, a
        speckle."""
        before = noise((180, 320))
        darker = metrics.pair(before, before - 10)
        self.assertAlmostEqual(darker["tile16"], 10)
        self.assertAlmostEqual(darker["signed8"], 10)
        self.assertEqual(darker["over16_percent"], 0)
        reseeded = metrics.pair(before, noise((180, 320), seed=2))
        self.assertGreater(reseeded["tile16"], 7)
        self.assertGreater(reseeded["flip"], metrics.PAIR_LIMITS["flip"])
        self.assertGreater(reseeded["over16_percent"], 40)
        speckle = before.copy()
        speckle[::12, ::12] = 255
        self.assertIn("over16_percent", metrics.over_limits(metrics.pair(before, speckle)))

    def test_windows(self):
        values = np.zeros((20, 30))
        values[3:11, 13:21] = 2
        self.assertAlmostEqual(metrics.largest_window(values, 8), 2)
        self.assertAlmostEqual(metrics.largest_window(values, 16), 0.5)
        self.assertAlmostEqual(metrics.largest_window(values[:4, :4] + 1, 16), 1)

    def test_boxes(self):
        picture = np.arange(6 * 8 * 3, dtype=np.float64).reshape(6, 8, 3)
        self.assertEqual(metrics.boxed(picture, 4).shape, (1, 2, 3))
        self.assertAlmostEqual(metrics.boxed(picture, 4)[0, 1, 2], picture[:4, 4:, 2].mean())

    def test_luminance(self):
        self.assertEqual(list(metrics.srgb([0, 0.0031308, 0.5, 1, 2])), [0, 10, 188, 255, 255])
        pixels = np.zeros((2, 2, 3))
        pixels[0, 0] = [1, 1, 1]
        self.assertAlmostEqual(metrics.mean_luminance(pixels), 0.25)


if __name__ == "__main__":
    sward_image.main()
