# SPDX-License-Identifier: Apache-2.0
"""What the KTX 2.0 specification (revision 4) and Khronos Data Format 1.3 ask of a texture file,
for the formats and schemes that texgen writes:
ktx2_check.py FILE ... prints what is wrong with each and ends with 1 if anything is. It reads no
shared code: a second opinion on the writer."""

import math
import struct
import sys
from pathlib import Path

IDENTIFIER = b"\xabKTX 20\xbb\r\n\x1a\n"
NONE, ZSTD = 0, 2
RGBSDA, BC5_MODEL = 1, 132
LINEAR, SRGB = 1, 2
RED, GREEN, BLUE, ALPHA = 0, 1, 2, 15
FLOAT_SIGNED, QUALIFIER_LINEAR = 0xC0, 0x10
ONE, MINUS_ONE = 0x3F800000, 0xBF800000
ORIENTATION = (b"rd", b"ru", b"ld", b"lu")


def plain(bits, qualifier=0, alpha=0, low=0, high=255):
    return [
        (c * bits, bits - 1, channel | qualifier | (alpha if channel == ALPHA else 0), low, high)
        for c, channel in enumerate((RED, GREEN, BLUE, ALPHA))
    ]


# VkFormat: bytes of a number (1 of a block), texels a block's side, bytes of it, colour model,
# transfer, samples: bit, bits - 1, channel, low, high
FORMATS = {
    37: (1, 1, 4, RGBSDA, LINEAR, plain(8)),  # R8G8B8A8_UNORM
    43: (1, 1, 4, RGBSDA, SRGB, plain(8, alpha=QUALIFIER_LINEAR)),  # R8G8B8A8_SRGB
    97: (
        2,
        1,
        8,
        RGBSDA,
        LINEAR,
        plain(16, FLOAT_SIGNED, low=MINUS_ONE, high=ONE),
    ),  # R16G16B16A16_SFLOAT
    109: (
        4,
        1,
        16,
        RGBSDA,
        LINEAR,
        plain(32, FLOAT_SIGNED, low=MINUS_ONE, high=ONE),
    ),  # R32G32B32A32_SFLOAT
    141: (
        1,
        4,
        16,
        BC5_MODEL,
        LINEAR,
        [(0, 63, RED, 0, 0xFFFFFFFF), (64, 63, GREEN, 0, 0xFFFFFFFF)],
    ),  # BC5_UNORM_BLOCK
}


def zstd_frame(data):
    """(bytes of the frame, bytes that it unpacks to or None), by RFC 8878, without unpacking."""
    if data[:4] != b"\x28\xb5\x2f\xfd":
        raise ValueError("no Zstandard frame")
    descriptor = data[4]
    if descriptor & 0x08:
        raise ValueError("a reserved bit of the frame is set")
    single, at = descriptor >> 5 & 1, 5
    at += (0 if single else 1) + (0, 1, 2, 4)[descriptor & 3]
    width = (single, 2, 4, 8)[descriptor >> 6]
    size = (
        int.from_bytes(data[at : at + width], "little") + (256 if width == 2 else 0)
        if width
        else None
    )
    at += width
    last = False
    while not last:
        if at + 3 > len(data):
            raise ValueError("the frame ends within a block")
        head = int.from_bytes(data[at : at + 3], "little")
        last, kind = head & 1, head >> 1 & 3
        if kind == 3:
            raise ValueError("a block of a reserved type")
        at += 3 + (1 if kind == 1 else head >> 3)
    return at + (4 if descriptor & 4 else 0), size


def key_values(data, say):
    found, at = [], 0
    while at < len(data):
        (length,) = struct.unpack_from("<I", data, at)
        entry, end = data[at + 4 : at + 4 + length], at + 4 + length
        if length < 2 or end > len(data) or b"\0" not in entry[:-1]:
            return say("key/value data: an entry without a key, or past its end")
        key, value = entry.split(b"\0", 1)
        padding = data[end : end + -end % 4]
        if len(padding) != -end % 4 or any(padding):
            say(f"key {key}: padding is not zero up to four bytes")
        if key.startswith((b"KTX", b"ktx")) and key not in (
            b"KTXwriter",
            b"KTXorientation",
            b"KTXswizzle",
        ):
            say(f"key {key}: reserved, and not one that these files have a use for")
        if key.startswith(b"KTX") and (value[-1:] != b"\0" or b"\0" in value[:-1]):
            say(f"key {key}: its value does not end with its only NUL")
        if key == b"KTXorientation" and value[:-1] not in ORIENTATION:
            say(f"key {key}: {value}")
        found.append(key)
        at = end + len(padding)
    if found != sorted(set(found)):
        say(f"keys {found}: not sorted, or twice there")
    if b"KTXwriter" not in found:
        say("no KTXwriter")


