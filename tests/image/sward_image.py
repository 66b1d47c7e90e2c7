# SPDX-License-Identifier: Apache-2.0
"""What the image tests share: a flat field of the shipped meadow, renders of it, and reading
pictures."""

import fcntl
import json
import shutil
import struct
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "cli"))
import sward_cli  # noqa: E402  (the programs' tests know how to run them)
from metrics import NoPicture, check_picture  # noqa: E402

WORK = sward_cli.BIN.parent / "image"  # the baked set, which outlives one test
PRESETS = sward_cli.SOURCE / "texgen/presets"
TIERS = ("ground", "blade", "grouped blade", "shell", "x-slice", "z-slice", "object", "sky")
main = sward_cli.main


def shipped_set(name="meadow"):
    """A shipped set without its extras, baked once for all tests and again after texgen or the
    preset changed."""
    WORK.mkdir(parents=True, exist_ok=True)
    preset, target, stamp = PRESETS / f"{name}.toml", WORK / name, WORK / f"{name}.stamp"
    with open(WORK / "set.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        now = f"{(sward_cli.BIN / 'texgen').stat().st_mtime_ns} {preset.read_text()}"
        if not target.exists() or not stamp.exists() or stamp.read_text() != now:
            stamp.unlink(missing_ok=True)
            result = sward_cli.run(
                "texgen", preset, "-o", target, "-q", "--no-volume", "--no-preview", timeout=900
            )
            assert result.code == 0, result.err
            stamp.write_text(now)
    return target


def write_flat(path, side=17, spacing=16.0):
    path.write_bytes(struct.pack(f"<{side * side}f", *[100.0] * (side * side)))
    path.with_suffix(".json").write_text(
        json.dumps({"width": side, "height": side, "spacing_m": [spacing, spacing]})
    )


def camera(name, position, pitch_deg, fov_deg, yaw_deg=0):
    return (
        f"[camera.{name}]\nposition = {list(position)}\nyaw_deg = {yaw_deg}\npitch_deg = {pitch_deg}\n"
        f"fov_deg = {fov_deg}\n"
    )


def scene_text(cameras, wind_mps=4, extra="", grass="meadow"):
    return (
        f'[terrain]\nelevation = "flat.raw"\ndetail_m = 0\n[grass]\nset = "{shipped_set(grass)}"\n'
        f"[wind]\nspeed_mps = {wind_mps}\n{extra}" + "".join(cameras)
    )


def load_png(path):
    """A display picture, 0..255; NoPicture for what no test may compare."""
    with Image.open(path) as image:
        return check_picture(np.asarray(image.convert("RGB")), path.name)


def load_exr(path):
    """Channels by name; the colour under `color` too, linear."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = {
            name: np.array(channel.pixels, dtype=np.float64)
            for name, channel in file.channels().items()
        }
    for name, values in channels.items():
        if not np.isfinite(values).all():
            raise NoPicture(f"{path.name}: found a {name} that is not finite")
    if "R" in channels:
        channels["color"] = check_picture(np.stack([channels[c] for c in "RGB"], axis=2), path.name)
    return channels


def tier_shares(channels):
    """Share of the pixels by tier, in the order of TIERS. Where samples of two tiers meet, the
    value is in between and
    counts for the nearest."""
    tiers = np.clip(np.round(channels["tier"]), 0, len(TIERS) - 1).astype(int)
    return np.bincount(tiers.ravel(), minlength=len(TIERS)) / tiers.size


def shaders_without_slices(target):
    """A copy of the shaders whose slices show nothing: the far tier is shells alone."""
    shutil.copytree(sward_cli.SOURCE / "shaders", target)
    source = target / "shells/far.frag"
    text = source.read_text()
    changed = text.replace("void main() {", "void main() {\n#ifdef SLICES\n    discard;\n#endif", 1)
    assert changed != text, "far.frag has no main to change"
    source.write_text(changed)
    return target


class ImageCase(unittest.TestCase):
    """Tests of one scene in a folder of their own, `self.dir`; scene() of the class says what it
    holds."""

    @classmethod
    def scene(cls):
        raise NotImplementedError

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="sward-image-")
        cls.addClassCleanup(folder.cleanup)
        cls.dir = Path(folder.name)
        write_flat(cls.dir / "flat.raw")
        (cls.dir / "scene.toml").write_text(cls.scene())

    @classmethod
    def render(cls, output, *arguments, size="240x136", shaders=None):
        """Renders the scene and returns the picture's path and its statistics."""
        env = sward_cli.environment(SWARD_SHADERS=shaders)
        result = sward_cli.run(
            "sward",
            "render",
            "scene.toml",
            "-o",
            output,
            "--size",
            size,
            "-q",
            "--stats",
            "stats.json",
            *arguments,
            cwd=cls.dir,
            env=env,
        )
        assert result.code == 0, f"{arguments}: {result.err}"
        return cls.dir / output, json.loads((cls.dir / "stats.json").read_text())
