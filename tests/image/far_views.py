# SPDX-License-Identifier: Apache-2.0
"""Small pictures of the far field against every blade as geometry: the views, their renders, and
all figures of one view. Both
the test and the table that tunes the far field stand on it."""

import hashlib
import json
import math
import shutil
import struct
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import metrics
import spectrum
import sward_image
from sward_image import sward_cli

ROWS, COLUMNS = 96, 160
TIME = 2.0
STEP = 1e-5  # seconds from pose to pose of one path: nothing moves in it
CANOPY_M = 0.3  # where grass is seen on the whole
LOD_EYE_M = 600
LIMITS = {
    "coverage": 0.03,
    "luminance": 0.02,
    "contrast_low": 0.75,
    "contrast_high": 1.25,
    "sparkle": 1.3,
    "hue": 2.0,
    "period": 1.2,
}


@dataclass(frozen=True)
class View:
    """Where the middle of the picture lies: elevation of the view above the ground's plane in
    degrees, distance in metres; vertical field
    of view in degrees. `fine`: samples of the reference a pixel and axis, in multiples of four,
    times four by MSAA."""

    elevation: float
    distance: float
    fov: float = 8.8  # as a window of this size in a frame of 720 rows and 60 degrees
    fine: int = 8

    @property
    def focal(self):
        return ROWS / 2 / math.tan(math.radians(self.fov / 2))


# From the end of the hand-over on; grazing ones with fewer samples, for they see more blades than
# all the others.
VIEWS = {
    "nadir20": View(89, 20),
    "at75_20": View(75, 20),
    "nadir60": View(89, 60, fine=4),
    "at60_12": View(60, 12),
    "at60_30": View(60, 30),
    "at30_15": View(30, 15),
    "at30_40": View(30, 40),
    "at30_100": View(30, 100, fine=4),
    "at10_20": View(10, 20, 7, fine=4),
    "at10_42": View(10, 42, 4.4, fine=4),
    "at4_25": View(4, 25, 4, fine=4),
    "at30_60": View(30, 60, fine=4),
    "at10_60": View(10, 60, fine=4),
    "at30_120": View(30, 120, fine=4),
    "at10_120": View(10, 120, 4.4, fine=4),
}
PLAN = View(89, 24, 30, fine=4)  # wide enough for the spectrum at the patch's period
PLAN_METRE_PX = 8

RING = View(10, 70, 16)  # 18 degrees below the horizon to 2
RING_SIZE, RING_YAWS = (240, 240), range(0, 360, 30)


@dataclass(frozen=True)
class Land:
    """A plane that rises to the north by `slope_deg`, the sun behind the eye or (`away`) behind the
    slope, and the wind."""

    slope_deg: float = 0
    wind_mps: float = 0
    away: bool = False
    grass: str = field(
        default="meadow", repr=False
    )  # a set that ships; references are kept under its scene

    def name(self):
        return (
            ("" if self.grass == "meadow" else f"{self.grass}_")
            + f"slope{self.slope_deg:g}_wind{self.wind_mps:g}"
            + ("_away" if self.away else "")
        )

    def pose(self, view):
        """Position in metres, yaw and pitch in degrees, of an eye that looks up the slope."""
        pitch = math.radians(self.slope_deg - view.elevation)
        return (
            (3.0, 100 - view.distance * math.sin(pitch), view.distance * math.cos(pitch)),
            0.0,
            math.degrees(pitch),
        )

    def poses(self, view):
        """The pose, and those that move the picture by a quarter of a pixel to the left and up."""
        (x, y, z), yaw, pitch = self.pose(view)
        quarter = 0.25 / view.focal
        if abs(pitch) < 75:
            right = (x, y, z), math.degrees(quarter / math.cos(math.radians(pitch))), pitch
        else:  # a turn about the vertical would only spin the picture
            right = (x + quarter * view.distance, y, z), yaw, pitch
        return [((x, y, z), yaw, pitch), right, ((x, y, z), yaw, pitch - math.degrees(quarter))]

    def scene(self, fov, poses):
        """A scene whose path `view` stands in each pose for a moment."""
        keys = ", ".join(
            f"{{ t = {TIME + i * STEP:.6f}, position = [{p[0]:.9f}, {p[1]:.9f}, {p[2]:.9f}], yaw_deg = {yaw:.9f}, "
            f"pitch_deg = {pitch:.9f} }}"
            for i, (p, yaw, pitch) in enumerate(poses)
        )
        return sward_image.scene_text(
            [f"[path.view]\nagl = false\nfov_deg = {fov}\nkeys = [{keys}]\n"],
            self.wind_mps,
            f"[sun]\nazimuth_deg = {330 if self.away else 150}\nelevation_deg = 40\n",
            self.grass,
        )

    def write(self, folder, fov, poses):
        side, spacing = 33, 16.0
        rise = math.tan(math.radians(self.slope_deg)) * spacing
        heights = [100 + ((side - 1) / 2 - row) * rise for row in range(side) for _ in range(side)]
        (folder / "flat.raw").write_bytes(struct.pack(f"<{side * side}f", *heights))
        (folder / "flat.json").write_text(
            json.dumps({"width": side, "height": side, "spacing_m": [spacing, spacing]})
        )
        (folder / "scene.toml").write_text(self.scene(fov, poses))


