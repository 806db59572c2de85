#!/usr/bin/env python3
"""Measures edge_count in a large world of make_world.py against pcss with 32 taps and 4 cascades, and against the reference.

    measure_world.py [--program PROGRAM] [--rounds N] [--frames N] [--size WxH] [--samples N] [--errors-only | --times-only]
                     [--seed N] [--casters N] [--extent METRES] [--mesh-per-caster]

Prints one table of times: medians of the light's passes, of the whole frame and of the host's part of it, with everything
moving and with nothing moving, edge_count over pcss. The runs of both techniques alternate. A second table has the errors.
"""

import argparse
import json
import os
import statistics
import tempfile

import make_world
from driver import PROGRAM, format_table, run
from measure_techniques import find_reference

TECHNIQUES = {"edge_count": (), "pcss": ("pcss_taps=32", "pcss_cascades=4")}
RATE_BASE = 100_000  # wrong receivers are counted per this number of receivers


class World:
    """One world and how it is drawn."""

    def __init__(self, program, path, size, folder):
        self.program, self.path, self.size, self.folder = program, path, size, folder

    def draw(self, technique, settings, *more):
        """Draw a mask and return its path."""
        out = os.path.join(self.folder, technique + ".exr")
        arguments = [word for setting in settings for word in ("--set", setting)]
        run([self.program, "visibility", self.path, "--technique", technique, "--size", self.size, "--out", out, *arguments, *more])
        return out

    def measure(self, technique, frame_count, is_still):
        """Return the times of a run in ms: of the light's passes, of the frame, and of the frame's part on the host."""
        times = os.path.join(self.folder, "times.json")
        still = ["--still"] if is_still else []
        self.draw(technique, TECHNIQUES[technique], "--time", times, "--timed-frames", str(frame_count), *still)
        with open(times, encoding="utf-8") as file:
            result = json.load(file)
        return result["total"]["gpu_ms"], result["call_ms"], result["call_ms"] - result["frame"]["gpu_ms"]


def measure_times(world, rounds, frame_count):
    rows = []
    for is_still in (False, True):
        runs = [{name: world.measure(name, frame_count, is_still) for name in TECHNIQUES} for _ in range(rounds)]
        for index, what in enumerate(("light", "frame", "host")):
            own, pcss = ([times[name][index] for times in runs] for name in TECHNIQUES)
            # The ratio of each round, so that the machine's load affects both times alike.
            ratio = statistics.median(a / b for a, b in zip(own, pcss))
            rows.append(("nothing moves" if is_still else "all moves", what,
                         "%.1f" % statistics.median(own), "%.1f" % statistics.median(pcss), "%.2f" % ratio))  # fmt: skip
    return format_table(("", "time of", "`edge_count` ms", "`pcss` ms", "ratio"), rows)


def measure_errors(world, sample_count):
    reference_id = find_reference()
    reference = world.draw(reference_id, ("%s_samples=%d" % (reference_id, sample_count),))
    rows = []
    for name, settings in TECHNIQUES.items():
        found = json.loads(run([world.program, "compare", reference, world.draw(name, settings)]))
        wrong = found["receiver"]["wrong"] * RATE_BASE
        rows.append(("`%s`" % name, "%.4f" % found["penumbra"]["mae"], found["penumbra"]["pixels"], "%.1f" % wrong, found["pixels"]))
    return format_table(("technique", "penumbra MAE", "penumbra pixels", "off by > 0.2 in %d" % RATE_BASE, "receivers"), rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=20, help="timed frames of a run")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--samples", type=int, default=1024, help="rays per pixel of the reference")
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--errors-only", action="store_true")
    only.add_argument("--times-only", action="store_true")
    make_world.add_arguments(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = make_world.save_world(folder, options.seed, options.casters, options.extent, options.mesh_per_caster)
        world = World(options.program, path, options.size, folder)
        if not options.errors_only:
            print("\n".join(measure_times(world, options.rounds, options.frames)), flush=True)
        if not options.times_only:
            print("\n".join(measure_errors(world, options.samples)), flush=True)


if __name__ == "__main__":
    main()
