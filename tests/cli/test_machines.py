# SPDX-License-Identifier: Apache-2.0
"""One flight on several machines: a master under the keyboard and two that follow it over loopback, one of them late."""

import random
import re
import socket
import subprocess
import threading

import sward_cli
import test_view
from sward_cli import CliCase, environment
from test_feed import udp_sockets
from test_view import ESCAPE, ViewCase

PAGE_UP = chr(0xFF55)


class Seat:
    """A viewer with a display and a working directory of its own."""

    def __init__(self, case, name, *arguments):
        self.case, self.folder, self.count = case, case.dir / name, 0
        (self.folder / "screen").mkdir(parents=True)
        self.display = test_view.Display(self.folder / "screen")
        case.addCleanup(self.display.close)
        env = environment(
            DISPLAY=self.display.name, EGL_PLATFORM=None, XDG_STATE_HOME=self.folder / "state"
        )
        self.child = subprocess.Popen(
            [str(sward_cli.BIN / "sward"), "view", str(case.dir / "scene.toml")]
            + ["--window", "64x36", "--samples", "1", *arguments],
            cwd=self.folder,
            env=env,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        case.addCleanup(self.child.communicate)
        case.addCleanup(self.child.kill)
        self.said = []
        threading.Thread(
            target=lambda: self.said.extend(iter(self.child.stderr.readline, "")), daemon=True
        ).start()

    def wait_for(self, what):
        ViewCase.wait_for(self.case, what, self.child)

    def hears(self, text):
        self.wait_for(lambda: any(text in line for line in self.said))

    def begin(self):
        self.wait_for(lambda: self.display.colours() > 100)
        self.window = self.display.windows()[-1]

    def shot(self):
        """The bytes of a screenshot."""
        self.display.tap(self.window, test_view.F12)
        self.count += 1
        file = self.folder / f"sward-{self.count:04}.png"
        self.wait_for(lambda: file.exists() and file.stat().st_size > 0)
        return file.read_bytes()

    def still(self):
        """The picture once it no longer changes."""
        last = self.shot()
        for _ in range(200):
            now = self.shot()
            if now == last:
                return now
            last = now
        self.case.fail("it goes on")

    def comes_to(self, wanted):
        """Whether it draws that picture, once it has done what it has to do."""
        return any(self.shot() == wanted for _ in range(200))

    def steps(self):
        return (self.folder / "flight.rec").read_text().count("\nstep ")

    def end(self):
        self.display.tap(self.window, ESCAPE)
        self.case.assertEqual(self.child.wait(timeout=300), 0, self.said)


class Machines(CliCase):
    def setUp(self):
        super().setUp()
        # A fan, so that the wind's local window is simulated too.
        self.scene(
            sward_cli.SCENE
            + '[wind]\ncells = 64\n[[wind.source]]\nkind = "fan"\nplace = [4, -6]\n'
            + "strength_mps = 9\nradius_m = 3\n"
        )

    def test_followers_draw_what_the_master_draws(self):
        master = Seat(
            self,
            "master",
            *("--master", "udp:0", "--record", "flight.rec", "--fixed-timestep", "1/20"),
        )
        master.hears("master: listening on udp:127.0.0.1:")
        port = int(re.search(r"127\.0\.0\.1:(\d+)", master.said[0]).group(1))
        self.assertEqual(udp_sockets(master.child.pid), [f"127.0.0.1:{port}"])
        early = Seat(self, "early", "--follow", f"udp:{port}")
        master.begin()
        early.begin()
        first = master.shot()
        master.display.key(master.window, "w", True)
        master.wait_for(lambda: master.steps() >= 24)
        for key in ("]", PAGE_UP, "]"):
            master.display.tap(master.window, key)
        noise, chance = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), random.Random(4)
        for _ in range(500):
            noise.sendto(chance.randbytes(chance.randrange(300)), ("127.0.0.1", port))
        noise.close()
        late = Seat(self, "late", "--follow", f"udp:{port}")
        late.begin()
        master.display.key(master.window, "w", False)
        master.display.tap(master.window, " ")
        wanted = master.still()
        self.assertNotEqual(wanted, first, "it has flown")
        early.display.tap(early.window, "w")  # the master flies
        for seat in (early, late):
            self.assertTrue(seat.comes_to(wanted), seat.folder.name)
        # On a busy machine one may be silent for so long that it is gone, and comes again.
        came = {line.split()[-2] for line in master.said if "follows" in line}
        self.assertEqual(len(came), 2, master.said)
        for seat in (late, early, master):
            seat.end()
            self.assertFalse(any("error: " in line for line in seat.said), seat.said)

    def test_refusals(self):
        taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(taken.close)
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        for code, pieces, arguments in (
            (2, ["--master", "5570", "udp:PORT"], ["--master", "5570"]),
            (2, ["--follow", "udp:0"], ["--follow", "udp:0"]),
            (2, ["--follow"], ["--follow", "udp:5570", "--master", "udp:5571"]),
            (2, ["--follow"], ["--follow", "udp:5570", "--record", "a.rec"]),
            (2, ["--follow"], ["--follow", "udp:5570", "--camera", "road"]),
            (5, ["--master", "a port in use"], ["--master", f"udp:{port}"]),
            (5, ["--follow", "nowhere.invalid"], ["--follow", "udp:nowhere.invalid:5570"]),
        ):
            with self.subTest(arguments):
                self.refuse(code, pieces, "view", "scene.toml", *arguments)


if __name__ == "__main__":
    sward_cli.main()
