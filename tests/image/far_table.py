# SPDX-License-Identifier: Apache-2.0
"""Prints the figures of the far field against every blade as geometry, for any arguments of
`sward`:

    python tests/image/far_table.py [--views nadir20,at30_15] [--slope 0,25] [--wind 0,12] [--grass
    meadow,lawn] [--away] [--period] [--ring] [--shaders DIR] [-- --far planes]

SWARD_BIN_DIR names the folder of the programs (default build/release/bin). References are kept in
`image/far-references` beside it, under the
hash of scene, view and blades; --fresh makes them again (after a change of how blades are drawn or
lit), --pictures DIR writes truth and
found side by side. The exit code is 1 where a view is over a limit."""

import argparse
import itertools
import shutil
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import far_views
import metrics
import spectrum
import sward_image

CACHE = sward_image.WORK / "far-references"


def write_picture(path, truth, found):
    """Truth left, found right, each pixel as 4 x 4."""
    shown = [
        metrics.srgb(spectrum.displayed(p[..., :3]))
        for p in ((truth[0].still + truth[1].still) / 2, found.still)
    ]
    both = np.concatenate(shown, axis=1).repeat(4, axis=0).repeat(4, axis=1)
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(both.astype(np.uint8)).save(path)


def period_line(land, arguments):
    truth, found = (
        far_views.reference(land, far_views.PLAN, CACHE),
        far_views.far(land, far_views.PLAN, arguments),
    )
    expected, value = far_views.plan_period(truth), far_views.plan_period([found])
    return f"{land.name():20} period   | truth {expected:.2f}  found {value:.2f}  ratio {value / expected:.2f}"


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--views", default=",".join(far_views.VIEWS))
    parser.add_argument("--slope", default="0", help="degrees, one or more with commas")
    parser.add_argument("--wind", default="0", help="m/s, one or more with commas")
    parser.add_argument("--grass", default="meadow", help="shipped sets, one or more with commas")
    parser.add_argument("--away", action="store_true", help="the sun stands behind the slope")
    parser.add_argument(
        "--period", action="store_true", help="the spectrum at the patch's period too"
    )
    parser.add_argument("--ring", action="store_true", help="rings on the level field too")
    parser.add_argument("--fresh", action="store_true", help="makes the references again")
    parser.add_argument("--pictures", type=Path, help="folder for truth and found side by side")
    parser.add_argument(
        "--shaders", help="a folder of shaders to try, in the place of those of the source"
    )
    parser.add_argument("arguments", nargs="*", help="of sward, after --")
    options = parser.parse_args()
    if options.fresh:
        shutil.rmtree(CACHE, ignore_errors=True)
    over = 0
    print(far_views.HEADER)
    for grass, slope in itertools.product(options.grass.split(","), options.slope.split(",")):
        for wind in options.wind.split(","):
            land = far_views.Land(float(slope), float(wind), options.away, grass)
            for name in options.views.split(","):
                view = far_views.VIEWS[name]
                truth, found = (
                    far_views.reference(land, view, CACHE),
                    far_views.far(land, view, options.arguments, options.shaders),
                )
                result = far_views.figures(truth, found)
                over += bool(far_views.failures(result))
                print(far_views.line(land, name, result), flush=True)
                if options.pictures:
                    write_picture(options.pictures / f"{land.name()}_{name}.png", truth, found)
            if options.period:
                print(period_line(land, options.arguments), flush=True)
    if options.ring:
        print(
            "ring     | contrast {:.3f}  luminance {:.3f}".format(
                *far_views.ring_change(options.arguments)
            )
        )
    sys.exit(1 if over else 0)


if __name__ == "__main__":
    main()
