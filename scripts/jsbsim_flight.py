# SPDX-License-Identifier: Apache-2.0
"""Flies JSBSim's Cessna (pip install jsbsim) in real time and sends net_fdm by JSBSim's own output:

    python scripts/jsbsim_flight.py --to 127.0.0.1:5550 --at 36.6396,-84.2178,900 [--seconds 60]
    [--ground 5560]

beside `sward view SCENE --native-fdm udp:5550 [--udp-out udp:127.0.0.1:5560]`. HEIGHT in metres
above sea level. With --ground the flight
stands on the ground that is drawn: its height comes back from Sward and becomes JSBSim's terrain.
"""

import argparse
import os
import socket
import struct
import sys
import tempfile
import time

import jsbsim

FOOT = 0.3048
STEP_S = 1 / 120
OUTPUT = """<?xml version="1.0"?>
<output name="{host}" type="FLIGHTGEAR" port="{port}" protocol="UDP" rate="{rate}">
  <time type="simulation" resolution="1e-6"/>
</output>
"""


class Flight:
    """A climb, then turns by the autopilot to both sides, banked up to 30 degrees."""

    HEADINGS = ((0, 120), (18, 330), (36, 60), (48, 300))  # from which second on, degrees

    def __init__(self, host, port, latitude, longitude, height_m, rate=60):
        self.fdm = jsbsim.FGFDMExec(jsbsim.get_default_root_dir())
        self.fdm.set_debug_level(0)
        self.fdm.load_model("c172x")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "output.xml")
            with open(path, "w", encoding="ascii") as file:
                file.write(OUTPUT.format(host=host, port=port, rate=rate))
            if not self.fdm.set_output_directive(path):
                raise RuntimeError("JSBSim takes no output")
        self.fdm.set_dt(STEP_S)
        for name, value in {
            "ic/lat-geod-deg": latitude,
            "ic/long-gc-deg": longitude,
            "ic/h-sl-ft": height_m / FOOT,
            "ic/psi-true-deg": 40,
            "ic/vc-kts": 100,
            "ic/terrain-elevation-ft": 0,
            "propulsion/set-running": -1,
        }.items():
            self.fdm[name] = value
        self.fdm.run_ic()
        self.fdm.do_trim(1)
        self.fdm["ap/altitude_hold"] = 1
        self.fdm["ap/altitude_setpoint"] = height_m / FOOT + 200
        self.fdm["ap/heading_hold"] = 1

    def step(self):
        """One hundred-and-twentieth of a second; JSBSim sends when it is due."""
        seconds = self.fdm.get_sim_time()
        self.fdm["ap/heading_setpoint"] = [
            heading for begin, heading in self.HEADINGS if begin <= seconds
        ][-1]
        self.fdm.run()

    def truth(self):
        """What JSBSim's properties say: seconds; latitude, longitude, height (degrees, m); heading,
        pitch, roll (degrees)."""
        names = (
            "position/lat-geod-deg",
            "position/long-gc-deg",
            "position/h-sl-meters",
            "attitude/psi-deg",
            "attitude/theta-deg",
            "attitude/phi-deg",
        )
        return (self.fdm.get_sim_time(), *(self.fdm[name] for name in names))


def stand_on(flight, reports):
    """Takes Sward's answers (docs/simulator-integration.md) and lifts JSBSim's terrain to them."""
    while True:
        try:
            packet = reports.recv(2048)
        except BlockingIOError:
            return
        if len(packet) == 96 and packet[:4] == b"SWGD" and struct.unpack(">I", packet[4:8]) == (1,):
            flight.fdm["position/terrain-elevation-asl-ft"] = (
                struct.unpack(">d", packet[56:64])[0] / FOOT
            )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--to", default="127.0.0.1:5550", metavar="HOST:PORT")
    parser.add_argument("--at", required=True, metavar="LAT,LON,HEIGHT")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--rate", type=float, default=60, help="packets a second")
    parser.add_argument("--ground", type=int, metavar="PORT", help="where Sward's --udp-out goes")
    options = parser.parse_args()
    host, port = options.to.rsplit(":", 1)
    flight = Flight(host, int(port), *map(float, options.at.split(",")), options.rate)
    reports = None
    if options.ground:
        reports = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        reports.setblocking(False)
        reports.bind(("127.0.0.1", options.ground))
    begin, shown = time.monotonic(), -1
    while flight.fdm.get_sim_time() < options.seconds:
        flight.step()
        if reports:
            stand_on(flight, reports)
        seconds, latitude, longitude, height, heading, pitch, roll = flight.truth()
        if int(seconds) > shown:
            shown = int(seconds)
            print(
                f"{shown:4d} s  {latitude:.6f} {longitude:.6f}  {height:7.1f} m, {flight.fdm['position/h-agl-ft'] * FOOT:6.1f} above ground  "
                f"heading {heading:5.1f} pitch {pitch:5.1f} roll {roll:5.1f}",
                flush=True,
            )
        time.sleep(max(0, begin + seconds - time.monotonic()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
