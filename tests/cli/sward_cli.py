# SPDX-License-Identifier: Apache-2.0
"""What the tests of the programs share: running them, a tiny scene, and what a refusal must look
like."""

import fcntl
import json
import math
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("SWARD_SOURCE_DIR", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("SWARD_BIN_DIR", SOURCE / "build/release/bin"))
FULL_BIN = BIN  # stays, where a test sets BIN to another build
WORK = BIN.parent / "cli"  # sets and caches that outlive one test
SIZE = "64x36"
REFUSAL_CPU_S = 2.0  # processor time: the wall clock of a loaded machine says nothing
REFUSAL_MIB = 512

TINY_PRESET = """\
name = "tiny"
seed = 3
[patch]
side_m = 1.0
density_per_m2 = 300.0
variants = 1
[tufts]
share = 0.3
radius_m = [0.01, 0.03]
blades = [3, 6]
[blade]
length_m = [0.15, 0.3]
width_m = [0.004, 0.006]
lean_deg = [0.0, 20.0]
curvature_deg = [5.0, 40.0]
stiffness = [0.4, 0.8]
droop = [0.0, 0.3]
[colour]
root = [0.05, 0.09, 0.02]
tip = [0.08, 0.15, 0.03]
dry = [0.2, 0.17, 0.085]
dry_share = 0.1
variation = 0.2
[light]
kd = 1.0
pd = 1.0
ks = 0.05
ps = 16.0
translucency = 0.35
[texture]
size = 64
layers = 4
slices = 4
levels = 2
far_rays = 1024
"""

SCENE = """\
[terrain]
elevation = "height.raw"
[grass]
set = "set"
[camera.road]
position = [0, 1.7, 0]
[path.roll]
keys = [ { t = 0, position = [0, 2, 10] }, { t = 1, position = [0, 2, -10] } ]
"""


class Result:
    """How a program ended: code (negative: a signal), out, err, processor seconds, largest MiB."""

    def __init__(self, code, out, err, usage):
        self.code, self.out, self.err = code, out, err
        self.cpu_s = usage.ru_utime + usage.ru_stime
        self.mib = usage.ru_maxrss / 1024


def environment(**changes):
    """Software rendering, no display, caches of our own; shaders stay compiled whatever cache a
    test asks for. A value of None removes the
    variable."""
    WORK.mkdir(
        parents=True, exist_ok=True
    )  # Mesa makes one folder, not two: without this every run compiles every shader
    env = dict(
        os.environ,
        LIBGL_ALWAYS_SOFTWARE="1",
        EGL_PLATFORM="surfaceless",
        XDG_CACHE_HOME=str(WORK / "cache"),
        MESA_SHADER_CACHE_DIR=str(WORK / "cache"),
        LC_ALL="C.UTF-8",
    )
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        env.pop(name, None)
    for name, value in changes.items():
        env.pop(name, None)
        if value is not None:
            env[name] = str(value)
    return env


def run(program, *arguments, cwd=None, env=None, prefix=(), limits=None, timeout=600):
    """Runs a program of the build and waits. `prefix`: a command that runs it; `limits`: called in
    the child."""
    command = [*prefix, str(BIN / program), *map(str, arguments)]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = subprocess.Popen(
            command,
            cwd=cwd,
            env=env or environment(),
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            preexec_fn=limits,
        )
        watch = threading.Timer(timeout, child.kill)
        watch.start()
        _, status, usage = os.wait4(child.pid, 0)
        watch.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        return Result(
            child.returncode,
            out.read().decode(errors="replace"),
            err.read().decode(errors="replace"),
            usage,
        )


def without_root():
    """Command prefix under which file permissions count for root too."""
    if os.geteuid() != 0:
        return ()
    return ("setpriv", "--bounding-set", "-dac_override,-dac_read_search", "--")


