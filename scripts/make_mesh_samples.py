#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of terrains/moebius, terrains/fur, terrains/roof and terrains/leaves as glTF
binary. Everything is made here, from formulas.

make_mesh_samples.py [ROOT]      ROOT: the source tree, by default the one this file stands in
"""

import json
import math
import struct
import sys
from pathlib import Path


class Mesh:
    """Vertices (metres, y up), triangles counter-clockwise from outside; normals: the mean about a
    vertex."""

    def __init__(self):
        self.vertices, self.triangles = [], []

    def add(self, vertices, triangles):
        first = len(self.vertices)
        self.vertices += vertices
        self.triangles += [tuple(first + i for i in t) for t in triangles]

    def quad(self, a, b, c, d):
        self.add([a, b, c, d], [(0, 1, 2), (0, 2, 3)])

    def box(self, low, high):
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.quad((x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0))
        self.quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))
        self.quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
        self.quad((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0))
        self.quad((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1))
        self.quad((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0))

    def beam(self, a, b, half):
        """A square bar from a to b, upright across."""
        up, side = (0, half, 0), (half, 0, 0)
        ends = [
            [
                tuple(p[k] + i * side[k] + j * up[k] for k in range(3))
                for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))
            ]
            for p in (a, b)
        ]
        for n in range(4):
            m = (n + 1) % 4
            self.quad(ends[0][n], ends[1][n], ends[1][m], ends[0][m])
        self.quad(*ends[0])
        self.quad(*ends[1][::-1])

    def normals(self):
        sums = [[0.0, 0.0, 0.0] for _ in self.vertices]
        for t in self.triangles:
            a, b, c = (self.vertices[i] for i in t)
            n = cross(sub(b, a), sub(c, a))
            for i in t:
                for k in range(3):
                    sums[i][k] += n[k]
        return [unit(n) for n in sums]

    def write(self, path):
        corners = b"".join(struct.pack("<3f", *v) for v in self.vertices)
        normals = b"".join(struct.pack("<3f", *n) for n in self.normals())
        indices = b"".join(struct.pack("<3I", *t) for t in self.triangles)
        low = [
            min(struct.unpack("<f", struct.pack("<f", v[k]))[0] for v in self.vertices)
            for k in range(3)
        ]
        high = [
            max(struct.unpack("<f", struct.pack("<f", v[k]))[0] for v in self.vertices)
            for k in range(3)
        ]
        views, offset = [], 0
        for data, target in ((corners, 34962), (normals, 34962), (indices, 34963)):
            views.append(
                {"buffer": 0, "byteOffset": offset, "byteLength": len(data), "target": target}
            )
            offset += len(data)
        count = len(self.vertices)
        document = {
            "asset": {
                "version": "2.0",
                "generator": "make_mesh_samples.py",
                "copyright": "Sward, Apache-2.0",
            },
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "name": path.stem}],
            "meshes": [
                {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}
            ],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": count,
                    "type": "VEC3",
                    "min": low,
                    "max": high,
                },
                {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
                {
                    "bufferView": 2,
                    "componentType": 5125,
                    "count": 3 * len(self.triangles),
                    "type": "SCALAR",
                },
            ],
            "bufferViews": views,
            "buffers": [{"byteLength": offset}],
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        body = corners + normals + indices
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(
            struct.pack("<3I", 0x46546C67, 2, 28 + len(text) + len(body))
            + struct.pack("<2I", len(text), 0x4E4F534A)
            + text
            + struct.pack("<2I", len(body), 0x004E4942)
            + body
        )
        print(f"{path}: {len(self.triangles)} triangles, {path.stat().st_size // 1024} KiB")


def sub(a, b):
    return tuple(p - q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    size = math.sqrt(sum(c * c for c in v)) or 1.0
    return tuple(c / size for c in v)


def mix(a, b, t):
    return a + (b - a) * t


# --- Moebius strip --------------------------------------------------------------------------------


def moebius():
    """A band with half a turn in it, 0.3 m thick with round rims, so that its one side is one
    closed surface."""
    around, loop = (
        288,
        44,
    )  # sections; places on a section, even: half a turn maps the section onto itself
    radius, half_width, thick = 5.0, 1.7, 0.15
    mesh = Mesh()
    for i in range(around):
        angle = 2 * math.pi * i / around
        twist = 0.5 * angle + 0.35
        out, along = (math.cos(angle), math.sin(angle)), None
        for j in range(loop):
            t = 2 * math.pi * j / loop
            # A superellipse: flat sides, round rims.
            across = half_width * math.copysign(abs(math.cos(t)) ** 0.55, math.cos(t))
            over = thick * math.copysign(abs(math.sin(t)) ** 0.55, math.sin(t))
            r = radius + across * math.cos(twist) - over * math.sin(twist)
            y = across * math.sin(twist) + over * math.cos(twist)
            # Stood on edge and leaned back, so that its hole is seen.
            x, z = r * out[0], r * out[1]
            lean = math.radians(58)
            mesh.vertices.append(
                (
                    x,
                    5.2 + y * math.cos(lean) + z * math.sin(lean),
                    z * math.cos(lean) - y * math.sin(lean),
                )
            )

    def at(i, j):
        if i == around:
            return (j + loop // 2) % loop
        return i * loop + j % loop

    for i in range(around):
        for j in range(loop):
            a, b, c, d = at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)
            mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh


# --- An animal ------------------------------------------------------------------------------------


def capsule(p, a, b, ra, rb):
    """Distance to a cone with round ends, nearly."""
    ab = sub(b, a)
    t = max(0.0, min(1.0, sum(u * v for u, v in zip(sub(p, a), ab)) / sum(c * c for c in ab)))
    q = tuple(mix(a[k], b[k], t) for k in range(3))
    return math.dist(p, q) - mix(ra, rb, t)


def ellipsoid(p, c, r):
    k0 = math.sqrt(sum(((p[k] - c[k]) / r[k]) ** 2 for k in range(3)))
    k1 = math.sqrt(sum(((p[k] - c[k]) / r[k] ** 2) ** 2 for k in range(3)))
    return k0 * (k0 - 1) / k1 if k1 > 1e-9 else -min(r)


def smooth_min(a, b, k):
    h = max(k - abs(a - b), 0.0) / k
    return min(a, b) - h * h * k * 0.25


LEGS = [
    ((0.19, 0.75, -0.52), (0.20, 0.07, -0.56)),
    ((-0.19, 0.75, -0.52), (-0.20, 0.07, -0.47)),
    ((0.19, 0.78, 0.55), (0.20, 0.07, 0.52)),
    ((-0.19, 0.78, 0.55), (-0.20, 0.07, 0.62)),
]


def animal_distance(p):
    """A shaggy cow of the hills, 1.2 m at the withers, its head to the north (-z), without what is
    not furred."""
    d = ellipsoid(p, (0, 0.98, 0.02), (0.34, 0.36, 0.74))
    d = smooth_min(d, ellipsoid(p, (0, 1.07, -0.46), (0.29, 0.36, 0.36)), 0.15)
    d = smooth_min(d, ellipsoid(p, (0, 1.03, 0.56), (0.31, 0.33, 0.30)), 0.12)
    d = smooth_min(d, capsule(p, (0, 1.16, -0.68), (0, 1.27, -1.00), 0.23, 0.17), 0.15)
    d = smooth_min(d, capsule(p, (0, 1.30, -1.06), (0, 1.13, -1.36), 0.155, 0.095), 0.08)
    for hip, hoof in LEGS:
        knee = tuple(mix(hip[k], hoof[k], 0.55) for k in range(3))
        d = smooth_min(d, capsule(p, hip, knee, 0.15, 0.085), 0.10)
        d = smooth_min(d, capsule(p, knee, hoof, 0.08, 0.075), 0.05)
    for side in (-1, 1):
        d = smooth_min(d, ellipsoid(p, (0.25 * side, 1.30, -1.02), (0.13, 0.045, 0.06)), 0.05)
    d = smooth_min(d, capsule(p, (0, 1.16, 0.84), (0, 0.62, 0.98), 0.05, 0.04), 0.06)
    return smooth_min(d, ellipsoid(p, (0, 0.50, 0.99), (0.07, 0.14, 0.07)), 0.06)


def surface_nets(distance, low, cell, size):
    """The zero of a distance as quads, a vertex in each cell that it crosses (naive surface
    nets)."""
    nx, ny, nz = size
    values = {}
    for i in range(nx + 1):
        for j in range(ny + 1):
            for k in range(nz + 1):
                values[i, j, k] = distance(
                    (low[0] + cell * i, low[1] + cell * j, low[2] + cell * k)
                )
    mesh, number = Mesh(), {}
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    edges = [
        (a, b) for a in corners for b in corners if a < b and sum(p != q for p, q in zip(a, b)) == 1
    ]
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                hits = []
                for a, b in edges:
                    va, vb = (
                        values[i + a[0], j + a[1], k + a[2]],
                        values[i + b[0], j + b[1], k + b[2]],
                    )
                    if (va < 0) != (vb < 0):
                        t = va / (va - vb)
                        hits.append(tuple(mix(p, q, t) for p, q in zip(a, b)))
                if hits:
                    mean = [sum(h[n] for h in hits) / len(hits) for n in range(3)]
                    number[i, j, k] = len(mesh.vertices)
                    mesh.vertices.append(
                        (
                            low[0] + cell * (i + mean[0]),
                            low[1] + cell * (j + mean[1]),
                            low[2] + cell * (k + mean[2]),
                        )
                    )
    for (i, j, k), inside in values.items():
        for axis in range(3):
            step = [0, 0, 0]
            step[axis] = 1
            other = values.get((i + step[0], j + step[1], k + step[2]))
            if other is None or (inside < 0) == (other < 0):
                continue
            u, v = [0, 0, 0], [0, 0, 0]
            u[(axis + 1) % 3], v[(axis + 2) % 3] = 1, 1
            ring = [
                number.get(
                    (i - a * u[0] - b * v[0], j - a * u[1] - b * v[1], k - a * u[2] - b * v[2])
                )
                for a, b in ((1, 1), (0, 1), (0, 0), (1, 0))
            ]
            if None in ring:
                continue
            a, b, c, d = ring if inside < 0 else ring[::-1]
            mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh


def animal():
    cell = 0.028
    return surface_nets(animal_distance, (-0.48, -0.03, -1.56), cell, (35, 56, 97))


def tube(points, radii, sides=16):
    """A round tube along points, closed at both ends."""
    mesh = Mesh()
    for n, (p, r) in enumerate(zip(points, radii)):
        way = unit(sub(points[min(n + 1, len(points) - 1)], points[max(n - 1, 0)]))
        first = unit(cross(way, (0.3, 0.2, 1.0)))
        second = cross(way, first)
        for s in range(sides):
            t = 2 * math.pi * s / sides
            mesh.vertices.append(
                tuple(
                    p[k] + r * (math.cos(t) * first[k] + math.sin(t) * second[k]) for k in range(3)
                )
            )
    for n in range(len(points) - 1):
        for s in range(sides):
            a, b = n * sides + s, n * sides + (s + 1) % sides
            mesh.triangles += [(a, b, b + sides), (a, b + sides, a + sides)]
    for ring, point, turn in ((0, points[0], True), ((len(points) - 1) * sides, points[-1], False)):
        middle = len(mesh.vertices)
        mesh.vertices.append(point)
        for s in range(sides):
            a, b = ring + s, ring + (s + 1) % sides
            mesh.triangles.append((middle, b, a) if turn else (middle, a, b))
    return mesh


def horns():
    mesh = Mesh()
    for side in (-1, 1):
        points = [
            (
                side * (0.08 + 0.42 * math.sin(1.35 * t)),
                1.40 + 0.02 * t + 0.24 * t * t * t,
                -1.04 - 0.10 * math.sin(2.2 * t),
            )
            for t in (n / 20 for n in range(21))
        ]
        part = tube(points, [0.045 * (1 - 0.93 * (n / 20) ** 1.3) for n in range(21)])
        mesh.add(part.vertices, part.triangles)
    return mesh


def hooves():
    mesh = Mesh()
    for _, (x, _, z) in LEGS:
        part = tube([(x, 0.0, z), (x, 0.05, z), (x, 0.09, z)], [0.085, 0.08, 0.07], 20)
        mesh.add(part.vertices, part.triangles)
    return mesh


def muzzle():
    return surface_nets(
        lambda p: ellipsoid(p, (0, 1.085, -1.43), (0.095, 0.075, 0.055)),
        (-0.12, 0.99, -1.51),
        0.012,
        (20, 16, 14),
    )


def rock():
    """What it stands on: a flat stone."""

    def distance(p):
        bumps = 0.03 * math.sin(5 * p[0] + 1) * math.sin(4 * p[2]) + 0.02 * math.sin(
            11 * p[0] + 3 * p[2]
        ) * math.cos(9 * p[2])
        return smooth_min(ellipsoid(p, (0, -0.62, 0), (1.7, 0.62, 2.1)), 9.0, 0.1) + bumps * (
            1 if p[1] < -0.06 else 0.25
        )

    return surface_nets(distance, (-1.9, -1.4, -2.3), 0.1, (38, 15, 46))


# --- A house with a roof of sod -------------------------------------------------------------------


def meadow_height(x, z):
    return (
        0.28 * math.sin(0.35 * x + 0.6) * math.cos(0.28 * z)
        + 0.10 * math.sin(0.9 * x - 0.5 * z)
        - 0.25
    )


HALF_LONG, HALF_DEEP, EAVES = 3.4, 2.3, 2.15


def roof_section(t):
    """Half a roof's cross-section from ridge (0) to eave (1): bellied, swept out at the eave."""
    z = t * 3.15
    return 4.35 - 2.55 * t + 0.42 * math.sin(math.pi * t) * (0.6 - t) + 0.30 * max(
        t - 0.8, 0
    ) ** 2 * 10, z


