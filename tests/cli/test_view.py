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

import sward_cli
from sward_cli import CliCase, environment

WIDTH, HEIGHT = 480, 270
POSE = re.compile(r"^-?[\d.]+,-?[\d.]+,-?[\d.]+,-?[\d.]+,-?[\d.]+$", re.MULTILINE)


class XKeyEvent(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("root", ctypes.c_ulong),
                ("subwindow", ctypes.c_ulong), ("time", ctypes.c_ulong), ("x", ctypes.c_int),
                ("y", ctypes.c_int), ("x_root", ctypes.c_int), ("y_root", ctypes.c_int),
                ("state", ctypes.c_uint), ("keycode", ctypes.c_uint), ("same_screen", ctypes.c_int),
                ("pad", ctypes.c_long * 24)]


class Display:
    """One Xvfb, what is on its screen, and a hand on its windows."""

    def __init__(self, folder):
        read, write = os.pipe()
        self.folder = folder
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-nolisten", "tcp",
             "-fbdir", str(folder)], pass_fds=[write], stderr=subprocess.DEVNULL)
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
        pixels = data[begin:begin + header[12] * header[5]]
        return [pixel & 0xffffff for pixel in struct.unpack(f"<{len(pixels) // 4}I", pixels)]

    def colours(self):
        return len(set(self.pixels()))

    def has_panel(self):
        """Its letters are pure white, which no grass and no sky is."""
        return self.pixels().count(0xffffff) > 100

    def windows(self):
        """Mapped top-level windows."""
        root, parent = ctypes.c_ulong(), ctypes.c_ulong()
        children, count = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
        self.x11.XQueryTree(self.connection, ctypes.c_ulong(self.root), ctypes.byref(root),
                            ctypes.byref(parent), ctypes.byref(children), ctypes.byref(count))
        return [children[i] for i in range(count.value)]

    def resize(self, window, width, height):
        self.x11.XResizeWindow(self.connection, ctypes.c_ulong(window), width, height)
        self.x11.XSync(self.connection, 0)

    def send(self, window, kind, mask, code, x=0, y=0, state=0):
        """A key or button event: of these the two have the same layout."""
        self.time += 10
        event = XKeyEvent(type=kind, window=window, root=self.root, same_screen=1, keycode=code, time=self.time,
                          x=x, y=y, state=state)
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
        control = chr(0xffe3)
        self.key(window, control, True)
        self.key(window, key, True, state=4)
        self.key(window, key, False, state=4)
        self.key(window, control, False)

    def point(self, window, x, y):
        self.x11.XWarpPointer(self.connection, ctypes.c_ulong(0), ctypes.c_ulong(window), 0, 0, 0, 0, x, y)
        self.x11.XSync(self.connection, 0)

    def press(self, window, x, y):
        self.point(window, x, y)
        self.send(window, 4, 4, 1, x, y)

    def release(self, window, x, y):
        self.send(window, 5, 8, 1, x, y)


class View(CliCase):
    def setUp(self):
        super().setUp()
        self.scene()
        screen = self.dir / "screen"
        screen.mkdir()
        self.display = Display(screen)
        self.addCleanup(self.display.close)
        self.env = environment(DISPLAY=self.display.name, EGL_PLATFORM=None)

    def view(self, *arguments):
        command = [str(sward_cli.BIN / "sward"), "view", "scene.toml", "--size", f"{WIDTH}x{HEIGHT}", *arguments]
        child = subprocess.Popen(command, cwd=self.dir, env=self.env, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True)
        self.addCleanup(child.communicate)
        self.addCleanup(child.kill)
        return child

    def wait_for(self, what, child, seconds=60):
        pause = threading.Event()
        for _ in range(seconds * 20):
            if what():
                return
            self.assertIsNone(child.poll(), child.stderr.read() if child.poll() is not None else "")
            pause.wait(0.05)
        self.fail("waited in vain")

    def test_frames(self):
        result = self.sward("view", "scene.toml", "--size", "320x180", "--frames", "3", "--fixed-timestep",
                            "0.1", "--debug-gl", env=self.env)
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
        for key in "fkhpr":
            self.display.tap(window, key)
        self.wait_for(lambda: (self.dir / "sward-0001.png").exists(), child)
        self.display.tap(window, "p")
        self.wait_for(lambda: (self.dir / "sward-0002.png").exists(), child)
        child.send_signal(signal.SIGTERM)
        out, err = child.communicate(timeout=30)
        self.assertEqual(child.returncode, 143, err)
        self.assertRegex(out, POSE)
        self.assertEqual([float(n) for n in POSE.search(out).group().split(",")], [3, 2, 1, 45, -10])
        self.assertIn("shaders reloaded", err)
        self.assertNotIn("error: ", err)

    def arrows(self):
        """The arrows in the scene file: keys and values as text."""
        blocks = (self.dir / "scene.toml").read_text().split("[[wind.arrow]]\n")[1:]
        return [dict(line.split(" = ") for line in block.split("\n\n")[0].splitlines()) for block in blocks]

    def frames(self, child, count=3):
        """Waits until the picture has changed so often: the time that the editor shows goes on in each."""
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
        for x, y, colour in ((30, 220, 0x78ff8c), (90, 150, 0xff7828)):
            self.display.press(window, x, y)
            shows(colour)
            self.display.release(window, x, y)
            self.frames(child)
        self.display.command(window, "s")
        self.wait_for(lambda: len(self.arrows()) == 1, child)
        arrow = self.arrows()[0]
        self.assertTrue((self.dir / "scene.toml").read_text().startswith(before), "the rest of the file stays")
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
        _, err = child.communicate(timeout=30)
        self.assertEqual(child.returncode, 143, err)
        self.assertNotIn("error: ", err)
        self.assert_done(self.sward("render", "scene.toml", "-o", "out.png", "--size", "32x18"))

    def test_escape(self):
        child = self.view()
        self.wait_for(lambda: self.display.colours() > 100, child)
        escape = chr(0xff1b)
        self.display.tap(self.display.windows()[-1], escape)
        child.communicate(timeout=30)
        self.assertEqual(child.returncode, 0)


if __name__ == "__main__":
    sward_cli.main()