@dataclass
class Pictures:
    """A picture and those moved by a quarter of a pixel (right, down): each height x width x 4,
    linear colour and coverage."""

    still: np.ndarray
    right: np.ndarray
    down: np.ndarray
    seconds: float = field(default=0.0, compare=False)


def load(path):
    channels = sward_image.load_exr(path)
    if (
        channels["tier"] > 5.5
    ).mean() > 1e-3:  # a pixel between two levels of the ground may be open
        raise metrics.NoPicture(f"{path.name}: found sky or objects, expected land alone")
    return np.concatenate([channels["color"], channels["coverage"][..., None]], axis=2)


def render(land, shot, arguments, size=(COLUMNS, ROWS), shaders=None):
    """`shot`: field of view and poses. A picture of each pose, and processor seconds, in one run of
    the program. Raises AssertionError with its message where it fails."""
    with tempfile.TemporaryDirectory(prefix="sward-far-") as name:
        folder = Path(name)
        fov, poses = shot
        land.write(folder, fov, poses)
        result = sward_cli.run(
            "sward",
            "render",
            "scene.toml",
            "-o",
            "out%d.exr",
            "--path",
            "view",
            "--time",
            TIME,
            "--fixed-timestep",
            STEP,
            "--frames",
            f"0:{len(poses) - 1}",
            "--size",
            f"{size[0]}x{size[1]}",
            "--aov",
            "color,coverage,tier",
            "-q",
            *arguments,
            cwd=folder,
            env=sward_cli.environment(SWARD_SHADERS=shaders),
            timeout=1200,
        )
        assert result.code == 0, f"{arguments}: {result.err}"
        return [load(folder / f"out{i}.exr") for i in range(len(poses))], result.cpu_s


def far(land, view, arguments=(), shaders=None):
    pictures, seconds = render(land, (view.fov, land.poses(view)), arguments, shaders=shaders)
    return Pictures(*pictures, seconds)