def roof():
    mesh = Mesh()
    n, half = 64, 13.0
    heights = [[0.0] * (n + 1) for _ in range(n + 1)]
    first = len(mesh.vertices)
    for j in range(n + 1):
        for i in range(n + 1):
            x, z = mix(-half, half, i / n), mix(-half, half, j / n)
            heights[j][i] = meadow_height(x, z)
            mesh.vertices.append((x, heights[j][i], z))
    for j in range(n):
        for i in range(n):
            a = first + j * (n + 1) + i
            x, z = mix(-half, half, (i + 0.5) / n), mix(-half, half, (j + 0.5) / n)
            if abs(x) < HALF_LONG - 0.3 and abs(z) < HALF_DEEP - 0.3:
                continue  # no meadow in the house
            mesh.triangles += [(a, a + n + 1, a + 1), (a + 1, a + n + 1, a + n + 2)]
    # The roof: a shell 0.28 m thick that ends 0.9 m beyond the walls; gently sagging ridge.
    columns, rows, over = 36, 22, 4.3
    top, under = [], []
    for i in range(columns + 1):
        x = mix(-over, over, i / columns)
        sag = -0.16 * (1 - (x / over) ** 2) + 0.05 * math.sin(2.1 * x)
        for j in range(-rows, rows + 1):
            y, z = roof_section(abs(j) / rows)
            lift = 0.03 * math.sin(3 * x + 0.4 * j)
            top.append((x, y + sag + lift, math.copysign(z, j)))
            under.append((x * 0.985, y + sag - 0.28, math.copysign(z * 0.97, j)))
    wide = 2 * rows + 1
    for i in range(columns):
        for j in range(2 * rows):
            a = i * wide + j
            mesh.quad(top[a], top[a + 1], top[a + wide + 1], top[a + wide])
            mesh.quad(under[a], under[a + wide], under[a + wide + 1], under[a + 1])
    for j in range(2 * rows):
        a, b = j, columns * wide + j
        mesh.quad(top[a], under[a], under[a + 1], top[a + 1])
        mesh.quad(top[b], top[b + 1], under[b + 1], under[b])
    for i in range(columns):
        a, b = i * wide, i * wide + wide - 1
        mesh.quad(top[a], top[a + wide], under[a + wide], under[a])
        mesh.quad(top[b], under[b], under[b + wide], top[b + wide])
    return weld(mesh)


