# SPDX-License-Identifier: Apache-2.0
"""Mean colour of a grass set from above as sward render draws it: three_reference.py SWARD SET
[OPTION OF RENDER ...]. Prints R G B,
linear, for three_check.mjs. Needs numpy and OpenEXR (tests/requirements.txt)."""

import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import OpenEXR

SCENE = """\
[terrain]
elevation = "height.raw"
[grass]
set = "{set}"
[sun]
azimuth_deg = 135
elevation_deg = 35
[wind]
speed_mps = 0
gust = 0
[camera.top]
position = [0, 10, 0]
pitch_deg = -90
fov_deg = 16
"""


def main(sward, grass, *options):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "height.raw").write_bytes(struct.pack("<4096f", *[0.0] * 4096))
        (folder / "height.json").write_text('{"width": 64, "height": 64, "spacing_m": [10, 10]}')
        (folder / "scene.toml").write_text(SCENE.format(set=Path(grass).resolve()))
        subprocess.run(
            [
                Path(sward).resolve(),
                "render",
                "scene.toml",
                "-q",
                "-o",
                "top.exr",
                "--camera",
                "top",
                "--size",
                "576x576",
                *options,
            ],
            cwd=folder,
            check=True,
        )
        with OpenEXR.File(str(folder / "top.exr"), separate_channels=True) as file:
            channels = file.channels()
            print(
                *(
                    f"{float(numpy.asarray(channels[c].pixels, dtype=numpy.float64).mean()):.5f}"
                    for c in "RGB"
                )
            )


main(*sys.argv[1:])
