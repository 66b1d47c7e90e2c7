# SPDX-License-Identifier: Apache-2.0
"""Whole files of kinds that a line or two makes, for tests that spoil them."""

import json
import struct

ENDLESS = """\
CREATE VIEW roads AS WITH RECURSIVE n(fid) AS (SELECT 1 UNION ALL SELECT fid + 1 FROM n)
SELECT count(*) AS fid, x'' AS geom, 'road' AS kind FROM n
"""
CONTROLS = b"""\
[[device]]
guid = "030000006d0400004fc2000011010000"
name = "G29"
[[device.axis]]
axis = 0
moves = "steer"
curve = 1.5
[[device.button]]
button = 4
does = "pause"
"""
CHANNELS = b"""\
[[channel]]
name = "a"
size = [2, 2]
yaw_deg = -60
frustum_deg = [-30, 30, -18, 18]
"""
RECORD = b"""\
sward-record 1
scene scene
rate 60
start 2
step 0 25 0 10 -5 0 60 0 0 1 0 0 0
sun 120 30
wind 4 270 0.4
step 0.1 25 0 10 -5 0 60 0 0 1 0 0 0
"""
MATRICES = json.dumps(
    {
        "view_from_world": [1, 0, 0, 0, 0, 1, 0, -30, 0, 0, 1, 0, 0, 0, 0, 1],
        "clip_from_view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0.1, 0, 0, -1, 0],
    }
).encode()


def triangle():
    """A mesh of one triangle as .glb."""
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}],
            "scene": 0,
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": 3,
                    "type": "VEC3",
                    "min": [0, 0, 0],
                    "max": [1, 1, 1],
                },
                {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
            ],
            "bufferViews": [
                {"buffer": 0, "byteLength": 36},
                {"buffer": 0, "byteOffset": 36, "byteLength": 6},
            ],
            "buffers": [{"byteLength": 44}],
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    data = struct.pack("<9f3H2x", 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 2)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(data), 0x004E4942)
        + data
    )
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks
