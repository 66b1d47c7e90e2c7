# SPDX-License-Identifier: Apache-2.0
"""Faults from outside: no GPU, broken shaders, signals, kill -9, two writers."""

import os
import resource
import shutil
import signal
import threading

import sward_cli
from sward_cli import CliCase, SIZE, environment, temporaries

# A preset whose bake lasts long enough to be hit.
LONG_PRESET = sward_cli.TINY_PRESET.replace("size = 64", "size = 512").replace(
    "variants = 1", "variants = 8"
)


class NoGpu(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def refuse_gpu(self, pieces, **changes):
        self.refuse(
            6,
            pieces,
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--size",
            SIZE,
            env=environment(**changes),
        )

    def test_no_egl(self):
        self.refuse_gpu(["EGL"], __EGL_VENDOR_LIBRARY_DIRS="/nonexistent")

    def test_old_gl(self):
        self.refuse_gpu(["4.5"], MESA_GL_VERSION_OVERRIDE="3.3")

    def test_no_display(self):
        self.refuse(6, ["display", "sward render"], "view", "scene.toml")
        self.refuse(
            6, ["display", "sward render"], "view", "scene.toml", env=environment(DISPLAY=":9876")
        )

    def test_broken_shader(self):
        shaders = self.dir / "shaders"
        shutil.copytree(sward_cli.SOURCE / "shaders", shaders)
        env = environment(SWARD_SHADERS=shaders)
        self.assert_done(self.render(env=env))
        (self.dir / "out.png").unlink()
        broken = shaders / "terrain" / "terrain.frag"
        lines = broken.read_text().splitlines()
        lines.append("this does not compile;")
        broken.write_text("\n".join(lines) + "\n")
        result = self.render(env=env)
        self.assertEqual(result.code, 6, result.err)
        self.assertIn(f"terrain.frag:{len(lines)}", result.err)
        broken.unlink()
        self.refuse_gpu(["terrain.frag"], SWARD_SHADERS=shaders)
        self.assertFalse((self.dir / "out.png").exists())


class Signals(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()
        (self.dir / "long.toml").write_text(LONG_PRESET)

    def end_of(self, child):
        try:
            child.communicate(timeout=300)
        finally:
            child.kill()
        return child.returncode

    def test_render(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with self.subTest(signal=number.name):
                before = sward_cli.snapshot(self.dir)
                child = sward_cli.start(
                    "sward",
                    "render",
                    "scene.toml",
                    "-o",
                    "out.png",
                    "--size",
                    "640x360",
                    "--warm",
                    "10000",
                    cwd=self.dir,
                )
                pause = threading.Event()
                pause.wait(0.8)  # into the frames, or before them: both must end well
                self.assertIsNone(child.poll())
                child.send_signal(number)
                self.assertEqual(self.end_of(child), code)
                self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_texgen(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with self.subTest(signal=number.name):
                before = sward_cli.snapshot(self.dir)
                child = sward_cli.start("texgen", "long.toml", "-o", "made", cwd=self.dir)
                self.assertTrue(sward_cli.interrupt(child, number, lambda: temporaries(self.dir)))
                self.assertEqual(self.end_of(child), code)
                self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_bake_ends_with_sward(self):
        """A signal to sward alone also ends the texgen that it runs."""
        text = sward_cli.SCENE.replace('"set"', '"long.toml"')
        (self.dir / "scene.toml").write_text(text)
        cache = self.dir / "cache"
        child = sward_cli.start(
            "sward",
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--size",
            SIZE,
            cwd=self.dir,
            env=environment(XDG_CACHE_HOME=cache),
        )
        self.assertTrue(sward_cli.interrupt(child, signal.SIGTERM, lambda: temporaries(cache)))
        self.assertEqual(self.end_of(child), 143)
        pause = threading.Event()
        for _ in range(100):
            if not temporaries(cache):
                break
            pause.wait(0.1)
        self.assertEqual(temporaries(cache), {})
        self.assertEqual([p for p in (cache / "sward/sets").iterdir() if p.is_dir()], [])

    def test_killed_baker(self):
        """The texgen that sward runs dies: one line, exit 1, nothing left."""
        (self.dir / "scene.toml").write_text(sward_cli.SCENE.replace('"set"', '"long.toml"'))
        cache = self.dir / "cache"
        child = sward_cli.start(
            "sward",
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--size",
            SIZE,
            "-q",
            cwd=self.dir,
            env=environment(XDG_CACHE_HOME=cache),
        )
        pause = threading.Event()
        for _ in range(3000):
            if temporaries(cache) or child.poll() is not None:
                break
            pause.wait(0.01)
        for baker in (f"/proc/{child.pid}/task/{child.pid}/children",):
            with open(baker, encoding="ascii") as numbers:
                for number in numbers.read().split():
                    os.kill(int(number), signal.SIGKILL)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 1, err)
        lines = err.decode().splitlines()
        self.assertEqual(len(lines), 1, err)
        self.assertIn("signal 9", lines[0])
        self.assertFalse((self.dir / "out.png").exists())

    def test_empty_preset(self):
        """A preset that sets nothing bakes the default meadow, and says so."""
        (self.dir / "empty.toml").write_text("# nothing = here\n\n[patch]\n")
        (self.dir / "scene.toml").write_text(sward_cli.SCENE.replace('"set"', '"empty.toml"'))
        cache = self.dir / "cache"
        child = sward_cli.start(
            "sward",
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--size",
            SIZE,
            cwd=self.dir,
            env=environment(XDG_CACHE_HOME=cache),
        )
        self.assertTrue(sward_cli.interrupt(child, signal.SIGTERM, lambda: temporaries(cache)))
        _, err = child.communicate(timeout=300)
        self.assertIn("warning: ", err.decode())
        self.assertIn("empty.toml: sets nothing", err.decode())

    def test_kill(self):
        """kill -9 leaves a temporary, never half a set; the next run sweeps it."""
        child = sward_cli.start("texgen", "long.toml", "-o", "made", cwd=self.dir)
        self.assertTrue(sward_cli.interrupt(child, signal.SIGKILL, lambda: temporaries(self.dir)))
        self.assertEqual(self.end_of(child), -9)
        self.assertFalse((self.dir / "made").exists())
        self.assertEqual(len(temporaries(self.dir)), 1)
        self.assert_done(self.render())
        self.assertEqual(temporaries(self.dir), {})

    def test_two_writers(self):
        """Two texgens with one output: one complete winner, and nothing beside it."""
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        children = [
            sward_cli.start(
                "texgen", "tiny.toml", "-o", "made", "--no-preview", "--no-volume", cwd=self.dir
            )
            for _ in range(2)
        ]
        self.assertEqual([self.end_of(child) for child in children], [0, 0])
        self.assertEqual(temporaries(self.dir), {})
        text = sward_cli.SCENE.replace('"set"', '"made"')
        (self.dir / "scene.toml").write_text(text)
        self.assert_done(self.render())

    def test_ignored_interrupt(self):
        """Under nohup a hang-up is no reason to end."""

        def ignore():
            signal.signal(signal.SIGHUP, signal.SIG_IGN)

        self.assert_done(self.render(limits=ignore))
        self.assertTrue(os.path.getsize(self.dir / "out.png"))


class Room(CliCase):
    """Little memory, no threads, few file handles: the contract's one line and code, or the work is
    done."""

    def setUp(self):
        super().setUp()
        self.scene()
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)

    @staticmethod
    def commands():
        bake = (
            "texgen",
            "tiny.toml",
            "-o",
            "made/set",
            "-q",
            "--no-preview",
            "--no-volume",
            "--threads",
            "2",
        )
        return [
            ("texgen", "--version"),
            ("sward", "info", "scene.toml"),
            ("sward", "render", "scene.toml", "-o", "out.png", "--size", SIZE),
            bake,
        ]

    def hold(self, codes, limits, prefix=(), env=None):
        """Every command ends with one of the codes, in one line unless it is 0, and leaves nothing
        then."""
        for command in self.commands():
            with self.subTest(command=command[:2]):
                before = sward_cli.snapshot(self.dir)
                result = sward_cli.run(
                    *command, cwd=self.dir, limits=limits, prefix=prefix, env=env
                )
                if result.code == 127 and "shared libraries" in result.err:
                    continue  # not begun: the system's loader speaks
                self.assertIn(result.code, (0, *codes), result.err)
                if result.code == 0:
                    (self.dir / "out.png").unlink(missing_ok=True)
                    shutil.rmtree(self.dir / "made", ignore_errors=True)
                    continue
                self.assertEqual(len(result.err.splitlines()), 1, result.err)
                self.assertTrue(result.err.startswith("error: "), result.err)
                self.assertEqual(sward_cli.snapshot(self.dir), before)

    def test_little_memory(self):
        env = self.own_shaders()
        for most in (400_000, 600_000):
            with self.subTest(kib=most):
                self.hold(
                    {1, 4},
                    lambda: resource.setrlimit(resource.RLIMIT_AS, (most << 10, most << 10)),
                    env=env,
                )

    def test_no_threads(self):
        user = ()
        if os.geteuid() == 0:  # the limit counts for users only
            keep = "+dac_override"
            user = (
                "setpriv",
                "--reuid",
                "64123",
                "--inh-caps",
                keep,
                "--ambient-caps",
                keep,
                "--bounding-set",
                "-all," + keep,
            )
        self.hold({1, 4}, lambda: resource.setrlimit(resource.RLIMIT_NPROC, (1, 1)), prefix=user)

    def test_few_handles(self):
        for most in (4, 6, 9, 12):
            with self.subTest(handles=most):
                self.hold({5}, lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (most, most)))


if __name__ == "__main__":
    sward_cli.main()
