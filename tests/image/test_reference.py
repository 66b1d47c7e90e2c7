# SPDX-License-Identifier: Apache-2.0
"""The reference draws the blades that a sample falls on, and no others: the picture is that of all
blades, bit by bit. A test of samples that
takes blades for thinner than they are must be found, and so must one that takes blades to be behind
what they stand before."""

import shutil

import numpy as np

import sward_image
from sward_image import ImageCase, camera, sward_cli

SIZE = "64x36"
# Height in metres, elevation in degrees, vertical field of view: all blades of the first two are
# much thinner than a pixel; the last has long
# ones, and some behind the eye.
VIEWS = {"level": (1.7, 6, 60), "steep": (9, 80, 60), "close": (0.35, 10, 60)}
REACH = "14"
# more blades than are gathered at once: the later ones are held against the depth of the first
FAR_REACH = "24"


def shaders_with(target, old, new):
    """A copy of the shaders whose test of samples is another."""
    shutil.copytree(sward_cli.SOURCE / "shaders", target)
    source = target / "lib/blade_samples.glsl"
    text = source.read_text()
    changed = text.replace(old, new, 1)
    assert changed != text, f"blade_samples.glsl has no {old}"
    source.write_text(changed)
    return target


class Reference(ImageCase):
    @classmethod
    def scene(cls):
        return sward_image.scene_text(
            camera(name, (3, height, 5), -elevation, fov)
            for name, (height, elevation, fov) in VIEWS.items()
        )

    def picture(self, view, *arguments, reach=REACH, shaders=None):
        path, stats = self.render(
            "out.exr",
            "--camera",
            view,
            "--time",
            "2",
            "--tiers",
            "reference",
            "--reference-distance",
            reach,
            "--aov",
            "color,coverage,tier,rank",
            *arguments,
            size=SIZE,
            shaders=shaders,
        )
        channels = sward_image.load_exr(path)
        return np.concatenate(
            [channels["color"]]
            + [channels[name][..., None] for name in ("coverage", "tier", "rank")],
            axis=2,
        ), stats["blades"]

    def test_same_picture(self):
        for view in VIEWS:
            for grid in ("1", "3"):
                with self.subTest(view=view, grid=grid):
                    every, all_blades = self.picture(
                        view, "--reference-grid", grid, "--cull", "frustum"
                    )
                    found, blades = self.picture(view, "--reference-grid", grid)
                    print(
                        f"{view} {grid}: {all_blades['drawn']} blades, {blades['drawn']} by samples, largest difference {np.abs(found - every).max():.2g}",
                        flush=True,
                    )
                    self.assertGreater(every[..., 3].mean(), 0.2)  # of the picture is grass
                    self.assertTrue(np.array_equal(found, every))
                    self.assertLess(blades["drawn"], 0.6 * all_blades["drawn"])
                    self.assertLessEqual(
                        blades["drawn"] + sum(blades["culled"].values()), blades["considered"]
                    )

    def test_thin_blades_are_found(self):
        every, _ = self.picture("steep", "--reference-grid", "1", "--cull", "frustum")
        thin, _ = self.picture(
            "steep",
            "--reference-grid",
            "1",
            shaders=shaders_with(self.dir / "thin", "reach + kSnap_px", "0.25 * reach"),
        )
        self.assertFalse(np.array_equal(thin, every))

    def test_hidden_blades(self):
        arguments = ("level", "--reference-grid", "1")
        every, all_blades = self.picture(*arguments, "--cull", "samples", reach=FAR_REACH)
        found, blades = self.picture(*arguments, reach=FAR_REACH)
        print(
            f"{all_blades['drawn']} blades by samples, {blades['drawn']} of them not hidden, largest difference {np.abs(found - every).max():.2g}",
            flush=True,
        )
        self.assertTrue(np.array_equal(found, every))
        self.assertLess(blades["drawn"], 0.95 * all_blades["drawn"])
        self.assertEqual(blades["drawn"] + blades["culled"]["occlusion"], all_blades["drawn"])
        behind = shaders_with(
            self.dir / "behind", "s).r < nearest_depth", "s).r < 0.8 * nearest_depth"
        )
        wrong, _ = self.picture(*arguments, reach=FAR_REACH, shaders=behind)
        self.assertFalse(np.array_equal(wrong, every))


if __name__ == "__main__":
    sward_image.main()
