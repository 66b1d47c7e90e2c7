# SPDX-License-Identifier: Apache-2.0
"""The same command gives the same bytes; what should change the picture does."""

import sward_cli
from sward_cli import CliCase


class Determinism(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def picture(self, name, *arguments, **options):
        self.assert_done(self.render("-o", name, "--size", "160x90", *arguments, **options))
        return (self.dir / name).read_bytes()

    def assert_same(self, a, b):
        self.assertTrue(a == b, "different bytes")  # assertEqual would print both

    def test_twice(self):
        first = self.picture("a.png", "--time", "2.5")
        self.assert_same(first, self.picture("b.png", "--time", "2.5"))
        self.assert_same(first, self.picture("a.png", "--time", "2.5"))  # over an older one
        aovs = ("--aov", "color,depth,tier,coverage,tangent,normal,rank")
        self.assert_same(self.picture("a.exr", *aovs), self.picture("b.exr", *aovs))

    def test_threads(self):
        one = sward_cli.environment(LP_NUM_THREADS="1")
        self.assert_same(self.picture("a.png"), self.picture("b.png", env=one))

    def test_warm_frames(self):
        """Frames drawn before leave no trace in the one that counts."""
        self.assert_same(self.picture("a.png"), self.picture("b.png", "--warm", "2"))

    def test_sequence_is_stills(self):
        self.assert_done(
            self.render("-o", "f.%d.png", "--size", "160x90", "--frames", "30:31", "--path", "roll")
        )
        still = self.picture(
            "s.png", "--path", "roll", "--time", str(31 / 60), "--frame-index", "1"
        )
        self.assert_same((self.dir / "f.31.png").read_bytes(), still)

    def test_options_count(self):
        """An option that changes nothing in the picture would pass every test of sameness."""
        near = ["--camera", "0,0.4,0,0,-30"]  # near enough for blades that are geometry
        base = self.picture("a.png", *near)
        for arguments in (
            [*near, "--time", "3"],
            ["--camera", "0,1,0,90,-20"],
            [*near, "--tiers", "shells"],
            [*near, "--exposure", "2"],
            [*near, "--density", "0"],
            [*near, "--lod-eye", "0,0.4,80"],
            [*near, "--handover", "off"],
        ):
            with self.subTest(arguments=arguments):
                self.assertTrue(base != self.picture("b.png", *arguments), "the same picture")

    def test_texgen(self):
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        sets = []
        for name, threads in (("one", "1"), ("two", "2")):
            result = sward_cli.run(
                "texgen",
                "tiny.toml",
                "-o",
                name,
                "--threads",
                threads,
                "-q",
                "--no-preview",
                cwd=self.dir,
            )
            self.assert_done(result)
            sets.append({path.name: path.read_bytes() for path in (self.dir / name).iterdir()})
        self.assert_same(sets[0], sets[1])
        self.assertGreater(len(sets[0]), 3)


if __name__ == "__main__":
    sward_cli.main()
