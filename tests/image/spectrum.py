# SPDX-License-Identifier: Apache-2.0
"""What a mean does not see: how strongly a picture varies from size to size, how restless it is,
whether it repeats, whether
rings show on a level field, and its hue. Pictures are linear and height x width x 3, luminances
height x width; every
function refuses what is no picture."""

import numpy as np

import metrics
from metrics import NoPicture

SIGMAS = (
    1,
    2,
    4,
    8,
)  # pixels; octave k lies between SIGMAS[k - 1] (0 before the first) and SIGMAS[k]
# of the mean: what varies less lies under a step of the display, and ratios of it say nothing
FLOOR = 0.002
XYZ = np.array(
    [
        [0.4123908, 0.3575843, 0.1804808],
        [0.2126390, 0.7151687, 0.0721923],
        [0.0193308, 0.1191948, 0.9505322],
    ]
)


def luminance(linear, name="picture"):
    """Rec. 709 luminance, height x width, of what may be compared."""
    return metrics.check_picture(linear, name) @ metrics.LUMINANCE


def check_luminance(values, name="luminance"):
    values = np.asarray(values, dtype=np.float64)
    if values.ndim != 2 or values.size == 0:
        raise NoPicture(f"{name}: found shape {values.shape}, expected height x width")
    if not np.isfinite(values).all():
        raise NoPicture(
            f"{name}: found {np.count_nonzero(~np.isfinite(values))} values that are not finite"
        )
    if values.mean() <= 0:
        raise NoPicture(f"{name}: found a mean of {values.mean()}, expected light")
    return values


def pair_of(a, b):
    a, b = check_luminance(a, "first picture"), check_luminance(b, "second picture")
    if a.shape != b.shape:
        raise NoPicture(f"luminances of {a.shape} and {b.shape}")
    return a, b


