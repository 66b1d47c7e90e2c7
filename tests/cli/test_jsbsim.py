# SPDX-License-Identifier: Apache-2.0
"""A real JSBSim flies for a minute and sends net_fdm by its own output: the feed's aircraft is
where JSBSim's properties say it is.

test_jsbsim.py                 as fast as it goes
test_jsbsim.py --real-time     by the clock, and what is drawn between packets too; prints figures
"""

import bisect
import math
import subprocess
import sys
import threading
import time

import sward_cli

sys.path.insert(0, str(sward_cli.SOURCE / "scripts"))
import jsbsim_flight  # noqa: E402

ELEVATION = sward_cli.SOURCE / "terrains/jacksboro/height.tif"
ORIGIN = (36.5895833333, -84.2458333333)  # of its frame: the raster's middle, as `sward info` says
START = (36.66, -84.13, 900)  # 13 km off, where the frame's north leans
SECONDS = 60
MOST_M, MOST_DEG = 0.05, 0.01  # half a metre and a tenth of a degree is what it must hold
AHEAD = 12  # steps of JSBSim: a tenth of a second
MOST_AHEAD_M, MOST_AHEAD_DEG = 0.5, 2.0

WGS84_A, WGS84_F = 6378137.0, 1 / 298.257223563


def inverse(latitude1, longitude1, latitude2, longitude2):
    """Vincenty's inverse problem: distance (m) and azimuth at the first point (radians)."""
    b = WGS84_A * (1 - WGS84_F)
    u1, u2 = (
        math.atan((1 - WGS84_F) * math.tan(math.radians(phi))) for phi in (latitude1, latitude2)
    )
    length = lam = math.radians(longitude2 - longitude1)
    for _ in range(100):
        sin_sigma = math.hypot(
            math.cos(u2) * math.sin(lam),
            math.cos(u1) * math.sin(u2) - math.sin(u1) * math.cos(u2) * math.cos(lam),
        )
        cos_sigma = math.sin(u1) * math.sin(u2) + math.cos(u1) * math.cos(u2) * math.cos(lam)
        sigma = math.atan2(sin_sigma, cos_sigma)
        sin_alpha = math.cos(u1) * math.cos(u2) * math.sin(lam) / sin_sigma
        cos2_alpha = 1 - sin_alpha**2
        cos_2m = cos_sigma - 2 * math.sin(u1) * math.sin(u2) / cos2_alpha
        c = WGS84_F / 16 * cos2_alpha * (4 + WGS84_F * (4 - 3 * cos2_alpha))
        before, lam = (
            lam,
            length
            + (1 - c)
            * WGS84_F
            * sin_alpha
            * (sigma + c * sin_sigma * (cos_2m + c * cos_sigma * (2 * cos_2m**2 - 1))),
        )
        if abs(lam - before) < 1e-14:
            break
    k = cos2_alpha * (WGS84_A**2 - b**2) / b**2
    big_a = 1 + k / 16384 * (4096 + k * (k * (320 - 175 * k) - 768))
    big_b = k / 1024 * (256 + k * (k * (74 - 47 * k) - 128))
    change = (
        big_b
        * sin_sigma
        * (
            cos_2m
            + big_b
            / 4
            * (
                cos_sigma * (2 * cos_2m**2 - 1)
                - big_b / 6 * cos_2m * (4 * sin_sigma**2 - 3) * (4 * cos_2m**2 - 3)
            )
        )
    )
    azimuth = math.atan2(
        math.cos(u2) * math.sin(lam),
        math.cos(u1) * math.sin(u2) - math.sin(u1) * math.cos(u2) * math.cos(lam),
    )
    return b * big_a * (sigma - change), azimuth


def place(latitude, longitude):
    """x, z of the azimuthal equidistant frame about ORIGIN."""
    distance, azimuth = inverse(*ORIGIN, latitude, longitude)
    return distance * math.sin(azimuth), -distance * math.cos(azimuth)


def world(truth):
    """x, y, z, yaw, pitch, roll as Sward's world has them, by nothing of Sward's."""
    _, latitude, longitude, height, heading, pitch, roll = truth
    x, z = place(latitude, longitude)
    x2, z2 = place(latitude + 1e-4, longitude)
    return x, height, z, heading + math.degrees(math.atan2(x2 - x, z - z2)), pitch, roll


def between(a, b, share):
    """Of two poses, degrees by the shorter way."""
    return [
        p + share * (q - p if i < 3 else math.remainder(q - p, 360))
        for i, (p, q) in enumerate(zip(a, b))
    ]


def off(found, expected):
    """Metres apart, and the largest of the three angles."""
    return math.dist(found[:3], expected[:3]), max(
        abs(math.remainder(f - e, 360)) for f, e in zip(found[3:], expected[3:])
    )


