# SPDX-License-Identifier: Apache-2.0
"""What can go wrong around texgen: signals and kill -9 at any moment, full disks, closed
directories, its own input as
output. The old set stays, or the new one is whole."""

import resource
import shutil
import signal
import subprocess
import threading
import time

import sward_cli
from sward_cli import CliCase

# Long enough to be hit anywhere, short enough to be baked many times.
PRESET = sward_cli.TINY_PRESET.replace("size = 64", "size = 128").replace(
    "variants = 1", "variants = 2"
)


class FaultCase(CliCase):
    def setUp(self):
        super().setUp()
        (self.dir / "tiny.toml").write_text(PRESET)
        self.out = self.dir / "out"
        self.out.mkdir()

    def texgen(self, *arguments, **options):
        return sward_cli.run("texgen", *arguments, cwd=self.dir, **options)

    def start(self, *arguments):
        return sward_cli.start("texgen", "tiny.toml", "-o", "out/set", *arguments, cwd=self.dir)

    def end_of(self, child):
        try:
            child.communicate(timeout=300)
        finally:
            child.kill()
        return child.returncode

    def temporaries(self):
        return sward_cli.temporaries(self.out)

    def content(self, name="set"):
        return {path.name: path.read_bytes() for path in (self.out / name).iterdir()}

    def old_set(self):
        """A set of another seed under the final name."""
        self.assert_done(
            self.texgen(
                "tiny.toml", "-o", "out/set", "-q", "--seed", "9", "--no-preview", "--no-volume"
            )
        )
        return self.content()


class Signals(FaultCase):
    def bake_seconds(self):
        start = time.monotonic()
        self.assert_done(self.texgen("tiny.toml", "-o", "out/set", "-q"))
        shutil.rmtree(self.out / "set")
        return time.monotonic() - start

    def test_interrupt_leaves_nothing(self):
        """At moments over the whole bake, and while files are written; with an old set in place and
        without."""
        whole = self.bake_seconds()
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            for share in (0.1, 0.5, 0.9):
                with self.subTest(signal=number.name, share=share):
                    before = sward_cli.snapshot(self.dir)
                    child = self.start()
                    threading.Event().wait(whole * share)
                    if child.poll() is None:
                        child.send_signal(number)
                    self.end_of(child)
                    if (
                        self.out / "set"
                        # a faster run than the first, or a signal after the set was in place: whole
                        # then
                    ).exists():
                        self.assertIn(child.returncode, (0, code))
                        self.assert_done(self.texgen("verify", "out/set", "-q"))
                        shutil.rmtree(self.out / "set")
                        continue
                    # A signal that comes before main() ends any program by itself.
                    self.assertIn(child.returncode, (code, -number) if share == 0.1 else (code,))
                    self.assertEqual(sward_cli.snapshot(self.dir), before)
        old = self.old_set()
        child = self.start()
        self.assertTrue(sward_cli.interrupt(child, signal.SIGINT, self.temporaries))
        self.assertEqual(self.end_of(child), 130)
        self.assertTrue(self.content() == old)
        self.assertEqual(self.temporaries(), {})

    def test_kill_at_any_moment(self):
        """kill -9: the final name is absent, old or complete; what is left over is swept by the
        next run."""
        old = self.old_set()
        whole = self.bake_seconds_over(old)
        ended = set()
        for step in range(6):
            with self.subTest(step=step):
                child = self.start()
                if step < 3:  # spread over the bake
                    threading.Event().wait(whole * (0.2 + 0.3 * step))
                    child.kill()
                else:  # while the files are written
                    sward_cli.interrupt(
                        child,
                        signal.SIGKILL,
                        lambda: any(entries > step - 3 for entries in self.temporaries().values()),
                    )
                ended.add(self.end_of(child))
                made = self.content()
                if made != old:
                    self.assert_done(self.texgen("verify", "out/set", "-q"))
        self.assertIn(-9, ended)
        self.assert_done(
            self.texgen("tiny.toml", "-o", "out/set", "-q", "--no-preview", "--no-volume")
        )
        self.assertEqual(self.temporaries(), {})
        self.assertEqual([path.name for path in self.out.iterdir()], ["set"])

    def bake_seconds_over(self, old):
        start = time.monotonic()
        self.assert_done(self.texgen("tiny.toml", "-o", "out/other", "-q"))
        shutil.rmtree(self.out / "other")
        self.assertTrue(self.content() == old)
        return time.monotonic() - start


