# SPDX-License-Identifier: Apache-2.0
"""The measures of the far field on pictures whose answers are known: waves, noise, ramps, tiles,
rings, colours."""

import unittest

import numpy as np

import far_views
import spectrum
from metrics import NoPicture
from sward_image import main


def waves(length_px, amplitude=0.2, side=384, mean=0.5):
    """Level brightness with a sine along the columns."""
    row = mean * (1 + amplitude * np.sin(2 * np.pi * np.arange(side) / length_px))
    return np.tile(row, (side, 1))


def noise(shape, amplitude=0.2, seed=1, mean=0.5):
    return mean * (1 + amplitude * np.random.default_rng(seed).standard_normal(shape))


class Contrast(unittest.TestCase):
    def test_waves(self):
        """A Gaussian of s pixels leaves exp(-2 (pi s / L)^2) of a sine of length L."""
        for length in (4, 8, 16, 32):
            left = [1.0] + [np.exp(-2 * (np.pi * s / length) ** 2) for s in spectrum.SIGMAS]
            expected = 0.2 / np.sqrt(2) * np.abs(np.diff(left))
            found = spectrum.contrast(waves(length))
            self.assertTrue(
                np.allclose(found, expected, rtol=0.05, atol=0.005),
                f"{length}: {found}, {expected}",
            )

    def test_noise(self):
        """White noise less its blur by one pixel, from the kernel's own weights."""
        kernel = spectrum.blurred(np.pad([[1.0]], 20), 1)
        expected = 0.2 * np.sqrt(1 - 2 * kernel.max() + (kernel**2).sum())
        self.assertAlmostEqual(
            spectrum.contrast(noise((200, 200)))[0], expected, delta=0.03 * expected
        )

    def test_blur_keeps(self):
        self.assertTrue(np.allclose(spectrum.blurred(np.full((20, 30), 3.0), 8), 3))
        values = noise((64, 64))
        rest = spectrum.blurred(values, 8)
        self.assertTrue(np.allclose(sum(spectrum.octaves(values)).reshape(64, 64) + rest, values))

    def test_ratio_is_free_of_noise(self):
        """Against one noisy render the truth itself would seem too smooth; against what two have in
        common it does not."""
        truth = spectrum.blurred(noise((160, 160), 0.5), 1)
        a, b = (truth * noise(truth.shape, 0.2, seed, mean=1) for seed in (2, 3))
        self.assertLess(spectrum.contrast(truth)[0] / spectrum.contrast(a)[0], 0.6)
        self.assertTrue(
            np.allclose(spectrum.contrast_ratio(truth, a, b), 1, atol=0.06),
            spectrum.contrast_ratio(truth, a, b),
        )
        louder = 0.5 + 2 * (truth - 0.5)
        self.assertTrue(np.allclose(spectrum.contrast_ratio(louder, a, b), 2, atol=0.12))

    def test_floor(self):
        """Contrast of a thousandth is under a step of the display: no ratio."""
        still = noise((96, 96), 0.001)
        self.assertTrue(np.isnan(spectrum.contrast_ratio(noise((96, 96), 0.1), still, still)).all())

    def test_land(self):
        """A bright sky over half of the picture changes nothing on land, and does not bleed in."""
        values = noise((96, 96))
        land = np.ones(values.shape, dtype=bool)
        land[:48] = False
        under_sky = np.where(land, values, 20.0)
        self.assertTrue(
            np.allclose(
                spectrum.contrast(under_sky, land), spectrum.contrast(values[48:]), rtol=0.15
            )
        )
        self.assertRaisesRegex(
            NoPicture, "land", spectrum.contrast, values, np.zeros(values.shape, dtype=bool)
        )


