#!/usr/bin/env python3
"""Measures what copies of a model cost: 64 copies that share meshes and textures, compared with one.

    measure_copies.py [--copies N] [--seed N] [--size WxH] [--frames N] [--techniques A,B]

Prints one row for each technique: the peak of the host memory, the CPU time to load the file and draw the first frame, and the CPU time
of each further frame, all with the ratio to one copy. CPU times are user and system time of all threads; software drivers draw with them.
"""

import argparse
import os
import subprocess
import sys
import tempfile

from copies import write_copies
from driver import PROGRAM, format_row


def run(path, technique, size, frames, folder):
    """Draw frames in a process. Return its CPU time in s and its peak memory in MB."""
    command = [PROGRAM, "visibility", path, "--technique", technique, "--size", size, "--frames", str(frames)]
    process = subprocess.Popen([*command, "--out", os.path.join(folder, "mask.exr")], stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit("ERROR: %s ended with %d. Run it to see why." % (" ".join(command), status))
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0


def measure(path, technique, size, frames, folder):
    """Return peak memory in MB, and CPU times in s of the start and of each further frame."""
    start_s, _ = run(path, technique, size, 1, folder)
    all_s, peak_mb = run(path, technique, size, 1 + frames, folder)
    return peak_mb, start_s, max(all_s - start_s, 1e-3) / frames


def main():
    parser = argparse.ArgumentParser(description="Measures what copies of a model cost.")
    parser.add_argument("--copies", type=int, default=64, help="default: %(default)s")
    parser.add_argument("--seed", type=int, default=1, help="of the model; default: %(default)s")
    parser.add_argument("--size", default="512x512", help="default: %(default)s")
    parser.add_argument("--frames", type=int, default=20, help="further frames; default: %(default)s")
    parser.add_argument("--techniques", default="edge_count,shadow_map", help="default: %(default)s")
    options = parser.parse_args()
    print(format_row("technique", "memory MB", "ratio", "start s", "ratio", "frame s", "ratio"))
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, "copies_%d.gltf" % count) for count in (1, options.copies)]
        for path, count in zip(paths, (1, options.copies)):
            write_copies(path, count, options.seed)
        for technique in options.techniques.split(","):
            one, many = (measure(path, technique, options.size, options.frames, folder) for path in paths)
            cells = []
            for first, second in zip(one, many):
                cells += ["%.3g, %.3g" % (first, second), "%.1f" % (second / first)]
            print(format_row(technique, *cells), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
