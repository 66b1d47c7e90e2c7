# SPDX-License-Identifier: Apache-2.0
"""Another program's aircraft in the viewer: packets in, the pose and the note, the answer, sockets
that are open and those that are not."""

import math
import re
import signal
import socket
import struct
import subprocess
import threading

import sward_cli
import test_view
from geotiff import geotiff
from sward_cli import CliCase, environment

WIDTH, HEIGHT = 192, 108
SCENE = """\
[terrain]
elevation = "height.tif"
detail_m = 0
[grass]
set = "set"
[wind]
speed_mps = 5
direction_deg = 270
gust = 0
"""


def net_fdm(latitude, longitude, height, roll, pitch, heading, count):
    """Version 24, as it is written down; degrees and metres, standing still."""
    packet = struct.pack(">II3d", 24, 0, math.radians(longitude), math.radians(latitude), height)
    packet += struct.pack(">f3f", 0, math.radians(roll), math.radians(pitch), math.radians(heading))
    packet += bytes(356 - len(packet)) + struct.pack(">I", count)
    return packet + bytes(408 - len(packet))


def udp_sockets(process):
    """Local addresses of a process's UDP sockets, "127.0.0.1:5550"."""
    inodes = set()
    for link in (sward_cli.Path("/proc") / str(process) / "fd").iterdir():
        match = re.fullmatch(r"socket:\[(\d+)\]", str(link.readlink()))
        if match:
            inodes.add(match.group(1))
    found = []
    for table in ("udp", "udp6"):
        for line in (sward_cli.Path("/proc/net") / table).read_text().splitlines()[1:]:
            fields = line.split()
            if fields[9] in inodes:
                address, port = fields[1].split(":")
                quads = (
                    ".".join(str(b) for b in reversed(bytes.fromhex(address)))
                    if table == "udp"
                    else address
                )
                found.append(f"{quads}:{int(port, 16)}")
    return found


