#!/usr/bin/env python3
"""Runs the tests of tests/godot/addon, GDScript, inside $GODOT with the add-on of demo_project/godot.

Arguments are names of tests. Warnings and errors that Godot logs fail the run, but for those that tests ask for. Last line:
N passed, N failed, N skipped.
"""

import os
import re
import shutil
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project"))
import godot_project  # noqa: E402

FOLDER = os.path.join(ROOT, "build", "godot_addon")
SOURCES = os.path.join(ROOT, "tests", "godot", "addon")
# (what a message has, how often it is logged): asked for by a test, once each.
EXPECTED = (
    ("technique is no such technique, must be", 1),
    ("penumbra_outer_width is -5, must be", 1),
    ("penumbra_outer_width is nan, must be", 1),
    ("has an orthogonal projection", 1),
)


def write_project():
    """The demo's project with the tests in it."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    shutil.copytree(godot_project.PROJECT, FOLDER, ignore=shutil.ignore_patterns(".godot"))
    shutil.copytree(SOURCES, os.path.join(FOLDER, "tests"))
    with open(os.path.join(FOLDER, "tests", "suite.tscn"), "w", encoding="utf-8") as file:
        file.write('[gd_scene format=3]\n\n[ext_resource type="Script" path="res://tests/suite.gd" id="1"]\n\n')
        file.write('[node name="Suite" type="Node"]\nscript = ExtResource("1")\n')


def find_unexpected(output, is_whole):
    """Messages that no test asked for, and those asked for that did not come as often as they should."""
    unexpected = []
    counts = dict.fromkeys((text for text, _count in EXPECTED), 0)
    for line in godot_project.find_messages(output):
        asked = [text for text in counts if text in line]
        for text in asked:
            counts[text] += 1
        if not asked:
            unexpected.append("Godot logged " + line)
    for text, count in EXPECTED:
        if counts[text] > count or (is_whole and counts[text] < count):
            unexpected.append('"%s" was logged %d times, %d are expected' % (text, counts[text], count))
    return unexpected


def main():
    write_project()
    godot_project.prepare(FOLDER)
    output = godot_project.run("res://tests/suite.tscn", sys.argv[1:], 200, FOLDER)
    print(output)
    passed = re.findall(r"^PASS (\w+)$", output, re.MULTILINE)
    failures = re.findall(r"^FAIL (.*)$", output, re.MULTILINE)
    failures += find_unexpected(output, len(sys.argv) == 1)
    if not passed and not failures:
        failures.append("no test ran")
    for failure in failures:
        print("FAILED: " + failure)
    print("%d passed, %d failed, 0 skipped" % (len(passed), len(failures)))
    return 0 if not failures else 1


if __name__ == "__main__":
    sys.exit(main())
