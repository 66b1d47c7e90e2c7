# SPDX-License-Identifier: Apache-2.0
"""A vehicle in the viewer, under the keyboard."""
import sward_cli
from test_view import ESCAPE, ViewCase


class Drive(ViewCase):
    def test_drive(self):
        """With the keyboard: away to the north, to the right, and to a stop."""
        child = self.view("--window", "64x36", "--drive", "car", "--tyres-on", "road", "--fixed-timestep", "0.2", "--samples", "1", "--camera", "0,1,0,0,0")
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

        start = pose()
        self.assertAlmostEqual(start[0], -0.35, delta=0.4, msg="the driver's seat, in a car that stands aslant on the hill")
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
