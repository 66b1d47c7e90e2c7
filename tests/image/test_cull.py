# SPDX-License-Identifier: Apache-2.0
"""Culling (J7) on the hills of the nature scene: what it takes, and that nothing is missed. The
same figures must catch culling that takes
too much: blades that do not widen."""

import re
import shutil

import flip_evaluator
import metrics
import numpy as np
import sward_image
from sward_image import ImageCase

SCENE = sward_image.sward_cli.SOURCE / "terrains/near/nature"
TESTS = ("frustum", "orientation", "distance", "occlusion")
CULLED, FLIP, CLOSE, POINTS = 0.70, 0.05, 0.03, 0.03
SIZE = "320x240"
THIN_OUT = 20  # metres; three quarters of the far blades go


def flip_mean(a, b):
    pictures = [np.ascontiguousarray(p / 255, dtype=np.float32) for p in (a, b)]
    return float(flip_evaluator.evaluate(*pictures, "LDR", applyMagma=False)[1])


class Culling(ImageCase):
    @classmethod
    def scene(cls):
        # Still air: what differs is the culling. The body and the balls hide blades too.
        return (SCENE / "scene.toml").read_text().replace("speed_mps = 3", "speed_mps = 0")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for mesh in SCENE.glob("*.glb"):
            shutil.copy(mesh, cls.dir)
        cls.found = {tests: cls.picture(tests) for tests in ("none", ",".join(TESTS))}

    @classmethod
    def picture(cls, tests, shaders=None, thin_out=None):
        """Display picture, channels and counts with these tests; thin_out_m in place of the
        scene's."""
        text = cls.scene()
        assert text.count("thin_out_m = ") == 1
        (cls.dir / "scene.toml").write_text(
            text
            if thin_out is None
            else re.sub(r"thin_out_m = \S+", f"thin_out_m = {thin_out}", text)
        )
        options = ("--camera", "default", "--cull", tests)
        path, stats = cls.render(
            "out.exr", *options, "--aov", "color,coverage", size=SIZE, shaders=shaders
        )
        channels = sward_image.load_exr(path)
        png, _ = cls.render("out.png", *options, size=SIZE, shaders=shaders)
        return sward_image.load_png(png), channels, stats["blades"]

    def figures(self, found):
        picture, channels, _ = found
        base, base_channels, _ = self.found["none"]
        light = metrics.mean_luminance(channels["color"]) / metrics.mean_luminance(
            base_channels["color"]
        )
        coverage = channels["coverage"].mean(), base_channels["coverage"].mean()
        return {
            "flip": flip_mean(base, picture),
            "luminance": light - 1,
            "coverage": coverage[0] / coverage[1] - 1,
            "points": coverage[0] - coverage[1],
        }

    def test_most_is_culled_and_nothing_is_missed(self):
        blades = self.found[",".join(TESTS)][2]
        seen, drawn = blades["considered"], blades["drawn"]
        print(
            f"of {seen} blades of visible patches {1 - drawn / seen:.1%} culled: "
            + ", ".join(f"{name} {blades['culled'][name] / seen:.1%}" for name in TESTS),
            flush=True,
        )
        self.assertEqual(seen, drawn + sum(blades["culled"].values()))
        self.assertGreaterEqual(1 - drawn / seen, CULLED)
        figures = self.figures(self.found[",".join(TESTS)])
        print(
            "all tests: " + ", ".join(f"{name} {value:+.4f}" for name, value in figures.items()),
            flush=True,
        )
        self.assertLessEqual(figures["flip"], FLIP)
        self.assertLessEqual(abs(figures["luminance"]), CLOSE)
        self.assertLessEqual(abs(figures["coverage"]), CLOSE)

    def test_distance_keeps_coverage(self):
        figures = self.figures(self.picture("distance", thin_out=THIN_OUT))
        print(
            "distance: " + ", ".join(f"{name} {value:+.4f}" for name, value in figures.items()),
            flush=True,
        )
        self.assertLessEqual(abs(figures["points"]), POINTS)

    def test_blades_that_do_not_widen_are_found(self):
        target = self.dir / "thin"
        shutil.copytree(sward_image.sward_cli.SOURCE / "shaders", target)
        file = target / "shared/lod.h"
        text = file.read_text()
        assert text.count("0.0f, 1.0f) / mean;") == 1
        file.write_text(text.replace("0.0f, 1.0f) / mean;", "0.0f, 1.0f);"))
        figures = self.figures(self.picture("distance", shaders=target, thin_out=THIN_OUT))
        print(
            "not widened: " + ", ".join(f"{name} {value:+.4f}" for name, value in figures.items()),
            flush=True,
        )
        self.assertGreater(abs(figures["points"]), POINTS)


if __name__ == "__main__":
    sward_image.main()