def blurred(values, sigma):
    """Gaussian of `sigma` pixels out to four of them; the edge's pixels go on outside."""
    reach = int(np.ceil(4 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    for _ in range(2):  # along the rows' index, then, transposed, along the columns'
        padded = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
        values = sum(share * padded[i : i + values.shape[0]] for i, share in enumerate(kernel)).T
    return values


def octaves(values, land=None):
    """Parts of a picture by size: without blur less G(1), G(1) less G(2), G(2) less G(4), G(4) less
    G(8), each on land alone. `land`:
    height x width, true where grass or ground is seen; what else is seen does not bleed in."""
    land = np.ones(values.shape, dtype=bool) if land is None else np.asarray(land, dtype=bool)
    if not land.any():
        raise NoPicture("found no land")
    weight, parts, before = land.astype(np.float64), [], values
    for sigma in SIGMAS:
        after = blurred(values * weight, sigma) / np.maximum(blurred(weight, sigma), 1e-6)
        parts.append((before - after)[land])
        before = after
    return parts


def contrast(values, land=None):
    """Standard deviation over mean in each octave."""
    values = check_luminance(values)
    parts = octaves(values, land)
    return np.array([part.std() for part in parts]) / (
        values.mean() if land is None else values[land].mean()
    )


def common_contrast(a, b, land=None):
    """Contrast of what two renders with independent noise have in common: their covariance has no
    noise in it."""
    a, b = pair_of(a, b)
    mean = (a + b).mean() / 2 if land is None else (a + b)[land].mean() / 2
    common = [
        np.mean((x - x.mean()) * (y - y.mean())) for x, y in zip(octaves(a, land), octaves(b, land))
    ]
    return np.sqrt(np.maximum(common, 0)) / mean


def contrast_ratio(values, a, b, land=None):
    """Contrast over that of the truth, of which `a` and `b` are two renders with independent noise;
    NaN for an octave in which
    the truth holds less than FLOOR."""
    truth = common_contrast(a, b, land)
    found = contrast(values, land)
    return np.where(truth > FLOOR, found / np.maximum(truth, FLOOR), np.nan)


def sparkle(values, moved):
    """99th percentile of the change, over the mean, when the picture moves by a quarter of a pixel.
    `moved` may lack the last row
    or column."""
    values, moved = check_luminance(values), check_luminance(moved, "moved picture")
    if any(m not in (n, n - 1) for m, n in zip(moved.shape, values.shape)):
        raise NoPicture(f"luminances of {values.shape} and {moved.shape}")
    change = np.abs(moved - values[: moved.shape[0], : moved.shape[1]])
    return float(np.percentile(change, 99) / values.mean())


def common_sparkle(pair, moved):
    """Sparkle of the truth, of which `pair` and `moved` each hold two renders with independent
    noise: their mean's, times the share of
    the change's root mean square that the two have in common."""
    a, b = pair_of(*pair)
    moved_a, moved_b = pair_of(*moved)
    rows, columns = moved_a.shape
    first, second = moved_a - a[:rows, :columns], moved_b - b[:rows, :columns]
    both = (first + second) / 2
    share = np.sqrt(max(np.mean(first * second), 0) / max(np.mean(both**2), 1e-30))
    return float(min(share, 1) * np.percentile(np.abs(both), 99) / ((a + b).mean() / 2))


def period(ground, metre_px, patch_m=2.0):
    """How far the spectrum stands out at the patch's period: root of the mean energy at it, along
    x, along z and at its harmonics up to the third, over
    that of what surrounds those places. `ground`: luminance seen from straight above, `metre_px`
    pixels a metre. Noise fills
    the surroundings and lowers it."""
    ground = check_luminance(ground)
    side = int(
        min(ground.shape) / metre_px / patch_m
    )  # whole periods, so that they fall on whole frequencies
    if side < 4:
        raise NoPicture(f"found {side} periods of {patch_m} m, expected 4 at least")
    pixels = int(side * patch_m * metre_px)
    window = np.outer(np.hanning(pixels), np.hanning(pixels))
    cut = ground[:pixels, :pixels]
    energy = np.abs(np.fft.fft2((cut / cut.mean() - 1) * window)) ** 2
    peaks = [(i * side, j * side) for i in range(4) for j in range(4) if i + j > 0]
    near = [
        energy[i + di, j + dj]
        for i, j in peaks
        for di in range(-2, 3)
        for dj in range(-2, 3)
        if max(abs(di), abs(dj)) == 2
    ]
    return float(np.sqrt(max(np.mean([energy[p] for p in peaks]), 0) / max(np.mean(near), 1e-12)))


def ring(values, distance_m, octave=1, step=1.05, least_rows=4):
    """Largest change of contrast and of mean luminance between neighbouring bands of distance, each
    5 % longer than the one before, as
    shares of the smaller. `distance_m`: of each row's ground, far to near; several pictures may
    stand side by side. Contrast is of one
    octave, so at one size in the picture, and freed of the trend that all bands share: with
    distance a pixel holds more blades.
    Bands of fewer rows are left out: they hold too little to tell."""
    values, distance = check_luminance(values), np.asarray(distance_m, dtype=np.float64)
    if distance.shape != values.shape[:1] or not (np.diff(distance) < 0).all():
        raise NoPicture(
            f"found {distance.shape} distances for {values.shape}, expected one a row, falling"
        )
    part = octaves(values)[octave].reshape(values.shape)
    band = np.floor(np.log(distance) / np.log(step)).astype(int)
    rows = {
        k: np.flatnonzero(band == k)
        for k in np.unique(band)
        if np.count_nonzero(band == k) >= least_rows
    }
    light = {k: np.log(values[r].mean()) for k, r in rows.items()}
    spread = {k: np.log(max(part[r].std(), 1e-12)) - light[k] for k, r in rows.items()}
    pairs = [(k, k + 1) for k in rows if k + 1 in rows]
    if len(pairs) < 8:
        raise NoPicture(f"found {len(pairs)} pairs of bands of distance, expected 8 at least")
    lights, spreads = (np.array([of[b] - of[a] for a, b in pairs]) for of in (light, spread))
    return float(np.expm1(np.abs(spreads - np.median(spreads)).max())), float(
        np.expm1(np.abs(lights).max())
    )


def displayed(linear, exposure=1.0):
    """Linear light that the display shows for a radiance, 0..1: the tone curve of
    shaders/shared/tone.h."""
    x = np.maximum(np.asarray(linear, dtype=np.float64) * exposure * 0.62, 0)
    return np.minimum(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1)


def hue(shown):
    """CIE a*, b* of the mean of a display's linear light, 1 being its white (D65)."""
    xyz = XYZ @ metrics.check_picture(shown).mean(axis=(0, 1)) / XYZ.sum(axis=1)
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def hue_difference(a, b):
    """Distance of the means of two displayed pictures in a*, b*."""
    return float(np.hypot(*(hue(a) - hue(b))))