def walls():
    """Up to the roof's underside, with gables."""
    mesh = Mesh()
    for side in (-1, 1):
        x = side * HALF_LONG
        for j in range(12):
            z0, z1 = mix(-HALF_DEEP, HALF_DEEP, j / 12), mix(-HALF_DEEP, HALF_DEEP, (j + 1) / 12)
            y0, y1 = (roof_section(abs(z) / 3.15)[0] - 0.3 for z in (z0, z1))
            corners = [(x, -0.9, z0), (x, -0.9, z1), (x, y1, z1), (x, y0, z0)]
            mesh.quad(*(corners if side < 0 else corners[::-1]))
        z = side * HALF_DEEP
        y = roof_section(HALF_DEEP / 3.15)[0] - 0.3
        corners = [
            (-HALF_LONG, -0.9, z),
            (HALF_LONG, -0.9, z),
            (HALF_LONG, y, z),
            (-HALF_LONG, y, z),
        ]
        mesh.quad(*(corners if side > 0 else corners[::-1]))
    return weld(mesh)


def weld(mesh):
    """One vertex a place and side: faces that meet at less than 50 degrees share it, so that
    normals are smooth there."""
    out, known = Mesh(), {}
    for t in mesh.triangles:
        a, b, c = (mesh.vertices[i] for i in t)
        n = unit(cross(sub(b, a), sub(c, a)))
        corners = []
        for v in (a, b, c):
            shared = known.setdefault(tuple(round(q, 6) for q in v), [])
            for number, other in shared:
                if sum(p * q for p, q in zip(n, other)) > 0.64:
                    corners.append(number)
                    break
            else:
                shared.append((len(out.vertices), n))
                corners.append(len(out.vertices))
                out.vertices.append(v)
        if len(set(corners)) == 3:
            out.triangles.append(tuple(corners))
    return out