class Sparkle(unittest.TestCase):
    def test_ramp(self):
        """A quarter of a pixel on a slope of 4 % of the mean a pixel: 1 %."""
        ramp = np.tile(1 + 0.04 * (np.arange(101) - 50), (40, 1))
        moved = ramp[:, :-1] + 0.25 * np.diff(ramp, axis=1)
        self.assertAlmostEqual(spectrum.sparkle(ramp, moved), 0.01)
        self.assertAlmostEqual(spectrum.common_sparkle((ramp, ramp), (moved, moved)), 0.01)

    def test_rare(self):
        """One pixel in fifty that flashes is more than the percentile lets go; one in a thousand is
        not."""
        still = np.full((100, 100), 0.5)
        still[0, 0] = 0.51
        flashes = still.copy()
        flashes[::10, ::5] += 0.5
        self.assertAlmostEqual(spectrum.sparkle(still, flashes), 1, delta=0.01)
        few = still.copy()
        few[::50, ::20] += 0.5
        self.assertLess(spectrum.sparkle(still, few), 0.01)

    def test_noise_is_freed(self):
        """Two noisy renders of a picture and of the moved one: the change they have in common, not
        the noise."""
        fine = spectrum.blurred(noise((400, 400), 1.0), 4)
        still, moved = fine[::4, ::4], fine[::4, 1::4]
        renders = [
            [
                p + 0.02 * np.random.default_rng(seed + i).standard_normal(p.shape)
                for i, p in enumerate((still, moved))
            ]
            for seed in (10, 20)
        ]
        pair, later = ([r[i] for r in renders] for i in (0, 1))
        truth = spectrum.sparkle(still, moved)
        self.assertGreater(spectrum.sparkle(pair[0], later[0]), 2 * truth)
        self.assertAlmostEqual(spectrum.common_sparkle(pair, later), truth, delta=0.35 * truth)


class Period(unittest.TestCase):
    def test_tiles(self):
        """Grass without a period has no peak; a tile of 2 m among it has, and more the more of it
        there is."""
        grass = noise((160, 160))
        tile = np.tile(noise((16, 16), seed=5), (10, 10)) - 0.5  # 8 pixels a metre
        self.assertLess(spectrum.period(grass, 8), 2)
        weak, strong = spectrum.period(grass + 0.2 * tile, 8), spectrum.period(grass + tile, 8)
        self.assertGreater(weak, 1.5)
        self.assertGreater(strong, 3 * weak)

    def test_too_small(self):
        self.assertRaisesRegex(NoPicture, "periods", spectrum.period, noise((48, 48)), 8)

    def test_ground(self):
        """A pattern of the ground's plane, seen at 60 degrees and laid out flat again, is the
        pattern."""
        view = far_views.View(60, 24, 30)
        elevation, half = (
            np.radians(view.elevation),
            (far_views.ROWS / 2 - 0.5, far_views.COLUMNS / 2 - 0.5),
        )
        up, right = np.meshgrid(
            (half[0] - np.arange(far_views.ROWS)) / view.focal,
            (np.arange(far_views.COLUMNS) - half[1]) / view.focal,
            indexing="ij",
        )
        height = view.distance * np.sin(elevation) - far_views.CANOPY_M
        depth = height / (np.sin(elevation) - up * np.cos(elevation))
        forward = (
            depth * np.cos(elevation) + depth * up * np.sin(elevation) - height / np.tan(elevation)
        )
        shape = lambda x, z: 1 + 0.3 * np.sin(np.pi * x) * np.cos(np.pi * z)  # noqa: E731
        seen = far_views.ground_picture(shape(right * depth, forward), view, 8)
        at = np.arange(seen.shape[0]) / 8 - seen.shape[0] / 16
        self.assertGreater(seen.shape[0], 64)
        self.assertLess(np.abs(seen - shape(*np.meshgrid(at, at[::-1]))).max(), 0.05)
        self.assertGreater(spectrum.period(seen + noise(seen.shape, 0.1), 8), 5)