def fly(real_time, rate=60):
    """[(kind, when, pose)] of the probe's lines, and JSBSim's own: [(seconds, clock, pose)]."""
    command = [str(sward_cli.BIN / "feed_probe"), str(ELEVATION)] + (["144"] if real_time else [])
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as probe:
        port = int(probe.stdout.readline().split()[1])
        said = []
        reader = threading.Thread(
            target=lambda: said.extend(probe.stdout)
        )  # a pipe that fills up would stop the probe
        reader.start()
        flight = jsbsim_flight.Flight("127.0.0.1", port, *START, rate)
        own, begin = [], time.monotonic()
        while flight.fdm.get_sim_time() < SECONDS:
            flight.step()
            truth = flight.truth()
            own.append((truth[0], time.monotonic(), world(truth)))
            if real_time:
                time.sleep(max(0, begin + truth[0] - time.monotonic()))
            elif len(own) % 60 == 0:
                time.sleep(0.004)  # the probe keeps up: its socket holds some hundred packets
        reader.join()
    lines = [line.split() for line in said]
    assert probe.returncode == 0, probe.returncode
    *poses, counts = lines
    return (
        [(kind, float(when), [float(v) for v in pose]) for kind, when, *pose in poses],
        [int(v) for v in counts[1:]],
        own,
    )


def offs(lines, own, kind):
    """How far the poses of a kind are off JSBSim's own, of that time or AHEAD steps later."""
    number = {int(seconds * 1e6): i for i, (seconds, _, _) in enumerate(own)}
    later = AHEAD if kind == "ahead" else 0
    # What has time 0 was sent while JSBSim still trimmed the aircraft.
    pairs = [
        (pose, number[int(when)] + later)
        for kind_of, when, pose in lines
        if kind_of == kind and when > 0
    ]
    return [off(pose, own[i][2]) for pose, i in pairs if i < len(own)]


def figures(errors):
    metres, degrees = (sorted(error[i] for error in errors) for i in (0, 1))
    middle, high = len(errors) // 2, len(errors) * 99 // 100
    return (
        f"{len(errors)} poses; m median {metres[middle]:.6f}, p99 {metres[high]:.6f}, most {metres[-1]:.6f}; "
        f"degrees median {degrees[middle]:.6f}, p99 {degrees[high]:.6f}, most {degrees[-1]:.6f}"
    )


class JsbSim(sward_cli.CliCase):
    def test_the_aircraft_is_where_jsbsim_says(self):
        lines, (taken, refused), own = fly(False)
        for kind, most_m, most_deg in (
            ("said", MOST_M, MOST_DEG),
            ("ahead", MOST_AHEAD_M, MOST_AHEAD_DEG),
        ):
            errors = offs(lines, own, kind)
            print(f"{kind}: {figures(errors)}")
            self.assertGreater(len(errors), 0.5 * 60 * SECONDS - AHEAD)
            self.assertLess(max(metres for metres, _ in errors), most_m)
            self.assertLess(max(degrees for _, degrees in errors), most_deg)
        self.assertGreater(taken, 0.5 * 60 * SECONDS)
        self.assertEqual(refused, 0)
        self.assertGreater(lines[-1][1], (SECONDS - 0.1) * 1e6)  # to the end
        # A flight worth the name: it banks both ways, turns, and goes somewhere.
        poses = [pose for kind, _, pose in lines if kind == "said"]
        self.assertLess(min(pose[5] for pose in poses), -15)
        self.assertGreater(max(pose[5] for pose in poses), 15)
        self.assertGreater(math.dist(poses[0][:3], poses[-1][:3]), 500)


def report(rate):
    """Figures of a flight by the clock."""
    lines, counts, own = fly(True, rate)
    clocks = [clock for _, clock, _ in own]
    drawn = []
    for kind, when, pose in lines:
        after = bisect.bisect(clocks, when)
        if kind == "drawn" and 0 < after < len(own):
            share = (when - clocks[after - 1]) / (clocks[after] - clocks[after - 1])
            drawn.append(off(pose, between(own[after - 1][2], own[after][2], share)))
    print(f"{rate} packets a second, {counts[0]} taken, {counts[1]} refused")
    for name, errors in (
        ("said", offs(lines, own, "said")),
        ("a tenth of a second ahead", offs(lines, own, "ahead")),
        ("drawn", drawn),
    ):
        print(f"  {name}: {figures(errors)}", flush=True)


if __name__ == "__main__":
    if "--real-time" in sys.argv:
        for packets in (60, 20):
            report(packets)
    else:
        sward_cli.main()
