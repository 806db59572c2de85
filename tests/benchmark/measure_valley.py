#!/usr/bin/env python3
"""Measures the errors of edge_count and pcss (32 taps, 4 cascades) along the walk through the valley of make_valley.py.

    measure_valley.py [--program PROGRAM] [--frames N] [--size WxH] [--samples N] [--seed N] [--small]

Frames are spread evenly over the walk. Prints a table: for each sun and technique, receivers nearer than 50 m and beyond,
penumbra MAE over all their penumbra pixels, and how many receivers in 100,000 are off by more than 0.2.
"""

import argparse
import array
import json
import os
import tempfile

from driver import PROGRAM, SCENES, format_table, run
from mask_file import load_mask
from measure_techniques import find_reference
from measure_world import RATE_BASE, TECHNIQUES

NEAR_M = 50.0  # along the view
WALK_S = 20.0
SUNS = ("Low", "High", "Overcast")
WRONG = 0.2


class Errors:
    """Errors of one technique over a set of receivers."""

    def __init__(self):
        self.receivers = self.wrong = self.penumbra = 0
        self.penumbra_sum = 0.0

    def add(self, error, is_in_penumbra):
        self.receivers += 1
        self.wrong += error > WRONG
        self.penumbra += is_in_penumbra
        self.penumbra_sum += error * is_in_penumbra

    def describe(self):
        mean = "%.4f" % (self.penumbra_sum / self.penumbra) if self.penumbra else ""
        wrong = "%.1f" % (self.wrong / self.receivers * RATE_BASE) if self.receivers else ""
        return mean, self.penumbra, wrong, self.receivers


def load_distances(path, near_m):
    """Return the distances along the view in m of the depths, 0 where nothing is seen, that --surfaces wrote."""
    depths = array.array("f")
    with open(path, "rb") as file:
        depths.frombytes(file.read())
    return [near_m / depth if depth > 0.0 else 0.0 for depth in depths]  # depth is 0 at infinity, see doc/embedding.md


def draw(program, path, light, time_s, technique, settings, size, folder, *more):
    out = os.path.join(folder, "mask.exr")
    arguments = [word for setting in settings for word in ("--set", setting)]
    run([program, "visibility", path, "--light", light, "--at", "%.6f" % time_s, "--technique", technique, "--size", size,
         "--out", out, *arguments, *more])  # fmt: skip
    return load_mask(out)


def measure_frame(program, path, light, time_s, options, folder, errors):
    """Add the errors of one frame. errors: by technique and whether the receivers are near."""
    with open(path, encoding="utf-8") as file:
        near_m = json.load(file)["cameras"][0]["perspective"]["znear"]
    reference_id = find_reference()
    samples = ("%s_samples=%d" % (reference_id, options.samples),)
    reference = draw(program, path, light, time_s, reference_id, samples, options.size, folder, "--surfaces", folder)
    distances = load_distances(os.path.join(folder, "depth.f32"), near_m)
    penumbra = set(reference.find_penumbra())
    for technique, settings in TECHNIQUES.items():
        mask = draw(program, path, light, time_s, technique, settings, options.size, folder)
        for i, receiver in enumerate(reference.receiver):
            if receiver >= 0.5:
                error = abs(mask.visibility[i] - reference.visibility[i])
                errors[technique, distances[i] < NEAR_M].add(error, i in penumbra)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--samples", type=int, default=1024, help="rays per pixel of the reference")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--small", action="store_true", help="20,000 casters on a terrain of 65,000 triangles")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        form = ["--small"] if options.small else []
        path = run([os.path.join(SCENES, "make_valley.py"), "--out", folder, "--seed", str(options.seed), *form]).strip()
        for light in SUNS:
            errors = {(technique, is_near): Errors() for technique in TECHNIQUES for is_near in (True, False)}
            for frame in range(options.frames):
                time_s = WALK_S * frame / options.frames
                measure_frame(options.program, path, light, time_s, options, folder, errors)
            for (technique, is_near), found in errors.items():
                where = "nearer than %.0f m" % NEAR_M if is_near else "beyond"
                rows.append((light, "`%s`" % technique, where, *found.describe()))
    header = ("sun", "technique", "receivers", "penumbra MAE", "penumbra pixels", "off by > 0.2 in %d" % RATE_BASE, "receivers")
    print("\n".join(format_table(header, rows)), flush=True)


if __name__ == "__main__":
    main()
