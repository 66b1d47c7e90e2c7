# SPDX-License-Identifier: Apache-2.0
"""Gate 1, the hand-over alone: every step of a sweep at 30 m/s is rendered twice at one pose and
time, with the tiers chosen
from this step's eye and from the step before's. The band lies in the middle of the picture, at the
pixel scale of a frame
1280 x 720 with 60 degrees. The same hand-over onto shells alone must fail.

Beside the pixels' own figures stand those of 4 x 4 boxes, where a blade in the band is 0.1 to 0.3
pixels wide: single blades
that change places within a slab average out there, and what stays is what a tier has too much or
too little."""

import metrics
import sward_image
from sward_image import ImageCase

SIZE, FOV, PITCH = "320x180", 16.4, -21  # focal length 625 pixels, ground from 3 to 7 m
HEIGHT, SPEED, START_Z = 1.5, 30.0, 4.0
STEPS = 7
BOX = 4
BUILDS = {"ships": (), "no_slices": ("--far", "planes")}
EVERY_STEP, SOME_STEPS = range(1, STEPS + 1), (1, 4)


class Sweep(ImageCase):
    @classmethod
    def scene(cls):
        keys = ", ".join(
            f"{{ t = {t}, position = [0.7, {HEIGHT}, {START_Z - SPEED * t}], pitch_deg = {PITCH} }}"
            for t in (0, 1)
        )
        return sward_image.scene_text(
            [], extra=f"[path.sweep]\nfov_deg = {FOV}\nkeys = [ {keys} ]\n"
        )

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.shaders = sward_image.shaders_without_slices(cls.dir / "shaders")
        cls.now = {
            "ships": cls.stills("ships", range(STEPS + 1)),
            "no_slices": cls.stills("no_slices", SOME_STEPS),
        }

    @classmethod
    def stills(cls, build, steps):
        """Pictures of steps with their own tiers, and the statistics. Not a sequence: living blades
        remember their past, and the tiers
        alone may differ from the pictures that these are held against."""
        pictures, stats = {}, {}
        for step in steps:
            path, stats[step] = cls.render(
                f"{build}.{step}.png",
                "--path",
                "sweep",
                "--time",
                repr(step / 60),
                "--frame-index",
                str(step),
                *BUILDS[build],
                size=SIZE,
                shaders=cls.shaders_of(build),
            )
            pictures[step] = sward_image.load_png(path)
        return pictures, stats

    @classmethod
    def shaders_of(cls, build):
        return cls.shaders if build == "no_slices" else None

    @classmethod
    def moment(cls, output, step, tiers_of, *arguments, shaders=None):
        """Step `step` with the tiers of step `tiers_of`."""
        eye = f"0.7,{HEIGHT},{START_Z - SPEED * tiers_of / 60}"
        return cls.render(
            output,
            "--path",
            "sweep",
            "--time",
            repr(step / 60),
            "--frame-index",
            str(step),
            "--lod-eye",
            eye,
            *arguments,
            size=SIZE,
            shaders=shaders,
        )[0]

    def step(self, build, step, before):
        """Figures of the pixels, and of the boxes."""
        then = sward_image.load_png(
            self.moment("then.png", step, before, *BUILDS[build], shaders=self.shaders_of(build))
        )
        now = self.now[build][0][step]
        pixels, boxes = (
            metrics.pair(then, now),
            metrics.pair(metrics.boxed(then, BOX), metrics.boxed(now, BOX)),
        )
        print(
            f"{build:9} step {step} tiers of {before}: {metrics.text(pixels)}; boxes: {metrics.text(boxes)}",
            flush=True,
        )
        return pixels, boxes

    def test_handover(self):
        """In boxes. Pixel by pixel a blade half a pixel to a pixel wide and its image in 4 mm
        texels differ too much for the limits
        (docs/testing.md has the figures); that is printed, not asserted."""
        pixels, boxes = zip(*(self.step("ships", step, step - 1) for step in EVERY_STEP))
        print(
            "worst:",
            metrics.text(metrics.worst(pixels)),
            "boxes:",
            metrics.text(metrics.worst(boxes)),
        )
        self.assertEqual(metrics.over_limits(metrics.worst(boxes), metrics.BOX_LIMITS), {})

    def test_backwards(self):
        self.assertEqual(metrics.over_limits(self.step("ships", 3, 4)[1], metrics.BOX_LIMITS), {})

    def test_catches_shells_alone(self):
        """Without slices blades change into shells that hold about a quarter of what they cover at
        this elevation: worse than
        what ships in every figure, over the limits even in boxes, and there more than three times
        as bad."""
        ships, alone = (self.worst_of(build) for build in ("ships", "no_slices"))
        pixels, boxes = (
            {name: alone[k][name] / max(ships[k][name], 1e-3) for name in metrics.PAIR_LIMITS}
            for k in (0, 1)
        )
        print("times what ships:", metrics.text(pixels), "boxes:", metrics.text(boxes))
        self.assertGreater(min(pixels.values()), 1)
        self.assertEqual(set(metrics.over_limits(alone[0])), set(metrics.PAIR_LIMITS))
        self.assertEqual(
            set(metrics.over_limits(alone[1], metrics.BOX_LIMITS)), set(metrics.PAIR_LIMITS)
        )
        self.assertGreaterEqual(max(boxes.values()), 3)

    def worst_of(self, build):
        pixels, boxes = zip(*(self.step(build, step, step - 1) for step in SOME_STEPS))
        return metrics.worst(pixels), metrics.worst(boxes)

    def test_blades_cross(self):
        """Or the sweep would show no hand-over: pixels change tier both ways of looking at one
        moment, by steps that follow."""
        now, then = (
            sward_image.load_exr(self.moment("tiers.exr", 4, tiers_of, "--aov", "tier"))
            for tiers_of in (4, 3)
        )
        near = [(c["tier"] > 0.5) & (c["tier"] < 2.5) for c in (now, then)]
        taken, given = (near[0] & ~near[1]).sum(), (near[1] & ~near[0]).sum()
        print(
            f"step 4: {near[0].sum()} pixels of blades, {taken} taken from the far tier, {given} given to it"
        )
        self.assertGreater(near[0].mean(), 0.1)
        self.assertLess(near[0].mean(), 0.9)
        self.assertGreater(taken, 0.01 * near[0].size)

    def test_all_tiers_drew(self):
        for frame in self.now["ships"][1].values():
            self.assertGreater(frame["blades"]["drawn"], 0)
            self.assertGreater(sum(frame["fragments"].values()), 0)
        pictures = list(self.now["ships"][0].values())
        for a, b in zip(pictures, pictures[1:]):
            self.assertGreater(metrics.mean_difference(a, b), 1, "the eye stands still")

    def test_same_moment(self):
        """--lod-eye at the eye itself changes nothing: what the pair measures is the step alone."""
        same = sward_image.load_png(self.moment("same.png", 2, 2))
        self.assertEqual(metrics.mean_difference(same, self.now["ships"][0][2]), 0)


if __name__ == "__main__":
    sward_image.main()