class Ring(unittest.TestCase):
    distance = 60 / np.linspace(0.4, 3, 240)  # 150 m to 20 m

    def field(self):
        return noise((self.distance.size, 1600))

    def test_level(self):
        change = spectrum.ring(self.field(), self.distance)
        self.assertLess(max(change), 0.1, change)

    def test_luminance(self):
        values = self.field()
        values[self.distance > 50] *= 1.15
        contrast, light = spectrum.ring(values, self.distance)
        self.assertAlmostEqual(light, 0.15, delta=0.05)
        self.assertLess(contrast, 0.12)

    def test_contrast(self):
        values = self.field()
        far = self.distance > 50
        values[far] = 0.5 + 1.4 * (values[far] - 0.5)
        contrast, light = spectrum.ring(values, self.distance)
        self.assertGreater(contrast, 0.2)
        self.assertLess(light, 0.05)

    def test_refuses(self):
        self.assertRaisesRegex(
            NoPicture, "falling", spectrum.ring, self.field(), self.distance[::-1]
        )
        self.assertRaisesRegex(
            NoPicture, "bands", spectrum.ring, self.field()[:12], self.distance[:12]
        )


class Hue(unittest.TestCase):
    def colour(self, *rgb):
        picture = np.tile(np.array(rgb, dtype=np.float64), (8, 8, 1))
        picture[0, 0] *= 0.5
        picture[0, 1] *= 1.5  # not of one colour, the same mean
        return picture

    def test_known(self):
        """sRGB's primaries in CIE Lab (D65)."""
        self.assertTrue(np.allclose(spectrum.hue(self.colour(1, 1, 1)), 0, atol=0.02))
        self.assertTrue(np.allclose(spectrum.hue(self.colour(1, 0, 0)), [80.09, 67.20], atol=0.05))
        self.assertTrue(
            np.allclose(spectrum.hue(self.colour(0, 0, 1)), [79.19, -107.86], atol=0.05)
        )

    def test_difference(self):
        grass = self.colour(0.08, 0.15, 0.03)
        self.assertEqual(spectrum.hue_difference(grass, grass), 0)
        self.assertGreater(spectrum.hue_difference(grass, self.colour(0.09, 0.15, 0.03)), 2)

    def test_display(self):
        self.assertTrue(
            np.allclose(
                spectrum.displayed([0, 0.5 / 0.62, 100]),
                [0, (0.5 * 1.285) / (0.5 * 1.805 + 0.14), 1],
            )
        )


class Reference(unittest.TestCase):
    def test_split(self):
        """Two halves whose mean is the picture, and that move by a quarter of a pixel."""
        rows, columns = np.meshgrid(np.arange(64.0), np.arange(96.0), indexing="ij")
        fine = np.stack([rows, columns, rows + columns, rows * 0 + 1], axis=2)
        for factor in (4, 8):
            a, b = far_views.split(fine, factor)
            both = (a.still + b.still) / 2
            self.assertTrue(np.allclose(both[1, 2, 0], 1.5 * factor - 0.5))
            self.assertTrue(np.allclose(a.still[..., 3], 1))
            for half in (a, b):
                self.assertTrue(np.allclose(half.right[..., 1] - half.still[:, :-1, 1], factor / 4))
                self.assertTrue(np.allclose(half.down[..., 0] - half.still[:-1, :, 0], factor / 4))


class Refusals(unittest.TestCase):
    def test_no_picture(self):
        good = noise((32, 32))
        holed = good.copy()
        holed[3, 4] = np.nan
        for bad in (holed, np.zeros((32, 32)), np.ones((4, 4, 3)), np.zeros((0, 4))):
            self.assertRaises(NoPicture, spectrum.contrast, bad)
            self.assertRaises(NoPicture, spectrum.sparkle, good, bad)
            self.assertRaises(NoPicture, spectrum.contrast_ratio, good, good, bad)
            self.assertRaises(NoPicture, spectrum.period, bad, 8)
        self.assertRaises(NoPicture, spectrum.sparkle, good, noise((32, 20)))
        self.assertRaises(NoPicture, spectrum.hue, np.zeros((4, 4, 3)))
        self.assertRaises(NoPicture, spectrum.luminance, np.full((4, 4, 3), np.inf))


if __name__ == "__main__":
    main()