class Places(FaultCase):
    def test_full_disk(self):
        """By a limit on the size of a file, which every user may set: each of the set's files in
        turn is the one that fails."""
        old = self.old_set()
        for most in (1000, 20_000, 60_000, 150_000):
            with self.subTest(bytes=most):

                def limit():
                    resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

                result = self.texgen("tiny.toml", "-o", "out/set", "-q", limits=limit)
                self.assertEqual(result.code, 5, result.err)
                self.assertEqual(len(result.err.splitlines()), 1, result.err)
                self.assertIn("out/set", result.err)
                self.assertTrue(self.content() == old)
                self.assertEqual([path.name for path in self.out.iterdir()], ["set"])

    def test_full_file_system(self):
        """A file system of half a megabyte, where this machine lets us mount one; the limit above
        stands for it elsewhere."""
        if (
            subprocess.run(
                ["mount", "-t", "tmpfs", "-o", "size=512k", "tmpfs", str(self.out)],
                capture_output=True,
            ).returncode
            != 0
        ):
            return
        try:
            result = self.texgen("tiny.toml", "-o", "out/set", "-q")
            self.assertEqual(result.code, 5, result.err)
            self.assertEqual(list(self.out.iterdir()), [])
        finally:
            subprocess.run(["umount", str(self.out)], check=True)

    def test_closed_directory(self):
        old = self.old_set()
        self.out.chmod(0o555)
        try:
            self.refuse(
                5,
                ["out/set", "writable"],
                "tiny.toml",
                "-o",
                "out/set",
                program="texgen",
                prefix=sward_cli.without_root(),
            )
            self.refuse(
                5,
                ["out/new", "writable"],
                "tiny.toml",
                "-o",
                "out/new",
                program="texgen",
                prefix=sward_cli.without_root(),
            )
        finally:
            self.out.chmod(0o755)
        self.assertTrue(self.content() == old)

    def test_output_over_input(self):
        """The preset, a directory that holds it, and anything that is not a set, are never
        replaced."""
        self.refuse(5, ["tiny.toml"], "tiny.toml", "-o", "tiny.toml", program="texgen")
        self.refuse(5, ["tiny.toml"], "tiny.toml", "-o", ".", program="texgen")
        self.old_set()
        shutil.copy(self.dir / "tiny.toml", self.out / "set/tiny.toml")
        self.refuse(
            5, ["out/set", "tiny.toml"], "out/set/tiny.toml", "-o", "out/set", program="texgen"
        )
        self.refuse(5, ["out"], "tiny.toml", "-o", "out", program="texgen")
        self.refuse(5, ["/dev/full"], "tiny.toml", "-o", "/dev/full", program="texgen")
        (self.dir / "loop").symlink_to("loop")
        self.refuse(5, ["loop"], "tiny.toml", "-o", "loop", program="texgen")

    def test_old_set_is_replaced(self):
        old = self.old_set()
        (self.out / "set/set.json").write_text("damaged")
        self.assert_done(
            self.texgen("tiny.toml", "-o", "out/set/", "-q", "--no-preview", "--no-volume")
        )
        self.assertFalse(self.content() == old)
        self.assert_done(self.texgen("verify", "out/set", "-q"))

    def test_report_to_a_full_device(self):
        """A report that cannot be written is an error, not silence."""
        with open("/dev/full", "wb") as full:
            result = subprocess.run(
                [str(sward_cli.BIN / "texgen"), "tiny.toml", "-o", "out/set", "--dry-run"],
                cwd=self.dir,
                stdout=full,
                stderr=subprocess.PIPE,
            )
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertIn(b"standard output", result.stderr)


if __name__ == "__main__":
    sward_cli.main()