def write_height(path, side=33, spacing=10.0):
    """Raw posts with a few gentle hills, and their header beside them."""
    posts = [
        20 + 8 * math.sin(i % side / 5) + 5 * math.cos(i // side / 4) for i in range(side * side)
    ]
    path.write_bytes(struct.pack(f"<{len(posts)}f", *posts))
    header = {"width": side, "height": side, "spacing_m": [spacing, spacing]}
    path.with_suffix(".json").write_text(json.dumps(header))


def tiny_set():
    """A small baked set, made once for all tests and again when texgen is newer."""
    WORK.mkdir(parents=True, exist_ok=True)
    target, preset = WORK / "set", WORK / "tiny.toml"
    with open(WORK / "set.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        made = target / "set.json"
        if not made.exists() or made.stat().st_mtime < (FULL_BIN / "texgen").stat().st_mtime:
            preset.write_text(TINY_PRESET)
            result = run(
                FULL_BIN / "texgen", preset, "-o", target, "-q", "--no-volume", "--no-preview"
            )
            assert result.code == 0, result.err
    return target


def temporaries(folder):
    """Files and folders below a folder that a program is still writing, each with how many entries
    it has; what goes while we look is not an
    error, as it is for Path.rglob."""
    found = {}
    for place, folders, files in os.walk(folder):
        if Path(place).name.startswith(".sward-"):
            found[Path(place)] = len(folders) + len(files)
        found.update({Path(place, name): 0 for name in files if name.startswith(".sward-")})
    return found


def snapshot(folder):
    """Every name under a folder with what identifies its content."""
    names = {}
    for path in sorted(Path(folder).rglob("*")):
        info = path.lstat()
        names[str(path.relative_to(folder))] = (info.st_mode, info.st_size, info.st_mtime_ns)
    return {
        name: value if not Path(folder, name).is_dir() else value[0]
        for name, value in names.items()
    }


def copy_what_stays(source, target):
    """Copies a file of a folder that other programs are working in."""
    try:
        shutil.copyfile(source, target)
    except FileNotFoundError:
        pass


class CliCase(unittest.TestCase):
    """A test in a folder of its own, `self.dir`, in which `scene()` makes a scene."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sward-cli-")
        self.addCleanup(folder.cleanup)
        self.dir = Path(folder.name)

    def scene(self, text=SCENE, name="scene.toml"):
        write_height(self.dir / "height.raw")
        if not (self.dir / "set").exists():
            shutil.copytree(tiny_set(), self.dir / "set")
        (self.dir / name).write_text(text)
        return self.dir / name

    def own_shaders(self):
        """An environment with a copy of the compiled shaders: for a program that must not write
        them to the end."""
        folder = tempfile.TemporaryDirectory(prefix="sward-shaders-")
        self.addCleanup(folder.cleanup)
        kept = WORK / "cache/mesa_shader_cache"
        if kept.exists():
            shutil.copytree(
                kept,
                Path(folder.name) / kept.name,
                ignore=shutil.ignore_patterns("*.tmp"),
                copy_function=copy_what_stays,
            )
        return environment(MESA_SHADER_CACHE_DIR=folder.name)

    def sward(self, *arguments, **options):
        return run("sward", *arguments, cwd=self.dir, **options)

    def render(self, *arguments, **options):
        """A small picture of the scene here, out.png unless the arguments say otherwise."""
        output = () if "-o" in arguments else ("-o", "out.png")
        size = () if "--size" in arguments else ("--size", SIZE)
        return self.sward("render", "scene.toml", *output, *size, *arguments, **options)

    def assert_done(self, result):
        self.assertEqual(result.code, 0, result.err)

    def assert_refusal(self, result, code, *pieces):
        """One line `error: ...` that holds every piece, this exit code, soon and small."""
        self.assertEqual(result.code, code, result.err)
        lines = result.err.splitlines()
        self.assertEqual(len(lines), 1, result.err)
        self.assertTrue(lines[0].startswith("error: "), lines[0])
        for piece in pieces:
            self.assertIn(piece, lines[0])
        self.assertEqual(result.out, "")
        self.assertLess(result.cpu_s, REFUSAL_CPU_S)
        self.assertLess(result.mib, REFUSAL_MIB)

    def refuse(self, code, pieces, *arguments, program="sward", **options):
        """Runs a program here; it must refuse and leave the folder as it was."""
        before = snapshot(self.dir)
        result = run(program, *arguments, cwd=self.dir, **options)
        self.assert_refusal(result, code, *pieces)
        self.assertEqual(snapshot(self.dir), before)


def interrupt(child, number, ready, timeout=600):
    """Sends a signal once `ready()` holds; returns whether the program was still running then."""
    waited = 0.0
    pause = threading.Event()
    while not ready() and child.poll() is None and waited < timeout:
        pause.wait(0.002)
        waited += 0.002
    alive = child.poll() is None
    if alive:
        child.send_signal(number)
    return alive


def start(program, *arguments, cwd=None, env=None):
    """Starts a program with the default answer to SIGINT, whatever this process inherited."""
    return subprocess.Popen(
        [str(BIN / program), *map(str, arguments)],
        cwd=cwd,
        env=env or environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def main():
    """Runs the tests of a file. A skip ends with 77, which ctest counts as skipped: none goes
    unseen."""
    program = unittest.main(exit=False, verbosity=2)
    if not program.result.wasSuccessful() or program.result.testsRun == 0:
        sys.exit(1)
    sys.exit(77 if program.result.skipped else 0)
