#!/usr/bin/env python3
"""2,000 frames inside $GODOT in which everything comes and goes (tests/godot/addon/soak.gd): no message, and no growth.

After the first 200 frames Godot's objects, nodes and resources must stay as many, and the memory of its RenderingDevice
must not grow. Last line: N passed, N failed, N skipped.
"""

import re
import sys

import addon_project
import godot_project

FRAMES = 2000
SETTLED = 200
NAMES = ("objects", "nodes", "resources", "bytes of textures", "bytes of buffers", "bytes of the device")
PROCESS_GROWTH = 1.1  # of the process's memory, which the allocator and the driver round


def find_growth(reports):
    """What is more at the end than after the first frames."""
    settled = [report for report in reports if report[0] >= SETTLED]
    first, last = settled[0], settled[-1]
    grown = []
    for index, name in enumerate(NAMES, 1):
        if last[index] > first[index]:
            grown.append("%d %s after %d frames, %d after %d" % (first[index], name, first[0], last[index], last[0]))
    if last[-1] > PROCESS_GROWTH * first[-1]:
        grown.append("%d KiB of memory after %d frames, %d after %d" % (first[-1], first[0], last[-1], last[0]))
    return grown


def main():
    addon_project.write()
    output = godot_project.run("res://tests/soak.tscn", [], 96, addon_project.FOLDER)
    reports = [tuple(map(int, line.split()[1:])) for line in re.findall(r"^SOAK .*$", output, re.MULTILINE)]
    for report in reports:
        print("frame %d: %s, %d KiB" % (report[0], ", ".join("%d %s" % pair for pair in zip(report[1:], NAMES)), report[-1]))
    failures = ["Godot logged " + line for line in godot_project.find_messages(output)]
    if not reports or reports[-1][0] != FRAMES:
        failures.append("it did not draw %d frames" % FRAMES)
    else:
        failures += find_growth(reports)
    for failure in failures:
        print("FAILED: " + failure)
    print("%d passed, %d failed, 0 skipped" % (not failures, len(failures)))
    return 0 if not failures else 1


if __name__ == "__main__":
    sys.exit(main())
