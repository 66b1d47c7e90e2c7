# SPDX-License-Identifier: Apache-2.0
"""The viewer on a virtual display: it draws, listens to keys, and survives being resized."""

import ctypes
import ctypes.util
import os
import re
import signal
import struct
import subprocess
import threading
import time
from pathlib import Path

import sward_cli
from sward_cli import CliCase, environment

WIDTH, HEIGHT = 480, 270
F11, F12, ESCAPE = chr(0xFFC8), chr(0xFFC9), chr(0xFF1B)
BAKE = sward_cli.TINY_PRESET.replace("far_rays = 1024", "far_rays = 1048576")  # a minute and more
POSE = re.compile(r"^-?[\d.]+,-?[\d.]+,-?[\d.]+,-?[\d.]+,-?[\d.]+$", re.MULTILINE)


def status_of(pid):
    """State and parent of a process; none once it is gone."""
    try:
        return (Path("/proc") / str(pid) / "stat").read_text().rpartition(")")[2].split()[:2]
    except OSError:
        return ["X", "0"]


def runs(pid):
    return status_of(pid)[0] not in "XZ"


def children(pid):
    return [
        int(entry.name)
        for entry in Path("/proc").iterdir()
        if entry.name.isdigit() and status_of(entry.name)[1] == str(pid)
    ]


class XKeyEvent(ctypes.Structure):
    _fields_ = [
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("root", ctypes.c_ulong),
        ("subwindow", ctypes.c_ulong),
        ("time", ctypes.c_ulong),
        ("x", ctypes.c_int),
        ("y", ctypes.c_int),
        ("x_root", ctypes.c_int),
        ("y_root", ctypes.c_int),
        ("state", ctypes.c_uint),
        ("keycode", ctypes.c_uint),
        ("same_screen", ctypes.c_int),
        ("pad", ctypes.c_long * 24),
    ]


class Display:
    """One Xvfb, what is on its screen, and a hand on its windows."""

    def __init__(self, folder):
        read, write = os.pipe()
        self.folder = folder
        self.server = subprocess.Popen(
            [
                "Xvfb",
                "-displayfd",
                str(write),
                "-screen",
                "0",
                f"{WIDTH}x{HEIGHT}x24",
                "-nolisten",
                "tcp",
                "-fbdir",
                str(folder),
            ],
            pass_fds=[write],
            stderr=subprocess.DEVNULL,
        )
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ":" + pipe.readline().strip()
        self.x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self.connection = ctypes.c_void_p(self.x11.XOpenDisplay(self.name.encode()))
        self.root = self.x11.XDefaultRootWindow(self.connection)
        self.time = 0  # of key events: GLFW drops one that is not later than the last

    def close(self):
        self.x11.XCloseDisplay(self.connection)
        self.server.terminate()
        self.server.wait()

    def pixels(self):
        """The screen, from Xvfb's own XWD file."""
        data = (self.folder / "Xvfb_screen0").read_bytes()
        header = struct.unpack(">25I", data[:100])
        begin = header[0] + 12 * header[19]
        pixels = data[begin : begin + header[12] * header[5]]
        return [pixel & 0xFFFFFF for pixel in struct.unpack(f"<{len(pixels) // 4}I", pixels)]

    def colours(self):
        return len(set(self.pixels()))

    def has_panel(self):
        """Its letters are pure white, which no grass and no sky is."""
        return self.pixels().count(0xFFFFFF) > 100

    def windows(self):
        """Mapped top-level windows."""
        root, parent = ctypes.c_ulong(), ctypes.c_ulong()
        children, count = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
        self.x11.XQueryTree(
            self.connection,
            ctypes.c_ulong(self.root),
            ctypes.byref(root),
            ctypes.byref(parent),
            ctypes.byref(children),
            ctypes.byref(count),
        )
        return [children[i] for i in range(count.value)]

    def geometry(self, window):
        """x, y, width, height of a window on the screen."""
        root = ctypes.c_ulong()
        numbers = [
            ctypes.c_int(),
            ctypes.c_int(),
            ctypes.c_uint(),
            ctypes.c_uint(),
            ctypes.c_uint(),
            ctypes.c_uint(),
        ]
        self.x11.XGetGeometry(
            self.connection, ctypes.c_ulong(window), ctypes.byref(root), *map(ctypes.byref, numbers)
        )
        return tuple(number.value for number in numbers[:4])

    def resize(self, window, width, height):
        self.x11.XResizeWindow(self.connection, ctypes.c_ulong(window), width, height)
        self.x11.XSync(self.connection, 0)

    def send(self, window, kind, mask, code, x=0, y=0, state=0):
        """A key or button event: of these the two have the same layout."""
        self.time += 10
        event = XKeyEvent(
            type=kind,
            window=window,
            root=self.root,
            same_screen=1,
            keycode=code,
            time=self.time,
            x=x,
            y=y,
            state=state,
        )
        self.x11.XSendEvent(self.connection, ctypes.c_ulong(window), 0, mask, ctypes.byref(event))
        self.x11.XSync(self.connection, 0)

    def key(self, window, key, down, state=0):
        code = self.x11.XKeysymToKeycode(self.connection, ctypes.c_ulong(ord(key)))
        self.send(window, *((2, 1) if down else (3, 2)), code, state=state)

    def tap(self, window, key):
        self.key(window, key, True)
        self.key(window, key, False)

    def command(self, window, key):
        """Ctrl and a letter."""
        control = chr(0xFFE3)
        self.key(window, control, True)
        self.key(window, key, True, state=4)
        self.key(window, key, False, state=4)
        self.key(window, control, False)

    def point(self, window, x, y):
        self.x11.XWarpPointer(
            self.connection, ctypes.c_ulong(0), ctypes.c_ulong(window), 0, 0, 0, 0, x, y
        )
        self.x11.XSync(self.connection, 0)

    def press(self, window, x, y):
        self.point(window, x, y)
        self.send(window, 4, 4, 1, x, y)

    def release(self, window, x, y):
        self.send(window, 5, 8, 1, x, y)


