# SPDX-License-Identifier: Apache-2.0
"""Every KTX2 file that texgen writes, of sets and exports and in every packing, against the
specification (ktx2_check.py)."""

import struct

import ktx2_check
import sward_cli
from sward_cli import CliCase

FAST = ("--no-preview", "--no-volume", "-q")


class Ktx2(CliCase):
    def texgen(self, *arguments):
        self.assert_done(sward_cli.run("texgen", *arguments, cwd=self.dir))

    def check(self, folder, most_formats):
        files = sorted((self.dir / folder).glob("*.ktx2"))
        formats = set()
        for path in files:
            data = path.read_bytes()
            formats.add(struct.unpack_from("<I", data, 12)[0])
            self.assertEqual(ktx2_check.problems(data), [], path)
        self.assertTrue(most_formats <= formats, formats)
        return files

    def test_sets_and_exports(self):
        (self.dir / "tiny.toml").write_text(sward_cli.TINY_PRESET)
        for packing, formats in (("zstd", {37, 97}), ("bc", {37, 141})):
            self.texgen("tiny.toml", "-o", packing, "--compression", packing, *FAST)
            self.check(packing, formats)
        for packing in ("none", "zstd:3"):
            self.texgen(
                "export", "zstd", "-o", "out", "--for", "textures", "--compression", packing, "-q"
            )
            files = self.check("out", {37, 43})
            self.assertGreaterEqual(len(files), 10)
            self.spoil((self.dir / "out/albedo_layers.ktx2").read_bytes())

    def spoil(self, data):
        """What the specification forbids is found: a header's number, a descriptor's, the order of
        keys, the end of a level."""
        (count,) = struct.unpack_from("<I", data, 40)
        dfd = 80 + 24 * count
        for at, value in (
            (16, 4),
            (36, 6),
            (48, dfd + 4),
            (dfd + 14, 1),
            (dfd + 13, 5),
            (dfd + 31, 0xFF),
            (dfd + 20, 8),
            (dfd + 100, ord("k")),
            (80, data[80] + 1),
            (88, data[88] ^ 1),
            (96, data[96] ^ 1),
        ):
            bad = bytearray(data)
            bad[at] = value & 0xFF
            self.assertNotEqual(ktx2_check.problems(bytes(bad)), [], (at, value))
        self.assertNotEqual(ktx2_check.problems(data[:-1]), [])
        self.assertNotEqual(ktx2_check.problems(data + b"\0"), [])


if __name__ == "__main__":
    sward_cli.main()