def joinery():
    """Door, window frames, chimney's cap: dark wood."""
    mesh = Mesh()
    z = HALF_DEEP
    mesh.box((-0.55, -0.4, z - 0.05), (0.55, 1.75, z + 0.05))
    for x in (-2.1, 2.1):
        mesh.box((x - 0.5, 0.65, z - 0.05), (x + 0.5, 1.55, z + 0.04))
    mesh.box((HALF_LONG - 0.04, 0.7, -0.5), (HALF_LONG + 0.05, 1.7, 0.5))
    for i in range(-5, 6):  # rafters under the eaves
        x = 0.78 * i
        for side in (-1, 1):
            y0, z0 = roof_section(0.72)
            y1, z1 = roof_section(0.94)
            mesh.beam((x, y0 - 0.42, side * z0), (x, y1 - 0.36, side * z1), 0.06)
    return mesh


def panes():
    mesh = Mesh()
    z = HALF_DEEP + 0.045
    for x in (-2.1, 2.1):
        for i in (-1, 1):
            for y0, y1 in ((0.72, 1.07), (1.13, 1.48)):
                mesh.box((x + 0.23 * i - 0.19, y0, z - 0.01), (x + 0.23 * i + 0.19, y1, z + 0.01))
    return mesh


def chimney():
    mesh = Mesh()
    mesh.box((1.6, 3.0, -0.42), (2.3, 5.0, 0.28))
    mesh.box((1.52, 4.92, -0.50), (2.38, 5.06, 0.36))
    return mesh