class ViewCase(CliCase):
    """A scene and a display of its own."""

    def setUp(self):
        super().setUp()
        self.scene()
        screen = self.dir / "screen"
        screen.mkdir()
        self.display = Display(screen)
        self.addCleanup(self.display.close)
        self.env = environment(
            DISPLAY=self.display.name, EGL_PLATFORM=None, XDG_STATE_HOME=self.dir / "state"
        )

    def view(self, *arguments):
        size = () if "--window" in arguments else ("--size", f"{WIDTH}x{HEIGHT}")
        command = [str(sward_cli.BIN / "sward"), "view", "scene.toml", *size, *arguments]
        child = subprocess.Popen(
            command,
            cwd=self.dir,
            env=self.env,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(child.communicate)
        self.addCleanup(child.kill)
        return child

    def wait_for(self, what, child, seconds=600):
        """A busy machine that has no shader of it yet builds them for minutes."""
        pause = threading.Event()
        for _ in range(seconds * 20):
            if what():
                return
            self.assertIsNone(child.poll(), child.stderr.read() if child.poll() is not None else "")
            pause.wait(0.05)
        self.fail("waited in vain")


class View(ViewCase):
    def test_frames(self):
        result = self.sward(
            "view",
            "scene.toml",
            "--size",
            "320x180",
            "--frames",
            "3",
            "--fixed-timestep",
            "0.1",
            "--debug-gl",
            env=self.env,
        )
        self.assert_done(result)
        self.assertEqual(result.out, "")

    def test_flight(self):
        child = self.view("--camera", "3,2,1,45,-10")
        self.wait_for(lambda: self.display.colours() > 100, child)
        self.wait_for(self.display.has_panel, child)
        window = self.display.windows()[-1]
        self.display.tap(window, "t")
        self.wait_for(lambda: not self.display.has_panel(), child)
        self.assertGreater(self.display.colours(), 100)
        for width, height in ((200, 100), (1, 1), (WIDTH, HEIGHT), (3000, 20), (300, 200)):
            self.display.resize(window, width, height)
        for key in "fkh" + F12 + "r":
            self.display.tap(window, key)
        self.wait_for(lambda: (self.dir / "sward-0001.png").exists(), child)
        self.display.tap(window, F12)
        self.wait_for(lambda: (self.dir / "sward-0002.png").exists(), child)
        self.assertEqual(
            (self.dir / "state/sward/recent-scenes").read_text(), f"{self.dir / 'scene.toml'}\n"
        )
        child.send_signal(signal.SIGTERM)
        out, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 143, err)
        self.assertRegex(out, POSE)
        self.assertEqual(
            [float(n) for n in POSE.search(out).group().split(",")], [3, 2, 1, 45, -10]
        )
        self.assertIn("shaders reloaded", err)
        self.assertNotIn("error: ", err)

    def arrows(self):
        """The arrows in the scene file: keys and values as text."""
        blocks = (self.dir / "scene.toml").read_text().split("[[wind.arrow]]\n")[1:]
        return [
            dict(line.split(" = ") for line in block.split("\n\n")[0].splitlines())
            for block in blocks
        ]

    def frames(self, child, count=3):
        """Waits until the picture has changed so often: the time that the editor shows goes on in
        each."""
        for _ in range(count):
            before = self.display.pixels()
            self.wait_for(lambda: self.display.pixels() != before, child)

    def test_arrow_editor(self):
        before = sward_cli.SCENE + "\n[wind]\ncells = 64\n"
        self.scene(before)
        child = self.view("--camera", "0,14,0,0,-60", "--fixed-timestep", "0.1", "--samples", "1")
        self.wait_for(self.display.has_panel, child)
        window = self.display.windows()[-1]
        self.display.tap(window, "t")
        self.wait_for(lambda: not self.display.has_panel(), child)
        self.display.tap(window, "g")
        self.wait_for(self.display.has_panel, child)
        shows = lambda colour: self.wait_for(lambda: self.display.pixels().count(colour) > 5, child)
        # Left of the editor's own window: a root that waits, then a selected arrow.
        for x, y, colour in ((30, 220, 0x78FF8C), (90, 150, 0xFF7828)):
            self.display.press(window, x, y)
            shows(colour)
            self.display.release(window, x, y)
            self.frames(child)
        self.display.command(window, "s")
        self.wait_for(lambda: len(self.arrows()) == 1, child)
        arrow = self.arrows()[0]
        self.assertTrue(
            (self.dir / "scene.toml").read_text().startswith(before), "the rest of the file stays"
        )
        self.assertEqual(arrow["id"], '"arrow-1"')
        # Dragged to the left, the tip lies further west; undone, it is back where it was.
        self.display.press(window, 90, 150)
        self.frames(child)
        self.display.point(window, 40, 150)
        self.frames(child)
        self.display.release(window, 40, 150)
        self.frames(child)
        self.display.command(window, "s")
        self.wait_for(lambda: self.arrows()[0] != arrow, child)
        east = lambda a: float(a["tip"].strip("[]").split(",")[0])
        self.assertLess(east(self.arrows()[0]), east(arrow) - 0.5)
        self.assertEqual(self.arrows()[0]["root"], arrow["root"])
        self.frames(child)
        self.display.command(window, "z")
        self.frames(child)
        self.display.command(window, "s")
        self.wait_for(lambda: self.arrows() == [arrow], child)
        child.send_signal(signal.SIGTERM)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 143, err)
        self.assertNotIn("error: ", err)
        self.assert_done(self.sward("render", "scene.toml", "-o", "out.png", "--size", "32x18"))

    def shot(self, child, window, number):
        """The bytes of the next screenshot."""
        self.display.tap(window, F12)
        file = self.dir / f"sward-{number:04}.png"
        self.wait_for(file.exists, child)
        return file.read_bytes()

    def test_cockpit(self):
        """Time stands and goes a step, the day goes on, cameras have keys; the window is where it
        should be."""
        self.scene(
            sward_cli.SCENE.replace(
                "position = [0, 1.7, 0]",
                "position = [0, 1.7, 0]\nyaw_deg = 90\npitch_deg = -20\n[camera.aloft]\nposition = [5, 40, 6]",
            )
        )
        child = self.view("--window", "160x90+40+30", "--fixed-timestep", "0.1", "--samples", "1")
        self.wait_for(lambda: self.display.colours() > 100, child)
        window = self.display.windows()[-1]
        self.assertEqual(self.display.geometry(window), (40, 30, 160, 90))
        self.assertEqual(set(self.display.pixels()[: WIDTH * 30]), {0}, "nothing above it")
        self.display.tap(window, " ")
        still = [self.shot(child, window, number) for number in (1, 2)]
        self.assertEqual(still[0], still[1], "time stands")
        for key in "..":
            self.display.tap(window, key)
        stepped = [self.shot(child, window, number) for number in (3, 4)]
        self.assertNotEqual(stepped[0], still[1], "a step of time")
        self.assertEqual(stepped[0], stepped[1], "and it stands again")
        for key in "]]]]":
            self.display.tap(window, key)
        self.assertNotEqual(
            self.shot(child, window, 5), stepped[1], "an hour later the sun is elsewhere"
        )
        self.display.tap(window, "p")
        self.assertNotEqual(
            self.shot(child, window, 6), self.shot(child, window, 7), "time goes on"
        )
        for key in "1k2k9k":  # by name: aloft, road; the ninth is none
            self.display.tap(window, key)
        self.display.tap(window, F11)
        self.wait_for(lambda: self.display.geometry(window) == (0, 0, WIDTH, HEIGHT), child)
        self.display.tap(window, F11)
        self.wait_for(lambda: self.display.geometry(window) == (40, 30, 160, 90), child)
        self.display.tap(window, ESCAPE)
        out, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0, err)
        poses = [[float(n) for n in line.split(",")] for line in out.splitlines()]
        self.assertEqual(poses, [[5, 40, 6, 0, 0], [0, 1.7, 0, 90, -20], [0, 1.7, 0, 90, -20]])
        self.assertNotIn("error: ", err)

    def test_window_answers_while_a_set_is_baked(self):
        self.scene(sward_cli.SCENE.replace('"set"', '"slow.toml"'))
        (self.dir / "slow.toml").write_text(BAKE)
        self.env["XDG_CACHE_HOME"] = str(self.dir / "cache")
        child = self.view()
        self.wait_for(
            lambda: self.display.windows() and children(child.pid) and self.display.has_panel(),
            child,
        )
        (baker,) = children(child.pid)
        before = self.display.pixels()
        self.wait_for(lambda: self.display.pixels() != before, child)  # it says that it goes on
        self.display.tap(self.display.windows()[-1], ESCAPE)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0, err)
        end = time.monotonic() + 60
        while runs(baker) and time.monotonic() < end:
            time.sleep(0.05)
        self.assertFalse(runs(baker), "texgen was told to end")
        self.assertEqual(sward_cli.temporaries(self.dir / "cache"), {})

    def test_a_kept_flight_is_the_same_at_any_rate(self):
        """Flown with the keyboard, kept, drawn again at 30 and at 144 pictures a second, and in the
        viewer."""
        child = self.view(
            "--window",
            "64x36",
            "--record",
            "flight.rec",
            "--fixed-timestep",
            "1/45",
            "--samples",
            "1",
        )
        self.wait_for(lambda: self.display.colours() > 100, child)
        window = self.display.windows()[-1]
        self.display.key(window, "w", True)
        steps = lambda: (self.dir / "flight.rec").read_text().count("\nstep ")
        self.wait_for(lambda: steps() >= 20, child)
        self.display.tap(window, "]")
        self.display.key(window, "w", False)
        self.wait_for(lambda: steps() >= 100, child)  # it is flushed by 60
        self.display.tap(window, ESCAPE)
        _, err = child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0, err)
        lines = [line.split() for line in (self.dir / "flight.rec").read_text().splitlines()]
        flown = [line for line in lines if line[0] == "step"]
        self.assertLess(float(flown[-1][3]), float(flown[0][3]) - 0.5, "it has flown north")
        self.assertEqual(len([line for line in lines if line[0] == "sun"]), 1)
        for rate in (30, 144):
            self.assert_done(
                self.render(
                    "--replay",
                    "flight.rec",
                    "-o",
                    f"{rate}-%d.png",
                    "--fixed-timestep",
                    f"1/{rate}",
                    "--time",
                    "0.25",
                    "--frames",
                    f"0:{rate // 6}",
                    "--samples",
                    "1",
                )
            )
        pictures = [
            [(self.dir / f"{rate}-{rate // 6 * i}.png").read_bytes() for i in range(2)]
            for rate in (30, 144)
        ]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0][0], pictures[0][1])
        # The viewer, at the end of it.
        self.assert_done(
            self.render(
                "--replay",
                "flight.rec",
                "--time",
                str((len(flown) - 1) / 60),
                "--frames",
                "0:0",
                "-o",
                "end-%d.png",
                "--samples",
                "1",
            )
        )
        child = self.view(
            "--window",
            "64x36",
            "--replay",
            "flight.rec",
            "--fixed-timestep",
            "0.25",
            "--samples",
            "1",
        )
        self.wait_for(lambda: self.display.colours() > 100, child)
        window = self.display.windows()[-1]
        ends = [self.shot(child, window, 1)]
        while len(ends) < 2 or ends[-1] != ends[-2]:
            ends.append(self.shot(child, window, len(ends) + 1))
        self.assertEqual(ends[-1], (self.dir / "end-0.png").read_bytes())
        self.display.tap(window, ESCAPE)
        child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0)

    def test_bad_values(self):
        (self.dir / "torn.rec").write_text("sward-record 1\nstep 1 2\n")
        (self.dir / "none.rec").mkdir()
        (self.dir / "boat.toml").write_text("mass_kg = 900\n")
        for code, pieces, arguments in (
            (2, ["--window", "800", "WIDTHxHEIGHT"], ["--window", "800"]),
            (2, ["--window", "WIDTHxHEIGHT+X+Y"], ["--window", "80x60+1"]),
            (4, ["--window", "16384"], ["--window", "99999x60"]),
            (2, ["--window"], ["--window", "80x60", "--size", "80x60"]),
            (2, ["--replay"], ["--replay", "a", "--record", "b"]),
            (2, ["--fixed-timestep", "fraction"], ["--fixed-timestep", "1/0"]),
            (3, ["torn.rec:2", "words"], ["--replay", "torn.rec"]),
            (2, ["--drive", "car, tractor"], ["--drive", "submarine"]),
            (2, ["--tyres-on"], ["--tyres-on", "road"]),
            (3, ["boat.toml", "front"], ["--drive", "./boat.toml"]),
            (5, ["missing.rec"], ["--replay", "missing.rec"]),
            (5, ["none.rec"], ["--record", "none.rec"]),
            (5, ["nowhere"], ["--record", "nowhere/flight.rec"]),
            (5, ["height2.tif"], ["height2.tif"]),
        ):
            with self.subTest(arguments):
                scene = [] if arguments[0].endswith(".tif") else ["scene.toml"]
                result = self.sward("view", *scene, *arguments, env=self.env)
                self.assertEqual(result.code, code, result.err)
                for piece in pieces:
                    self.assertIn(piece, result.err)
                self.assertEqual(len(result.err.splitlines()), 1, result.err)

    def test_escape(self):
        child = self.view()
        self.wait_for(lambda: self.display.colours() > 100, child)
        self.display.tap(self.display.windows()[-1], ESCAPE)
        child.communicate(timeout=300)
        self.assertEqual(child.returncode, 0)


if __name__ == "__main__":
    sward_cli.main()
