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


def glb(positions, triangles):
    """A mesh without normals as glTF binary."""
    corners = b"".join(struct.pack("<3f", *p) for p in positions)
    indices = b"".join(struct.pack("<3I", *t) for t in triangles)
    place = {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3"}
    place |= {"min": [min(axis) for axis in zip(*positions)]}
    place |= {"max": [max(axis) for axis in zip(*positions)]}
    index = {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}],
            "scene": 0,
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [place, index],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": len(corners)},
                {"buffer": 0, "byteOffset": len(corners), "byteLength": len(indices)},
            ],
            "buffers": [{"byteLength": len(corners) + len(indices)}],
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    body = corners + indices
    return (
        struct.pack("<3I", 0x46546C67, 2, 28 + len(text) + len(body))
        + struct.pack("<2I", len(text), 0x4E4F534A)
        + text
        + struct.pack("<2I", len(body), 0x004E4942)
        + body
    )


TRIANGLE = glb([(0, 0, 0), (1, 0, 0), (0, 1, 1)], [(0, 1, 2)])
