# SPDX-License-Identifier: Apache-2.0
"""Several pictures of every moment: where they lie, that they join, and files of channels that are
wrong."""

import re
import signal
import subprocess
import zlib

import numpy

import sward_cli
import test_view
from sward_cli import CliCase, environment

LOOK = ("--camera", "3,2,1,45,-10", "--time", "1")
CHANNEL = '[[channel]]\nname = "{name}"\nsize = [{width}, {height}]\n{more}\n'


def channel(name, more, width=32, height=24):
    return CHANNEL.format(name=name, width=width, height=height, more=more)


def read_png(path):
    """8-bit RGB of a PNG whose rows Sward wrote, as height x width x 3."""
    data, parts = path.read_bytes(), []
    at = 8
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "big")
        if data[at + 4 : at + 8] == b"IHDR":
            width, height = (int.from_bytes(data[at + 8 + i : at + 12 + i], "big") for i in (0, 4))
        if data[at + 4 : at + 8] == b"IDAT":
            parts.append(data[at + 8 : at + 8 + size])
        at += size + 12
    rows = numpy.frombuffer(zlib.decompress(b"".join(parts)), numpy.uint8).reshape(
        height, 1 + 3 * width
    )
    out = numpy.zeros((height + 1, width + 1, 3), int)
    for y in range(height):
        kind, row = rows[y, 0], rows[y, 1:].reshape(width, 3).astype(int)
        for x in range(width):
            left, up, corner = out[y + 1, x], out[y, x + 1], out[y, x]
            out[y + 1, x + 1] = (row[x] + predicted(kind, left, up, corner)) & 255
    return out[1:, 1:]


def predicted(kind, left, up, corner):
    if kind < 4:
        return (0 * left, left, up, (left + up) // 2)[kind]
    guess = left + up - corner
    far = numpy.abs(numpy.stack([guess - left, guess - up, guess - corner]))
    first = numpy.argmin(far, axis=0)
    return numpy.choose(first, [left, up, corner])


class Channels(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def channels(self, *texts):
        (self.dir / "channels.toml").write_text("".join(texts))

    def draw(self, *texts):
        """The channels' pictures by name."""
        self.channels(*texts)
        self.assert_done(
            self.sward(
                "render", "scene.toml", "-o", "out.png", "--channels", "channels.toml", *LOOK
            )
        )
        names = [re.search('name = "(.*)"', text).group(1) for text in texts]
        return [read_png(self.dir / f"out-{name}.png") for name in names]

    def test_pictures(self):
        left = channel("left", "frustum_deg = [-40, 0, -30, 30]", width=16)
        right = channel("right", "frustum_deg = [0, 40, -30, 30]", width=16)
        mirror = channel("mirror", "fov_deg = 60\nmirror = true")
        halves = self.draw(
            left,
            right,
            channel("whole", "frustum_deg = [-40, 40, -30, 30]"),
            channel("front", "fov_deg = 60"),
            mirror,
        )
        joined = numpy.concatenate(halves[:2], axis=1)
        # Corners fall onto a grid of 1/256 pixel, by sums that round differently in half a picture
        # and in the whole: a pixel at a blade's edge may differ.
        self.assertLessEqual(numpy.count_nonzero((joined != halves[2]).any(axis=2)), 4)
        turned = numpy.abs(halves[4][:, ::-1] - halves[3])
        self.assertLess(turned.mean(), 8)
        self.assertGreater(numpy.abs(halves[4] - halves[3]).mean(), 2 * turned.mean())

        # A channel like the picture that is drawn without any is that picture; the order in which
        # they are drawn changes no bit.
        self.assert_done(self.render("--size", "32x24", *LOOK))
        alone = read_png(self.dir / "out.png")
        lens = channel("front", "fov_deg = 60")
        first, front = self.draw(
            channel("back", "yaw_deg = 180\nfov_deg = 60\noffset_m = [0.5, 0, 1]"), lens
        )
        self.assertTrue((front == alone).all())
        front, again = self.draw(
            lens, channel("back", "yaw_deg = 180\nfov_deg = 60\noffset_m = [0.5, 0, 1]")
        )
        self.assertTrue((front == alone).all() and (again == first).all())
        self.assertGreater(numpy.abs(first - front).mean(), 2)

    def test_sequence(self):
        self.channels(channel("a", "fov_deg = 30"), channel("b", "fov_deg = 50"))
        self.assert_done(
            self.sward(
                "render",
                "scene.toml",
                "-o",
                "new/f.%d.png",
                "--frames",
                "0:1",
                "--channels",
                "channels.toml",
                *LOOK,
            )
        )
        self.assertEqual(
            sorted(p.name for p in (self.dir / "new").iterdir()),
            ["f.0-a.png", "f.0-b.png", "f.1-a.png", "f.1-b.png"],
        )

    def test_refusals(self):
        good = channel("a", "fov_deg = 30")
        for text, pieces in (
            ("", ["channel", "nothing"]),
            (channel("a", ""), ["frustum_deg", "fov_deg"]),
            (
                channel("a", "fov_deg = 30\nfrustum_deg = [-1, 1, -1, 1]"),
                ["frustum_deg", "fov_deg beside it"],
            ),
            (channel("a", "frustum_deg = [1, -1, -1, 1]"), ["frustum_deg", "left below right"]),
            (channel("a", "frustum_deg = [-90, 1, -1, 1]"), ["frustum_deg[0]", "-90"]),
            (channel("a", "fov_deg = nan"), ["fov_deg", "nan"]),
            (channel("a", "fov_deg = 30\nyaw = 3"), ["channel[0].yaw", "yaw_deg"]),
            (channel("a/b", "fov_deg = 30"), ["name", "a/b"]),
            (channel("a", "fov_deg = 30", width=0), ["size[0]", "0"]),
            (channel("a", "fov_deg = 30", width=1.5), ["size", "whole pixels"]),
            (good + good, ["name", "no other channel"]),
            (good + channel("b", "fov_deg = 30\nat = [16384, 0]"), ["16416"]),
            ("[[channel]\n", ["TOML"]),
        ):
            with self.subTest(text=text):
                self.channels(text)
                self.refuse(
                    3,
                    ["channels.toml", *pieces],
                    "render",
                    "scene.toml",
                    "-o",
                    "out.png",
                    "--channels",
                    "channels.toml",
                )
        self.channels("".join(channel(f"c{i}", "fov_deg = 30", width=16) for i in range(17)))
        self.refuse(
            4,
            ["channels.toml", "17"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--channels",
            "channels.toml",
        )
        self.refuse(
            5, ["none.toml"], "render", "scene.toml", "-o", "out.png", "--channels", "none.toml"
        )
        self.refuse(
            2,
            ["--channels"],
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--channels",
            "channels.toml",
            "--size",
            "32x24",
        )

    def test_window(self):
        """One window holds them where the file says; the black between them is no channel's."""
        self.channels(
            channel("a", "fov_deg = 60", width=160, height=120),
            channel("b", "fov_deg = 60\nyaw_deg = 60\nat = [200, 100]", width=160, height=120),
        )
        screen = self.dir / "screen"
        screen.mkdir()
        display = test_view.Display(screen)
        self.addCleanup(display.close)
        env = environment(
            DISPLAY=display.name, EGL_PLATFORM=None, XDG_STATE_HOME=self.dir / "state"
        )
        child = subprocess.Popen(
            [
                str(sward_cli.BIN / "sward"),
                "view",
                "scene.toml",
                "--channels",
                "channels.toml",
                *LOOK,
            ],
            cwd=self.dir,
            env=env,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(child.communicate)
        self.addCleanup(child.kill)

        def patches():
            pixels = numpy.array(display.pixels()).reshape(test_view.HEIGHT, test_view.WIDTH)
            return [
                len(set(pixels[y : y + 20, x : x + 60].ravel()))
                for x, y in ((80, 90), (280, 190), (280, 60))
            ]

        wait = lambda what: test_view.ViewCase.wait_for(self, what, child)
        wait(lambda: display.windows() and patches()[0] > 50)
        self.assertEqual(display.geometry(display.windows()[-1])[2:], (360, 220))
        for key in "ti":
            display.tap(display.windows()[-1], key)
        wait(lambda: patches()[1] > 50 and patches()[2] == 1)
        child.send_signal(signal.SIGTERM)
        self.assertEqual(child.wait(timeout=300), 143)


if __name__ == "__main__":
    sward_cli.main()
