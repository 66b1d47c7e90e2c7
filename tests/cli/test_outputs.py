# SPDX-License-Identifier: Apache-2.0
"""Outputs: names that cannot be written are refused before any work; a write that fails leaves what
stood there."""

import json
import os
import resource

import sward_cli
from sward_cli import CliCase, SIZE


class Outputs(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def refuse_output(self, code, pieces, output, *arguments, **options):
        self.refuse(
            code,
            pieces,
            "render",
            "scene.toml",
            "-o",
            output,
            "--size",
            SIZE,
            *arguments,
            **options,
        )

    def test_names(self):
        (self.dir / "folder.png").mkdir()
        (self.dir / "file").write_text("")
        os.mkfifo(self.dir / "pipe.png")
        (self.dir / "loop.png").symlink_to("loop.png")
        self.refuse_output(5, ["folder.png", "a directory"], "folder.png")
        self.refuse_output(5, ["set", "a directory"], "set")
        self.refuse_output(5, ["/dev/full", "a device"], "/dev/full")
        self.refuse_output(5, ["pipe.png", "FIFO"], "pipe.png")
        self.refuse_output(5, ["loop.png"], "loop.png")
        self.refuse_output(5, ["file"], "file/deep/out.png")
        self.refuse_output(5, ["file"], "file/out.png")
        self.refuse_output(5, ["too long"], "n" * 300 + ".png")
        self.refuse_output(2, ["--output", 'found ""'], "")
        for name in ("out", "out.jpg", "out.png.txt", ".png", "out."):
            with self.subTest(name=name):
                self.refuse_output(2, ["--output", name], name)

    def test_folders_are_made(self):
        """The folder of an output is made, once there is something to put into it; a frame's number
        belongs to the name alone."""
        self.assert_done(self.render("-o", "new/deeper/out.png", "--stats", "other/s.json"))
        self.assertTrue((self.dir / "new/deeper/out.png").exists())
        self.assertTrue((self.dir / "other/s.json").exists())
        self.assert_done(self.render("-o", "out/100% gras/%d/f.%04d.png", "--frames", "0:1"))
        self.assertEqual(
            sorted(p.name for p in (self.dir / "out/100% gras/%d").iterdir()),
            ["f.0000.png", "f.0001.png"],
        )
        self.refuse_output(2, ["--output", "%04d"], "f.%04d/out.png", "--frames", "0:1")

    def test_no_working_directory(self):
        """A relative output in a folder that is gone: the contract's line and code."""
        scene = self.dir / "scene.toml"
        gone = self.dir / "gone"
        gone.mkdir()
        result = sward_cli.run(
            "sward",
            "render",
            scene,
            "-o",
            "out.png",
            "--size",
            SIZE,
            cwd=gone,
            limits=lambda: os.rmdir(gone),
        )
        self.assertEqual(result.code, 5, result.err)
        self.assertEqual(len(result.err.splitlines()), 1, result.err)
        self.assertTrue(result.err.startswith("error: "), result.err)

    def test_inputs(self):
        """An output that is the scene's own file under any name is refused."""
        scene = sward_cli.SCENE.replace("height.raw", "height.png")
        (self.dir / "height.png").write_bytes(b"not read")
        (self.dir / "scene.toml").write_text(scene)
        (self.dir / "link.png").symlink_to("height.png")
        for name in ("height.png", "./set/../height.png", self.dir / "height.png", "link.png"):
            with self.subTest(name=name):
                self.refuse_output(2, ["--output", "the scene's own"], name)
        self.refuse_output(2, ["--stats", "the scene's own"], "out.png", "--stats", "scene.toml")
        self.refuse_output(2, ["--stats", "another file"], "out.png", "--stats", "./out.png")

    def test_permissions(self):
        folder = self.dir / "closed"
        folder.mkdir(mode=0o555)
        self.refuse_output(
            5, ["closed", "ermission"], "closed/out.png", prefix=sward_cli.without_root()
        )
        self.refuse_output(
            5, ["closed"], "out.png", "--stats", "closed/s.json", prefix=sward_cli.without_root()
        )
        result = sward_cli.run(
            "texgen", self.dir / "tiny.toml", "-o", folder / "set", prefix=sward_cli.without_root()
        )
        self.assertIn(result.code, (5,), result.err)
        self.assertEqual(list(folder.iterdir()), [])

    def test_full_disk(self):
        """A limit on the size of files stands for a disk without room: exit 5, the old file intact,
        nothing beside it."""

        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))

        (self.dir / "out.png").write_bytes(b"old")
        (self.dir / "out.exr").write_bytes(b"old")
        env = self.own_shaders()
        for name in ("out.png", "out.exr"):
            before = sward_cli.snapshot(self.dir)
            result = self.render("-o", name, limits=small, env=env)
            self.assertEqual(result.code, 5, result.err)
            self.assertEqual(len(result.err.splitlines()), 1, result.err)
            self.assertIn(name, result.err)
            self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_picture_and_statistics(self):
        """Both or neither: here there is room for a picture of four pixels and not for its
        statistics."""

        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))

        self.assert_done(self.render("--size", "2x2", "--samples", "1"))
        env = self.own_shaders()
        self.assert_done(self.render("--size", "2x2", "--samples", "1", limits=small, env=env))
        (self.dir / "out.png").unlink()
        before = sward_cli.snapshot(self.dir)
        result = self.render(
            "--size", "2x2", "--samples", "1", "--stats", "s.json", limits=small, env=env
        )
        self.assertEqual(result.code, 5, result.err)
        self.assertEqual(len(result.err.splitlines()), 1, result.err)
        self.assertIn("s.json", result.err)
        self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_stdout(self):
        """Results that cannot be written to stdout are a failure too."""
        for arguments in ("--version", "--help", "info"):
            result = sward_cli.run(
                "/bin/sh", "-c", f'"$0" {arguments} > /dev/full', sward_cli.BIN / "sward"
            )
            self.assertEqual(result.code, 5, arguments)
            self.assertEqual(len(result.err.splitlines()), 1, result.err)

    def test_raw_pictures_on_stdout(self):
        self.refuse_output(2, ["--output", "--format"], "-")
        self.refuse_output(2, ["--output", "--format"], "out.png", "--format", "rgb24")
        self.refuse_output(2, ["--format", "rgb24"], "-", "--format", "rgb48")
        self.refuse_output(2, ["--aov"], "-", "--format", "rgb24", "--aov", "depth")
        raw = lambda target, *more: sward_cli.run(
            "/bin/sh",
            "-c",
            f'"$0" "$@" > {target}',
            sward_cli.BIN / "sward",
            "render",
            "scene.toml",
            "-o",
            "-",
            "--format",
            "rgb24",
            "--size",
            SIZE,
            "--path",
            "roll",
            *more,
            cwd=self.dir,
        )
        result = raw("two.rgb", "--frames", "0:1")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("frames: 100 %", result.err, "its progress is on stderr")
        self.assertEqual(raw("one.rgb").code, 0)
        one, two = ((self.dir / name).read_bytes() for name in ("one.rgb", "two.rgb"))
        self.assertEqual(len(one), 64 * 36 * 3)
        self.assertEqual(len(two), 2 * len(one))
        self.assertTrue(two.startswith(one))
        self.assertNotEqual(two[len(one) :], one)
        self.assertGreater(one[2], one[-1], "blue above, from the top")
        full = raw("/dev/full")
        self.assertEqual(full.code, 5, full.err)
        self.assertIn("stdout", full.err)

    def test_texgen_full_disk(self):
        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))

        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        before = sward_cli.snapshot(self.dir)
        result = sward_cli.run("texgen", "tiny.toml", "-o", "set", "-q", cwd=self.dir, limits=small)
        self.assertEqual(result.code, 5, result.err)
        self.assertIn("set", result.err)
        self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_sequence(self):
        for name in ("f.png", "f.%d.%d.png", "f.%s.png", "f.%4d.png", "f.%012d.png", "f.%.png"):
            with self.subTest(name=name):
                self.refuse_output(2, ["--output", "%04d"], name, "--frames", "0:1")
        result = self.render(
            "-o", "f.%03d.png", "--frames", "2:4", "--path", "roll", "--stats", "s.json"
        )
        self.assert_done(result)
        names = sorted(path.name for path in self.dir.glob("f.*"))
        self.assertEqual(names, ["f.002.png", "f.003.png", "f.004.png"])
        frames = json.loads((self.dir / "s.json").read_text())["frames"]
        self.assertEqual([frame["frame"] for frame in frames], [2, 3, 4])

    def test_stats_and_aovs(self):
        result = self.render(
            "-o",
            "out.exr",
            "--aov",
            "color,depth,tier,coverage",
            "--stats",
            "s.json",
            "--debug-gl",
            "--warm",
            "1",
        )
        self.assert_done(result)
        stats = json.loads((self.dir / "s.json").read_text())
        self.assertEqual(
            set(stats), {"gpu", "size", "passes", "blades", "physics", "fragments", "bytes"}
        )
        self.assertEqual(stats["size"], [64, 36])
        self.assertGreater(len(stats["passes"]), 4)
        for row in stats["passes"]:
            self.assertEqual(set(row), {"name", "gpu_ms", "cpu_ms"})
            self.assertGreaterEqual(row["cpu_ms"], 0)
        self.assertEqual(set(stats["blades"]), {"considered", "drawn", "culled"})
        self.assertEqual(set(stats["fragments"]), {"shells", "slices"})
        self.assertGreater(stats["bytes"]["gpu"], 0)
        self.assertGreater(stats["bytes"]["process_peak"], 0)
        header = (self.dir / "out.exr").read_bytes()[:4096]
        self.assertEqual(header[:4], b"\x76\x2f\x31\x01")
        for channel in (b"depth\0", b"tier\0", b"coverage\0", b"R\0"):
            self.assertIn(channel, header)

    def test_no_litter(self):
        self.assert_done(self.render())
        names = {path.name for path in self.dir.iterdir()}
        self.assertEqual(names, {"height.raw", "height.json", "set", "scene.toml", "out.png"})


if __name__ == "__main__":
    sward_cli.main()
