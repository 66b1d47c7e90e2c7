# SPDX-License-Identifier: Apache-2.0
"""A small uncompressed GeoTIFF, for tests: pixels, a CRS by its EPSG number and an affine map."""

import struct

FORMATS = {"B": (8, 1), "h": (16, 2), "H": (16, 1), "i": (32, 2), "f": (32, 3)}


def geotiff(
    path,
    width,
    height,
    values,
    kind="f",
    epsg=None,
    affine=None,
    nodata=None,
    bits=None,
    scale=None,
):
    """`values(column, row)`; `affine`: (x of a column, x of a row, x, y of a column, y of a row, y)
    of the first pixel's corner; `bits`: of
    unsigned values that are packed; `scale`: of the file's metadata."""
    data = struct.pack(
        f"<{width * height}{kind}", *(values(i, j) for j in range(height) for i in range(width))
    )
    if bits:
        rows = ("".join(f"{values(i, j):0{bits}b}" for i in range(width)) for j in range(height))
        data = b"".join(
            int(row.ljust(-(-len(row) // 8) * 8, "0"), 2).to_bytes(-(-len(row) // 8))
            for row in rows
        )
    data += bytes(len(data) % 2)
    bits, sample_format = bits or FORMATS[kind][0], FORMATS[kind][1]
    tags = [
        (256, 4, 1, struct.pack("<I", width)),
        (257, 4, 1, struct.pack("<I", height)),
        (258, 3, 1, struct.pack("<H", bits)),
        (259, 3, 1, struct.pack("<H", 1)),
        (262, 3, 1, struct.pack("<H", 1)),
        (273, 4, 1, struct.pack("<I", 8)),
        (277, 3, 1, struct.pack("<H", 1)),
        (278, 4, 1, struct.pack("<I", height)),
        (279, 4, 1, struct.pack("<I", len(data))),
        (339, 3, 1, struct.pack("<H", sample_format)),
    ]
    if affine:
        a, b, c, d, e, f = affine
        tags.append(
            (34264, 12, 16, struct.pack("<16d", a, b, 0, c, d, e, 0, f, 0, 0, 0, 0, 0, 0, 0, 1))
        )
    if epsg:
        geographic = 4000 <= epsg < 5000
        keys = [
            1,
            1,
            0,
            3,
            1024,
            0,
            1,
            2 if geographic else 1,
            1025,
            0,
            1,
            1,
            2048 if geographic else 3072,
            0,
            1,
            epsg,
        ]
        tags.append((34735, 3, len(keys), struct.pack(f"<{len(keys)}H", *keys)))
    if nodata is not None:
        text = str(nodata).encode() + b"\0"
        tags.append((42113, 2, len(text), text))
    if scale is not None:
        text = (
            f'<GDALMetadata><Item name="SCALE" sample="0" role="scale">{scale}</Item></GDALMetadata>'.encode()
            + b"\0"
        )
        tags.append((42112, 2, len(text), text))
    tags.sort()
    directory, rest = struct.pack("<H", len(tags)), b""
    after = 8 + len(data) + 2 + 12 * len(tags) + 4
    for tag, kind_of, count, value in tags:
        directory += struct.pack("<HHI", tag, kind_of, count)
        if len(value) <= 4:
            directory += value.ljust(4, b"\0")
        else:
            directory += struct.pack("<I", after + len(rest))
            rest += value + bytes(len(value) % 2)
    path.write_bytes(
        b"II*\0" + struct.pack("<I", 8 + len(data)) + data + directory + bytes(4) + rest
    )
