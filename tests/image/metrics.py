# SPDX-License-Identifier: Apache-2.0
"""Figures that the image tests hold pictures against. Pictures are arrays of height x width x 3,
0..255 for the display and
linear where said; every function refuses what is no picture."""

import flip_evaluator
import numpy as np

# Limits of a hand-over step of 1/60 s, on 8-bit sRGB.
PAIR_LIMITS = {"tile16": 7.0, "signed8": 9.0, "flip": 0.24, "over16_percent": 0.5}
# The same on 4 x 4 boxes, where single blades average out. The share over 16/255 is calibrated on
# what ships: 1.5 x its worst
# (3.4 %), and well under a third of shells alone (34 %). FLIP too, since meadows flower: a bright
# head is some boxes that change
# (worst 0.285, a daisy; shells alone 0.51).
BOX_LIMITS = {**PAIR_LIMITS, "flip": 0.31, "over16_percent": 5.1}
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # Rec. 709


class NoPicture(ValueError):
    """An image that no test may compare: empty, black, of one colour, or with a number that is
    none."""


def check_picture(image, name="picture"):
    """The picture itself; raises NoPicture where it could make a comparison pass trivially."""
    image = np.asarray(image, dtype=np.float64)
    if image.ndim != 3 or image.shape[2] != 3 or image.size == 0:
        raise NoPicture(f"{name}: found shape {image.shape}, expected height x width x 3")
    if not np.isfinite(image).all():
        raise NoPicture(
            f"{name}: found {np.count_nonzero(~np.isfinite(image))} values that are not finite"
        )
    if image.max() <= 0:
        raise NoPicture(f"{name}: found nothing but black")
    if (image == image[0, 0]).all():
        raise NoPicture(f"{name}: found one colour only")
    return image


def srgb(linear):
    """Linear 0..1 to 0..255 of the display (IEC 61966-2-1), rounded to whole numbers as a file
    would."""
    x = np.clip(np.asarray(linear, dtype=np.float64), 0, 1)
    return np.round(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055))


def mean_luminance(linear):
    return float((check_picture(linear) @ LUMINANCE).mean())


def both(a, b):
    a, b = check_picture(a, "first picture"), check_picture(b, "second picture")
    if a.shape != b.shape:
        raise NoPicture(f"pictures of {a.shape} and {b.shape}")
    return a, b


def mean_difference(a, b):
    """Mean of absolute differences, in 1/255."""
    a, b = both(a, b)
    return float(np.abs(a - b).mean())


def boxed(picture, side):
    """Means of side x side pixels: the same picture from afar."""
    rows, columns = picture.shape[0] // side, picture.shape[1] // side
    cut = np.asarray(picture, dtype=np.float64)[: rows * side, : columns * side]
    return cut.reshape(rows, side, columns, side, 3).mean(axis=(1, 3))


def largest_window(values, side):
    """Largest mean over any window of side x side pixels (fewer where the picture is smaller), at
    every offset."""
    rows, columns = min(side, values.shape[0]), min(side, values.shape[1])
    sums = np.pad(values, ((1, 0), (1, 0))).cumsum(0).cumsum(1)
    window = (
        sums[rows:, columns:]
        - sums[:-rows, columns:]
        - sums[rows:, :-columns]
        + sums[:-rows, :-columns]
    )
    return float(window.max() / (rows * columns))


def flip_percentile(a, b, percentile=99.9):
    """Of FLIP's map (Andersson 2020), at its default viewing distance."""
    pictures = [np.ascontiguousarray(p / 255, dtype=np.float32) for p in (a, b)]
    error, _, _ = flip_evaluator.evaluate(*pictures, "LDR", applyMagma=False)
    return float(
        np.percentile(np.asarray(error).reshape(a.shape[0], a.shape[1], -1)[..., 0], percentile)
    )


def pair(a, b):
    """The four figures of gate 1, for two renders of one moment that differ in the tiers alone."""
    a, b = both(a, b)
    difference = b - a
    grey = difference.mean(axis=2)
    return {
        "tile16": largest_window(np.abs(difference).mean(axis=2), 16),
        "signed8": max(largest_window(grey, 8), largest_window(-grey, 8)),
        "flip": flip_percentile(a, b),
        "over16_percent": float(100 * (np.abs(difference).max(axis=2) > 16).mean()),
    }


def over_limits(figures, limits=PAIR_LIMITS):
    """What of a pair's figures is over its limit."""
    return {name: value for name, value in figures.items() if value > limits[name]}


def worst(all_figures):
    return {name: max(figures[name] for figures in all_figures) for name in PAIR_LIMITS}


def text(figures):
    return ", ".join(f"{name} {value:.3f}" for name, value in figures.items())
