"""Writes build/godot_addon: the demo's Godot project with the add-on's tests."""

import os
import shutil
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project"))
import godot_project  # noqa: E402

FOLDER = os.path.join(ROOT, "build", "godot_addon")
SOURCES = os.path.join(ROOT, "tests", "godot", "addon")


def write(folder=FOLDER, sources=SOURCES):
    """Write the project from scratch, with the tests of the folder `sources` in res://tests."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(godot_project.PROJECT, folder, ignore=shutil.ignore_patterns(".godot"))
    shutil.copytree(sources, os.path.join(folder, "tests"))
    with open(os.path.join(folder, "project.godot"), "a", encoding="utf-8") as file:
        file.write("\n[rendering]\n\ngnomon/gradual_compilation=false\n")  # tests look at the first frames
    godot_project.prepare(folder)


def report(passed, failures, skipped=0):
    """Print the failures and the summary line. Return the exit code."""
    if not passed and not failures:
        failures = ["no test ran"]
    for failure in failures:
        print("FAILED: " + failure)
    print("%d passed, %d failed, %d skipped" % (len(passed), len(failures), skipped))
    return 0 if not failures else 1
