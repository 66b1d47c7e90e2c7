#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the landcover of terrains/landcover: classes.tif, road.geojson and pond.geojson. Nothing of it is a survey; the fields are made up.

    make_land_scene.py [DIRECTORY]     default: terrains/landcover beside this script's directory

The raster is an 8-bit GeoTIFF in longitude and latitude (EPSG:4326), 2 m a pixel, Deflate. The same bytes every time."""

import json
import math
import pathlib
import struct
import sys
import zlib

ORIGIN = (36.5895833, -84.2458333)  # latitude, longitude of terrains/jacksboro's own x = z = 0
MIDDLE = (2535.0, 1341.0)  # east and north of it (m): the middle of the fields
HALF_M = 700.0
PIXEL_M = 2.0
ROAD_YAW = math.radians(310)
AHEAD = (math.sin(ROAD_YAW), math.cos(ROAD_YAW))
RIGHT = (math.cos(ROAD_YAW), -math.sin(ROAD_YAW))

HAY, LAWN, FIELD, PASTURE, REEDS, SAND, ROCK, HEATH = 1, 2, 3, 4, 5, 6, 7, 8


def metres_per_degree():
    """Of longitude and latitude at the fields, on WGS 84."""
    a, e2 = 6378137.0, 0.00669437999014
    lat = math.radians(ORIGIN[0])
    w = math.sqrt(1 - e2 * math.sin(lat) ** 2)
    return math.radians(1) * a * math.cos(lat) / w, math.radians(1) * a * (1 - e2) / w**3


def on_earth(east, north):
    """Longitude and latitude of a place from the fields' middle (m)."""
    x, y = metres_per_degree()
    return ORIGIN[1] + (MIDDLE[0] + east) / x, ORIGIN[0] + (MIDDLE[1] + north) / y


def bend(t):
    """How far to the right of its axis the road runs, `t` metres on."""
    return 7 + 30 * math.sin(t / 210)


def at_road(t, aside=0.0):
    s = bend(t) + aside
    return t * AHEAD[0] + s * RIGHT[0], t * AHEAD[1] + s * RIGHT[1]


def pond_radius(turn):
    return 1 + 0.16 * math.sin(2 * turn + 0.5) + 0.09 * math.sin(5 * turn)


POND = (at_road(95, -52), 34.0, 22.0)  # middle, half axes along and across the road


def pond_place(t):
    (east, north), along, across = POND
    r = pond_radius(t)
    a, b = r * along * math.cos(t), r * across * math.sin(t)
    return east + a * AHEAD[0] + b * RIGHT[0], north + a * AHEAD[1] + b * RIGHT[1]


def of_pond(east, north):
    """Distance from the pond's middle over its radius that way."""
    dx, dy = east - POND[0][0], north - POND[0][1]
    a = (dx * AHEAD[0] + dy * AHEAD[1]) / POND[1]
    b = (dx * RIGHT[0] + dy * RIGHT[1]) / POND[2]
    return math.hypot(a, b) / pond_radius(math.atan2(b, a))


def class_at(east, north):
    t = east * AHEAD[0] + north * AHEAD[1]
    s = east * RIGHT[0] + north * RIGHT[1] - bend(t)
    pond = of_pond(east, north)
    if pond < 1.2:
        return SAND if abs(math.atan2(north - POND[0][1], east - POND[0][0])) < 0.7 else REEDS
    rock = math.hypot(t - 150, s - 95) / (1 + 0.25 * math.sin(3 * math.atan2(s - 95, t - 150)))
    if rock < 16:
        return ROCK
    if abs(s) < 7:
        return PASTURE  # the verge
    if s > 0:
        return (
            LAWN
            if t < 35
            else FIELD
            if t < 120
            else HEATH
            if t < 230
            else FIELD
            if t < 330 and s < 170
            else HAY
        )
    if t < 40 and s > -60:
        return HAY
    return (
        PASTURE
        if t < 170
        else FIELD
        if t < 260 and s > -190
        else HAY
        if (t // 140) % 2 == 0
        else PASTURE
    )


def write_classes(path):
    n = int(2 * HALF_M / PIXEL_M)
    rows = [
        bytes(
            [
                class_at(-HALF_M + (i + 0.5) * PIXEL_M, HALF_M - (j + 0.5) * PIXEL_M)
                for i in range(n)
            ]
        )
        for j in range(n)
    ]
    data = zlib.compress(b"".join(rows), 9)
    data += bytes(len(data) % 2)
    west, north = on_earth(-HALF_M, HALF_M)
    east, south = on_earth(HALF_M, -HALF_M)
    keys = [1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326]
    tags = [
        (256, 4, 1, struct.pack("<I", n)),
        (257, 4, 1, struct.pack("<I", n)),
        (258, 3, 1, struct.pack("<H", 8)),
        (259, 3, 1, struct.pack("<H", 8)),
        (262, 3, 1, struct.pack("<H", 1)),
        (273, 4, 1, struct.pack("<I", 8)),
        (277, 3, 1, struct.pack("<H", 1)),
        (278, 4, 1, struct.pack("<I", n)),
        (279, 4, 1, struct.pack("<I", len(data))),
        (33550, 12, 3, struct.pack("<3d", (east - west) / n, (north - south) / n, 0)),
        (33922, 12, 6, struct.pack("<6d", 0, 0, 0, west, north, 0)),
        (34735, 3, len(keys), struct.pack(f"<{len(keys)}H", *keys)),
    ]
    directory, rest = struct.pack("<H", len(tags)), b""
    after = 8 + len(data) + 2 + 12 * len(tags) + 4
    for tag, kind, count, value in tags:
        directory += struct.pack("<HHI", tag, kind, count)
        if len(value) > 4:
            directory += struct.pack("<I", after + len(rest))
            rest += value
        else:
            directory += value.ljust(4, b"\0")
    path.write_bytes(
        b"II*\0" + struct.pack("<I", 8 + len(data)) + data + directory + bytes(4) + rest
    )


def feature(kind, name, coordinates):
    rounded = [[round(x, 8), round(y, 8)] for x, y in coordinates]
    return {
        "type": "Feature",
        "properties": {"kind": name},
        "geometry": {"type": kind, "coordinates": [rounded] if kind == "Polygon" else rounded},
    }


def write_features(path, features):
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}) + "\n")


def main():
    directory = (
        pathlib.Path(sys.argv[1])
        if len(sys.argv) > 1
        else pathlib.Path(__file__).resolve().parent.parent / "terrains" / "landcover"
    )
    write_classes(directory / "classes.tif")
    road = [on_earth(*at_road(t)) for t in range(-640, 641, 8)]
    track = [on_earth(*at_road(60 + 0.5 * math.sin(s / 18) * 12, s)) for s in range(0, 400, 6)]
    write_features(
        directory / "road.geojson",
        [feature("LineString", "road", road), feature("LineString", "track", track)],
    )
    ring = [on_earth(*pond_place(2 * math.pi * k / 72)) for k in range(73)]
    write_features(directory / "pond.geojson", [feature("Polygon", "pond", ring)])


if __name__ == "__main__":
    main()