def split(fine_picture, fine):
    """From a picture `fine` times as large: two renders of independent noise, each of every other
    pixel of a chequerboard, boxed, and as
    they are a quarter of a pixel further right and further down."""
    height, width = fine_picture.shape[:2]
    chequer = np.add.outer(np.arange(height), np.arange(width)) % 2
    halves = []
    for parity in (0, 1):
        weight = (chequer == parity)[..., None]
        boxes = []
        for down, right in ((0, 0), (0, fine // 4), (fine // 4, 0)):
            rows, columns = (height - down) // fine, (width - right) // fine
            cut = (fine_picture * weight)[down : down + rows * fine, right : right + columns * fine]
            boxes.append(2 * cut.reshape(rows, fine, columns, fine, -1).mean(axis=(1, 3)))
        halves.append(Pictures(*boxes))
    return halves


def reference_arguments(eye):
    """How the wind poses a blade follows its size in pixels, and here pixels are small: with the
    eye of the tiers LOD_EYE_M up, all have a far
    blade's pose. The distance is measured from there too; what the view shows bounds the work. One
    frame of a large picture, and
    not many of a small one: its samples are boxes side by side, where jittered frames of four
    samples each blur over two pixels."""
    return (
        "--tiers",
        "reference",
        "--reference-distance",
        "1000",
        "--reference-grid",
        "1",
        "--lod-eye",
        f"{eye[0]},{LOD_EYE_M},{eye[2]}",
    )


def reference(land, view, cache=None):
    """Every blade as geometry, as two renders of independent noise. `cache`: a folder in which it
    is kept, under the hash of view, scene and
    blades; not of the program or the shaders."""
    blades, poses = sward_image.shipped_set(land.grass) / "blades.glb", land.poses(view)
    arguments = reference_arguments(poses[0][0])
    preset = (sward_image.PRESETS / f"{land.grass}.toml").read_text()
    key = hashlib.sha256(
        f"{land}{view}{land.scene(view.fov, poses)}{arguments}{ROWS}x{COLUMNS}{preset}".encode()
        + blades.read_bytes()
    ).hexdigest()[:20]
    path = cache and Path(cache) / f"{key}.npz"
    if path and path.exists():
        with np.load(path) as kept:
            return [
                Pictures(*(kept[f"{half}{i}"].astype(np.float64) for i in range(3)))
                for half in "ab"
            ]
    pictures, seconds = render(
        land, (view.fov, poses[:1]), arguments, (COLUMNS * view.fine, ROWS * view.fine)
    )
    halves = split(pictures[0], view.fine)
    print(f"reference {land.name()} {view}: {seconds:.0f} s", flush=True)
    if path:
        path.parent.mkdir(parents=True, exist_ok=True)
        kept = {
            f"{half}{i}": p.astype(np.float32)
            for half, h in zip("ab", halves)
            for i, p in enumerate((h.still, h.right, h.down))
        }
        np.savez_compressed(path.with_suffix(".part.npz"), **kept)
        shutil.move(path.with_suffix(".part.npz"), path)
    return halves


def figures(truth, found):
    """All figures of one view. `truth`: two renders of it; `found`: Pictures of a build."""
    a, b = truth
    both = (a.still + b.still) / 2
    light = [spectrum.luminance(p[..., :3]) for p in (a.still, b.still, found.still)]
    moved = {
        way: [spectrum.luminance(getattr(p, way)[..., :3]) for p in (a, b, found)]
        for way in ("right", "down")
    }
    result = {
        "coverage": float(found.still[..., 3].mean() - both[..., 3].mean()),
        "truth_coverage": float(both[..., 3].mean()),
        "luminance": float(light[2].mean() / ((light[0] + light[1]).mean() / 2) - 1),
        "truth_contrast": spectrum.common_contrast(light[0], light[1]),
        "contrast": spectrum.contrast_ratio(light[2], *light[:2]),
        "hue": spectrum.hue_difference(
            spectrum.displayed(both[..., :3]), spectrum.displayed(found.still[..., :3])
        ),
    }
    for way, (moved_a, moved_b, moved_found) in moved.items():
        expected = spectrum.common_sparkle(light[:2], (moved_a, moved_b))
        result[f"sparkle_{way}"] = spectrum.sparkle(light[2], moved_found) / max(expected, 1e-6)
        result[f"truth_sparkle_{way}"] = expected
    return result


def ground_picture(values, view, metre_px, margin=0.94):
    """A view's luminance on the plane of the grass, as seen from straight above: the largest square
    about the picture's middle that it shows."""
    elevation = math.radians(view.elevation)
    height = view.distance * math.sin(elevation) - CANOPY_M
    middle = height / math.tan(elevation)
    half = margin * min(COLUMNS, ROWS) / 2 / view.focal * view.distance
    at = np.arange(-half, half, 1 / metre_px)
    forward, right = np.meshgrid(middle + at[::-1], at, indexing="ij")
    depth = forward * math.cos(elevation) + height * math.sin(elevation)
    up = forward * math.sin(elevation) - height * math.cos(elevation)
    column, row = (
        COLUMNS / 2 - 0.5 + view.focal * right / depth,
        ROWS / 2 - 0.5 - view.focal * up / depth,
    )
    return bilinear(values, row, column)


def plan_period(seen):
    """spectrum.period of PLAN's Pictures: of one build, or of the truth's two renders."""
    mean = sum(spectrum.luminance(p.still[..., :3]) for p in seen) / len(seen)
    return spectrum.period(ground_picture(mean, PLAN, PLAN_METRE_PX), PLAN_METRE_PX)


def ring_change(arguments=()):
    """spectrum.ring of the level field, seen in RING_YAWS directions so that single flowers do not
    count."""
    eye = (3.0, 100 + RING.distance * math.sin(math.radians(RING.elevation)), 5.0)
    poses = [(eye, yaw, -RING.elevation) for yaw in RING_YAWS]
    size = RING_SIZE
    pictures, _ = render(Land(), (RING.fov, poses), arguments, size)
    light = np.concatenate([spectrum.luminance(p[..., :3]) for p in pictures], axis=1)
    angles = RING.elevation - np.degrees(
        np.arctan(
            (size[1] / 2 - 0.5 - np.arange(size[1]))
            * 2
            / size[1]
            * math.tan(math.radians(RING.fov / 2))
        )
    )
    return spectrum.ring(light, (eye[1] - 100 - CANOPY_M) / np.sin(np.radians(angles)))


def bilinear(values, row, column):
    row, column = (
        np.clip(row, 0, values.shape[0] - 1.001),
        np.clip(column, 0, values.shape[1] - 1.001),
    )
    r, c = row.astype(int), column.astype(int)
    v, h = row - r, column - c
    return (values[r, c] * (1 - h) + values[r, c + 1] * h) * (1 - v) + (
        values[r + 1, c] * (1 - h) + values[r + 1, c + 1] * h
    ) * v


def failures(result, limits=LIMITS):
    """Names of the figures that are over their limits."""
    bad = [
        name for name in ("coverage", "luminance", "hue") if not abs(result[name]) <= limits[name]
    ]
    for k, ratio in enumerate(result["contrast"]):
        if not np.isnan(ratio) and not limits["contrast_low"] <= ratio <= limits["contrast_high"]:
            bad.append(f"contrast{k}")
    return bad + [
        f"sparkle_{way}"
        for way in ("right", "down")
        if not result[f"sparkle_{way}"] <= limits["sparkle"]
    ]


HEADER = (
    "land                 view     | cov truth  diff | lum %  |  contrast ratio 0-1 1-2 2-4 4-8 (of the mean, %)           "
    "| sparkle r    d    (%)       | hue  | over"
)


def line(land, name, result):
    ratios = " ".join(" (.) " if np.isnan(r) else f"{r:5.2f}" for r in result["contrast"])
    shares = " ".join(f"{100 * c:4.1f}" for c in result["truth_contrast"])
    sparkles = " ".join(f"{result[f'sparkle_{way}']:4.2f}" for way in ("right", "down"))
    rests = " ".join(f"{100 * result[f'truth_sparkle_{way}']:4.1f}" for way in ("right", "down"))
    return (
        f"{land.name():20} {name:8} | {100 * result['truth_coverage']:5.1f} {100 * result['coverage']:+7.1f} | {100 * result['luminance']:+6.1f} | "
        f"{ratios} ({shares}) | {sparkles} ({rests}) | {result['hue']:4.1f} | {' '.join(failures(result)) or 'ok'}"
    )