def mound():
    """A hump of ground, 2.4 m across."""
    mesh, n = Mesh(), 48
    mesh.vertices.append((0.0, 0.30, 0.0))
    for r in range(1, n + 1):
        for i in range(n):
            a, s = 2 * math.pi * i / n, r / n
            x, z = 1.2 * s * math.cos(a), 1.2 * s * math.sin(a)
            mesh.vertices.append(
                (x, 0.30 * (1 - s * s) ** 2 + 0.012 * math.sin(9 * x + 1) * math.sin(8 * z), z)
            )
    for i in range(n):
        mesh.triangles.append((0, 1 + (i + 1) % n, 1 + i))
        for r in range(n - 1):
            a, b = 1 + r * n + i, 1 + r * n + (i + 1) % n
            mesh.triangles += [(a, b, a + n), (b, b + n, a + n)]
    return mesh


# --- The published near scenes --------------------------------------------------------------------


def hills_height(x, z):
    """A hollow among rounded hills of some 4 m: level where the balls roll and the body lies,
    beyond its rim one cannot see far."""
    y = (
        1.5 * math.sin(0.26 * x + 0.5) * math.cos(0.23 * z)
        + 0.8 * math.sin(0.47 * x - 0.35 * z + 1.0)
        + 0.2 * math.sin(1.1 * x) * math.sin(0.9 * z + 2.0)
    )
    out = math.hypot(x - 0.5, z - 6.5)
    rise = max(0.0, min(1.0, (out - 4.0) / 5.5))
    rim = 3.3 * rise * rise * (3 - 2 * rise) * math.exp(-(max(out - 9.5, 0.0) ** 2) / 22)
    return y * min(1.0, out / 12) ** 1.5 + rim * (
        1 + 0.22 * math.sin(2.0 * math.atan2(z - 6.5, x - 0.5) + 0.8)
    )


