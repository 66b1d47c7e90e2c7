# SPDX-License-Identifier: Apache-2.0
"""A vehicle and an aircraft in the viewer, under the keyboard."""

import sward_cli
from test_view import ESCAPE, ViewCase


class Drive(ViewCase):
    def setUp(self):
        super().setUp()
        # What goes moves the air: a small window of it.
        self.scene(sward_cli.SCENE + "\n[wind]\ncells = 64\n")

    def begin(self, *arguments):
        """The viewer, its window, what tells a pose, and what waits for one; a picture is a fifth
        of a second."""
        child = self.view(
            "--window", "64x36", "--fixed-timestep", "0.2", "--samples", "1", *arguments
        )
        self.wait_for(lambda: self.display.colours() > 100, child)
        window = self.display.windows()[-1]

        def pose():
            self.display.tap(window, "k")
            return [float(n) for n in child.stdout.readline().split(",")]

        def until(what):
            for _ in range(200):
                at = pose()
                if what(at):
                    return at
            self.fail("waited in vain")

        return child, window, pose, until

    def test_fly(self):
        """Hands off it flies on; with the stick to the right it banks and turns there."""
        child, window, pose, until = self.begin("--fly", "trainer", "--camera", "0,200,400,0,0")
        start = pose()
        level = until(lambda at: at[2] < start[2] - 60)
        self.assertLess(abs(level[1] - start[1]), 60, "above the ground, which is a hill")
        self.assertLess(abs(level[3] + 180) % 360 - 180, 3)
        self.display.key(window, "d", True)
        turned = until(lambda at: 5 < at[3] < 90)
        self.assertGreater(turned[0], start[0] - 5)
        self.display.key(window, "d", False)
        self.display.tap(window, ESCAPE)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0, err)

    def test_helicopter(self):
        """Hands off it stands in the air, over its own downwash; the stick ahead takes it north; let go it stands again."""
        child, window, pose, until = self.begin("--fly", "helicopter", "--camera", "0,8,0,0,0")
        start = pose()
        poses = []
        until(lambda at: poses.append(at) or len(poses) > 8)
        self.assertLess(max(abs(poses[-1][i] - start[i]) for i in (0, 2)), 2)
        self.assertAlmostEqual(poses[-1][1], start[1], delta=3)
        self.display.key(window, "w", True)
        until(lambda at: at[2] < start[2] - 25)
        self.display.key(window, "w", False)
        poses = []
        until(
            lambda at: poses.append(at)
            or (len(poses) > 1 and abs(poses[-1][2] - poses[-2][2]) < 0.05)
        )
        self.assertGreater(poses[-1][1], 2, "it has not come down")
        self.display.tap(window, ESCAPE)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0, err)

    def test_refusals(self):
        for option in ("--drive", "--fly"):
            self.refuse(
                2,
                [option, "nothing", "one that ships"],
                "view",
                "scene.toml",
                option,
                "nothing",
                env=self.env,
            )
        (self.dir / "bad.toml").write_text("mass_kg = -1\n")
        for option in ("--drive", "--fly"):
            self.refuse(
                3,
                ["bad.toml:1", "mass_kg", "-1"],
                "view",
                "scene.toml",
                option,
                "bad.toml",
                env=self.env,
            )

    def test_drive(self):
        """With the keyboard: away to the north, to the right, and to a stop."""
        child, window, pose, until = self.begin(
            "--drive", "car", "--tyres-on", "road", "--camera", "0,1,0,0,0"
        )

        start = pose()
        self.assertAlmostEqual(
            start[0],
            -0.35,
            delta=0.4,
            msg="the driver's seat, in a car that stands aslant on the hill",
        )
        self.assertAlmostEqual(start[1], 1.2, delta=0.2)
        self.display.key(window, "w", True)
        until(lambda at: at[2] < start[2] - 20)
        self.display.key(window, "d", True)
        turned = until(lambda at: 15 < at[3] < 180)
        self.assertGreater(turned[0], start[0])
        for key in "wd":
            self.display.key(window, key, False)
        self.display.key(window, "e", True)
        before = []
        until(lambda at: before.append(at) or (len(before) > 1 and before[-1] == before[-2]))
        self.assertLess(before[-1][1], 1.5, "on its wheels")
        self.display.tap(window, ESCAPE)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0, err)


if __name__ == "__main__":
    sward_cli.main()
