#!/usr/bin/env python3
"""Measures the CPU time of a frame in worlds of make_world.py with few and with many casters.

    measure_host.py [--program PROGRAM] [--rounds N] [--casters N,N] [--moving N] [--technique ID] [--size WxH]

For each world `gnomon run --time` measures frames in which nothing moves and frames in which an animation moves --moving
casters (or all, where there are fewer). The host's time is the CPU time of the main thread, with reading the scene's nodes.
The table has medians over the rounds, and the most casters' time over the fewest casters'.
"""

import argparse
import json
import os
import statistics
import tempfile

import make_world
from driver import PROGRAM, format_table, run


def measure(options, path, folder, mode):
    """Return the host's time of a frame in ms."""
    times = os.path.join(folder, "times.json")
    run([options.program, "run", path, "--headless", "--technique", options.technique, "--size", options.size,
         "--antialiasing", "1", "--time", times, mode])  # fmt: skip
    with open(times, encoding="utf-8") as file:
        result = json.load(file)
    return result["host_ms"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--casters", default="20,20000", help="numbers of casters")
    parser.add_argument("--moving", type=int, default=200)
    parser.add_argument("--technique", default="edge_count")
    parser.add_argument("--size", default="640x360")
    options = parser.parse_args()
    counts = [int(count) for count in options.casters.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        paths = [make_world.save_world(folder, caster_count=count, moving_count=min(options.moving, count)) for count in counts]
        rows = []
        for mode, what in (("--still", "nothing"), ("--playing", "%d casters" % options.moving)):
            rounds = [[measure(options, path, folder, mode) for path in paths] for _ in range(options.rounds)]
            medians = [statistics.median(times) for times in zip(*rounds)]
            ratio = statistics.median(times[-1] / times[0] for times in rounds)
            rows.append((what, *("%.2f" % ms for ms in medians), "%.1f" % ratio))
        print("\n".join(format_table(("moves", *("%d casters, ms" % count for count in counts), "ratio"), rows)))


if __name__ == "__main__":
    main()