class Feed(CliCase):
    def wait_for(self, what, child):
        test_view.ViewCase.wait_for(self, what, child)

    def setUp(self):
        super().setUp()
        self.scene()
        # 640 m of UTM zone 32 at 50 degrees north, rising 5 % to the east.
        geotiff(
            self.dir / "height.tif",
            65,
            65,
            lambda i, j: 100 + 0.5 * i,
            epsg=32632,
            affine=(10, 0, 500000, 0, -10, 5540000),
        )
        screen = self.dir / "screen"
        screen.mkdir()
        self.display = test_view.Display(screen)
        self.addCleanup(self.display.close)
        self.env = environment(DISPLAY=self.display.name, EGL_PLATFORM=None)

    def view(self, *arguments):
        child = subprocess.Popen(
            [
                str(sward_cli.BIN / "sward"),
                "view",
                "scene.toml",
                "--size",
                f"{WIDTH}x{HEIGHT}",
                "--samples",
                "1",
                "--tiers",
                "blades",
                "--blades-distance",
                "1",
                "--density",
                "0",
                *arguments,
            ],
            cwd=self.dir,
            env=self.env,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(child.communicate)
        self.addCleanup(child.kill)
        return child

    def origin(self):
        (self.dir / "scene.toml").write_text(SCENE)
        result = self.sward("info", "scene.toml")
        self.assert_done(result)
        return [float(n) for n in re.search(r"origin +([-\d.]+), ([-\d.]+)", result.out).groups()]

    def check_answer(self, answer, latitude, longitude):
        """An answer to a packet from 100 m north of the origin; returns the ground's height that it
        tells."""
        self.assertEqual(
            (len(answer), answer[:4], struct.unpack(">I", answer[4:8])[0]), (96, b"SWGD", 1)
        )
        time_s, lon, lat, x, z, ground = struct.unpack(">6d", answer[16:64])
        north, east, down, wind_north, wind_east, _ = struct.unpack(">6f", answer[64:88])
        surface, fdm_time = struct.unpack(">II", answer[88:96])
        self.assertGreaterEqual(time_s, 0)
        self.assertAlmostEqual(math.degrees(lat), latitude, places=9)
        self.assertAlmostEqual(math.degrees(lon), longitude, places=9)
        self.assertLess(math.hypot(x, z + 100), 1)
        self.assertAlmostEqual(ground, 116 + 0.05 * x, delta=0.2)
        self.assertAlmostEqual(east / -down, -0.05, delta=0.003)
        self.assertAlmostEqual(north, 0, delta=0.003)
        self.assertAlmostEqual(wind_east, 5, delta=1)
        self.assertAlmostEqual(wind_north, 0, delta=1)
        self.assertEqual(surface, 3)
        self.assertGreater(fdm_time, 0)
        return ground

    def check_horizon(self):
        """The right wing is down: the horizon stands higher on the right, so there is less sky."""
        pixels = self.display.pixels()
        columns = [
            [pixels[row * test_view.WIDTH + i] for row in range(HEIGHT)] for i in (10, WIDTH - 10)
        ]
        sky = [sum((p & 255) > (p >> 8 & 255) for p in column) for column in columns]
        self.assertGreater(sky[0], sky[1] + HEIGHT // 5, sky)

    def test_aircraft(self):
        latitude, longitude = self.origin()
        answers = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(answers.close)
        answers.bind(("127.0.0.1", 0))
        answers.settimeout(600)
        child = self.view(
            "--native-fdm", "udp:0", "--udp-out", f"udp:127.0.0.1:{answers.getsockname()[1]}"
        )
        said, printed = [], []
        for lines, stream in ((said, child.stderr), (printed, child.stdout)):
            threading.Thread(
                target=lambda lines=lines, stream=stream: lines.extend(iter(stream.readline, "")),
                daemon=True,
            ).start()
        heard = lambda text: self.wait_for(lambda: any(text in line for line in said), child)
        heard("listening on udp:127.0.0.1:")
        port = int(re.search(r"127\.0\.0\.1:(\d+)", said[0]).group(1))
        sockets = udp_sockets(child.pid)
        self.assertIn(f"127.0.0.1:{port}", sockets)
        self.assertTrue(
            len(sockets) == 2 and all(s.startswith("127.0.0.1:") for s in sockets), sockets
        )

        stop = threading.Event()

        def send():
            sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            with sender, stranger:
                count = 0
                while not stop.wait(0.02):
                    count += 1
                    sender.sendto(
                        net_fdm(latitude + 100 / 111_000, longitude, 180, 30, -10, 45, count),
                        ("127.0.0.1", port),
                    )
                    sender.sendto(bytes(count % 500), ("127.0.0.1", port))
                    stranger.sendto(
                        net_fdm(latitude, longitude, 500, 0, 0, 0, count), ("127.0.0.1", port)
                    )

        thread = threading.Thread(target=send)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(stop.set)
        heard("packets come in")
        while True:
            answer = answers.recv(2048)
            flags = struct.unpack(">I", answer[12:16])[0]
            if flags == 1:
                break
        ground = self.check_answer(answer, latitude + 100 / 111_000, longitude)

        window = self.display.windows()[-1]
        self.display.tap(
            window,
            "i",
            # in so narrow a window the line wraps over the panel, further the more packets it tells of
        )
        self.wait_for(self.display.has_panel, child)
        self.display.tap(window, "t")
        self.wait_for(lambda: not self.display.has_panel(), child)
        self.check_horizon()
        self.display.tap(window, "k")
        self.wait_for(lambda: printed, child)
        stop.set()
        heard("the stream stands: no packet")
        child.send_signal(signal.SIGTERM)
        self.assertEqual(child.wait(timeout=300), 143, said)
        pose = [float(n) for n in printed[0].split(",")]
        self.assertLess(math.hypot(pose[0], pose[2] + 100), 1)
        self.assertAlmostEqual(pose[1], 180 - ground, delta=0.05)
        self.assertAlmostEqual(pose[3], 45, delta=0.05)
        self.assertAlmostEqual(pose[4], -10, delta=0.01)
        self.assertFalse([line for line in said if line.startswith("error")], said)

    def test_nothing_is_open_unless_asked_for(self):
        child = self.view()
        self.wait_for(self.display.has_panel, child)
        self.assertEqual(udp_sockets(child.pid), [])
        child.send_signal(signal.SIGTERM)
        self.assertEqual(child.wait(timeout=300), 143)

    def test_refusals(self):
        for option, text in (
            ("--native-fdm", "5550"),
            ("--native-fdm", "udp:65536"),
            ("--native-fdm", "tcp:5550"),
            ("--native-fdm", ""),
            ("--udp-out", "udp:5560"),
            ("--udp-out", "udp:somewhere:0"),
            ("--udp-out", "udp:some where:1"),
        ):
            with self.subTest(option=option, text=text):
                self.refuse(
                    2,
                    [option, f'found "{text}"', "expected udp:"],
                    "view",
                    "scene.toml",
                    option,
                    text,
                )
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            port = other.getsockname()[1]
            self.refuse(
                5,
                ["--native-fdm", f"127.0.0.1:{port}", "found a port in use"],
                "view",
                "scene.toml",
                "--native-fdm",
                f"udp:{port}",
            )
        self.refuse(
            5,
            ["--native-fdm", "192.0.2.1:5550"],
            "view",
            "scene.toml",
            "--native-fdm",
            "udp:192.0.2.1:5550",
        )
        # The scene of the other tests lies nowhere on Earth.
        self.refuse(
            2,
            ["--native-fdm", "place on Earth"],
            "view",
            "scene.toml",
            "-q",
            "--native-fdm",
            "udp:0",
            env=self.env,
        )


if __name__ == "__main__":
    sward_cli.main()
