#!/usr/bin/env python3
"""Draws many frames inside $GODOT: nothing may be logged, and no resource count may grow.

These are frames in which everything is added and removed (tests/godot/addon/soak.gd), frames of the room with eight lights
(room_soak.gd), and of courtyard, in which a skinned figure walks and a flag of morph targets waves (walk_soak.gd); 400 of each,
with --full 2,000, 2,000 and 1,000. After SETTLED frames the numbers of Godot's objects, nodes and resources and the memory of its
RenderingDevice must not grow. Last line: N passed, N failed, N skipped.
"""

import argparse
import os
import re
import sys

import addon_project
import godot_project

sys.path.insert(0, os.path.join(addon_project.ROOT, "demo_project", "scenes"))
import gltf_writer  # noqa: E402
import make_foliage_scenes  # noqa: E402

FOLDER = os.path.join(addon_project.ROOT, "build", "godot_soak")
FRAMES = {"soak": 400, "room_soak": 400, "walk_soak": 400}  # hundreds, more than SETTLED
FULL_FRAMES = {"soak": 2000, "room_soak": 2000, "walk_soak": 1000}
SETTLED = 200  # frames; after so many the motion of the room starts again
NAMES = ("objects", "nodes", "resources", "bytes of textures", "bytes of buffers", "bytes of the device")
PROCESS_GROWTH = 1.1  # allowed factor of the process's memory, which the allocator and the driver round up


def find_growth(reports):
    """Return a message for each count that is higher at the end than after SETTLED frames, and for memory of the process
    that is more than PROCESS_GROWTH times as much. reports: the numbers of each line of soak_report.gd."""
    settled = [report for report in reports if report[0] >= SETTLED]
    first, last = settled[0], settled[-1]
    grown = []
    for index, name in enumerate(NAMES, 1):
        if last[index] > first[index]:
            grown.append("%d %s after %d frames, %d after %d" % (first[index], name, first[0], last[index], last[0]))
    if last[-1] > PROCESS_GROWTH * first[-1]:
        grown.append("%d KiB of memory after %d frames, %d after %d" % (first[-1], first[0], last[-1], last[0]))
    return grown


def soak(scene, frames, options):
    """Return what is wrong; empty if nothing is."""
    output = godot_project.run("res://tests/%s.tscn" % scene, [str(frames)] + options, 96, FOLDER)
    reports = [tuple(map(int, line.split()[1:])) for line in re.findall(r"^SOAK .*$", output, re.MULTILINE)]
    for report in reports:
        print("%s, frame %d: %s, %d KiB" % (scene, report[0], ", ".join("%d %s" % pair for pair in zip(report[1:], NAMES)), report[-1]))
    failures = ["%s: Godot logged %s" % (scene, line) for line in godot_project.find_messages(output)]
    if not reports or reports[-1][0] != frames:
        return failures + ["%s did not draw %d frames" % (scene, frames)]
    return failures + ["%s: %s" % (scene, growth) for growth in find_growth(reports)]


def make_walk():
    """Write courtyard as a glTF file and return its path."""
    folder = os.path.join(FOLDER, "walk")
    os.makedirs(folder)
    open(os.path.join(folder, ".gdignore"), "w").close()  # keeps Godot from importing it: the game reads it at run time
    gltf_writer.save_files(make_foliage_scenes.build_scene("courtyard").build_files("courtyard"), folder)
    return os.path.join(folder, "courtyard.gltf")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--full", action="store_true", help="draw several times as many frames")
    frames = FULL_FRAMES if parser.parse_args().full else FRAMES
    addon_project.write(FOLDER)
    options = {"walk_soak": [make_walk()]}
    results = {scene: soak(scene, count, options.get(scene, [])) for scene, count in frames.items()}
    passed = [scene for scene, failures in results.items() if not failures]
    return addon_project.report(passed, sum(results.values(), []))


if __name__ == "__main__":
    sys.exit(main())