def grid(half, cells, height):
    """A square of ground, its middle at 0."""
    mesh = Mesh()
    for j in range(cells + 1):
        for i in range(cells + 1):
            x, z = 2 * half * i / cells - half, 2 * half * j / cells - half
            mesh.vertices.append((x, height(x, z), z))
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i
            b = a + cells + 1
            mesh.triangles += [(a, b, a + 1), (a + 1, b, b + 1)]
    return mesh


def sleeper_distance(p):
    """Somebody of 2.4 m who lies on his side in the grass, knees drawn up, head to the west."""
    d = ellipsoid(p, (-0.30, 0.30, 0.0), (0.48, 0.29, 0.26))
    d = smooth_min(d, ellipsoid(p, (0.28, 0.27, 0.02), (0.34, 0.26, 0.25)), 0.2)
    d = smooth_min(d, ellipsoid(p, (-1.00, 0.22, 0.02), (0.22, 0.19, 0.17)), 0.10)
    for a, b, ra, rb in [
        ((0.35, 0.17, 0.1), (0.62, 0.15, 0.62), 0.17, 0.12),
        ((0.62, 0.15, 0.62), (1.25, 0.12, 0.42), 0.11, 0.08),
        ((0.35, 0.38, 0.1), (0.80, 0.36, 0.55), 0.17, 0.12),
        ((0.80, 0.36, 0.55), (1.30, 0.16, 0.20), 0.11, 0.08),
        ((-0.62, 0.45, 0.1), (-0.42, 0.32, 0.48), 0.10, 0.08),
        ((-0.42, 0.32, 0.48), (-0.85, 0.14, 0.52), 0.08, 0.06),
        ((-0.65, 0.14, 0.12), (-0.95, 0.10, 0.44), 0.10, 0.07),
        ((1.25, 0.12, 0.42), (1.32, 0.12, 0.60), 0.08, 0.05),
    ]:
        d = smooth_min(d, capsule(p, a, b, ra, rb), 0.09)
    return d


def sleeper():
    cell = 0.04
    return surface_nets(sleeper_distance, (-1.36, -0.08, -0.44), cell, (73, 22, 34))


def pad_height(x, z):
    return 0.5 * math.sin(0.11 * x + 0.4) * math.sin(0.13 * z) + 0.12 * math.sin(0.5 * x - 0.3 * z)


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    terrains = root / "terrains"
    moebius().write(terrains / "moebius" / "strip.glb")
    mound().write(terrains / "leaves" / "mound.glb")
    animal().write(terrains / "fur" / "animal.glb")
    for name, make in (("horns", horns), ("hooves", hooves), ("muzzle", muzzle), ("rock", rock)):
        make().write(terrains / "fur" / f"{name}.glb")
    roof().write(terrains / "roof" / "house.glb")
    for name, make in (
        ("walls", walls),
        ("joinery", joinery),
        ("panes", panes),
        ("chimney", chimney),
    ):
        make().write(terrains / "roof" / f"{name}.glb")
    grid(20, 96, hills_height).write(terrains / "near" / "nature" / "hills.glb")
    sleeper().write(terrains / "near" / "nature" / "sleeper.glb")
    grid(30, 72, pad_height).write(terrains / "near" / "helicopter" / "field.glb")


if __name__ == "__main__":
    main()