def descriptor(data, form, say):
    _, side, block, model, transfer, samples = form
    head = struct.unpack_from("<I2I8B8B", data) if len(data) >= 28 else None
    if head is None or head[0] != len(data):
        return say("data format descriptor: its own size is another")
    wanted = (
        len(data),
        0,
        2 | (len(data) - 4) << 16,
        model,
        1,
        transfer,
        0,
        side - 1,
        side - 1,
        0,
        0,
        block,
        0,
        0,
        0,
        0,
        0,
        0,
        0,
    )
    if head[:11] != wanted[:11] or head[11] not in (block, 0) or any(head[12:]):
        say(f"data format descriptor: {head}, expected {wanted}")
    found = [
        (bit, length, channel, low, high)
        for bit, length, channel, place, low, high in struct.iter_unpack("<HBBIII", data[28:])
        if place == 0
    ]
    if found != samples:
        say(f"samples: {found}, expected {samples}")


def levels(data, start, shape, packing, say):
    """The level index and the data: smallest first, one after the other, aligned, to the end of the
    file."""
    width, height, images, count = shape
    side, block, scheme = packing
    align, end = (math.lcm(block, 4) if scheme == NONE else 1), start
    for m in reversed(range(count)):
        offset, length, unpacked = struct.unpack_from("<3Q", data, 80 + 24 * m)
        blocks = [-(-max(1, n >> m) // side) for n in (width, height)]
        if unpacked != blocks[0] * blocks[1] * block * images:
            say(
                f"level {m}: unpacks to {unpacked} bytes, expected {blocks[0] * blocks[1] * block * images}"
            )
        wanted = end + -end % align
        if offset != wanted or any(data[end:offset]):
            say(f"level {m}: begins at {offset}, expected {wanted} after zeros")
        end = offset + length
        if end > len(data):
            return say(f"level {m}: ends past the file")
        if scheme == NONE and length != unpacked:
            say(f"level {m}: {length} bytes of {unpacked}")
        if scheme == ZSTD:
            try:
                frame, size = zstd_frame(data[offset:end])
            except ValueError as problem:
                say(f"level {m}: {problem}")
                continue
            if frame != length or size not in (None, unpacked):
                say(
                    f"level {m}: a frame of {frame} bytes that unpacks to {size}, expected {length} and {unpacked}"
                )
    if end != len(data):
        say(f"{len(data) - end} bytes after the last level")


def problems(data):
    """What is wrong with a file's bytes, a line each."""
    found = []
    say = found.append
    if data[:12] != IDENTIFIER or len(data) < 104:
        return ["no KTX 2.0"]
    (
        fmt,
        type_size,
        width,
        height,
        depth,
        images,
        faces,
        count,
        scheme,
        dfd,
        dfd_size,
        kvd,
        kvd_size,
        sgd,
        sgd_size,
    ) = struct.unpack_from("<13I2Q", data, 12)
    form = FORMATS.get(fmt)
    if form is None or scheme not in (NONE, ZSTD):
        return [f"format {fmt}, scheme {scheme}: not known here"]
    if type_size != form[0]:
        say(f"typeSize {type_size}, expected {form[0]}")
    if (depth, faces) != (0, 1) or 0 in (width, height):
        say(f"{width} x {height} x {depth}, {faces} faces: no 2D texture or array of them")
    if not 1 <= count <= max(width, height).bit_length():
        return found + [f"{count} levels"]
    if (sgd, sgd_size) != (0, 0):
        say("supercompression global data, which neither scheme has")
    place = 80 + 24 * count
    if dfd != place or dfd_size % 4:
        say(f"data format descriptor at {dfd}, expected {place}")
    if (kvd, kvd_size > 0) != (dfd + dfd_size, True) or kvd + kvd_size > len(data):
        return found + [
            f"key/value data at {kvd}, {kvd_size} bytes, expected after {dfd + dfd_size}"
        ]
    descriptor(data[dfd : dfd + dfd_size], form, say)
    key_values(data[kvd : kvd + kvd_size], say)
    levels(
        data,
        kvd + kvd_size,
        (width, height, max(1, images), count),
        (form[1], form[2], scheme),
        say,
    )
    return found


def main(names):
    bad = False
    for name in names:
        for line in problems(Path(name).read_bytes()):
            print(f"{name}: {line}")
            bad = True
    return bad


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
