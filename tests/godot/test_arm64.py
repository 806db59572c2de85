#!/usr/bin/env python3
"""Runs tests of tests/godot/addon inside Godot for Linux arm64, under QEMU with Mesa's software driver, and compares masks with those
of $GODOT.

demo_project/install_godot_arm64.sh gets that Godot. llvmpipe has subgroups of 4 on arm64 and of 8 on x86_64. With --full there are more
tests, and masks of more techniques. Last line: N passed, N failed, N skipped.
"""

import argparse
import os
import re
import shutil
import sys
import time

import addon_project
import godot_images
import godot_project

sys.path.insert(0, os.path.join(addon_project.ROOT, "tests", "platforms"))
from library_file import LibraryFile  # noqa: E402

FOLDER = os.path.join(addon_project.ROOT, "build", "godot_arm64")
GODOT_ARM64 = os.path.join(FOLDER, "godot")
PROJECT = os.path.join(FOLDER, "project")
MASK_TEST = "test_masks_of_each_light_are_stored"
SUITE_SIZE = 200  # pixels, as suite.gd sets it
MASK_SIZE = 64  # pixels, of MASK_TEST
# None of the tests expects a message.
TESTS = (MASK_TEST, "test_properties_follow_the_technique", "test_packed_scenes_store_all_properties_that_were_set")
FULL_TESTS = (
    "test_a_light_that_grows_is_right_in_that_frame", "test_a_light_that_moves_is_right_in_that_frame",
    "test_every_technique_follows_a_light_in_that_frame", "test_a_caster_that_moves_is_right_in_that_frame",
    "test_holes_of_cut_out_materials_cast_nothing", "test_a_multimesh_casts_as_its_meshes_do", "test_a_skinned_mesh_casts_where_it_is_drawn",
    "test_blend_shapes_cast_where_they_are_drawn", "test_a_shader_with_a_light_of_its_own_reads_masks",
    "test_waves_of_a_shader_cast_as_they_are_drawn", "test_viewports_of_several_sizes_and_cameras_at_once")  # fmt: skip
# Of study/runner.gd. With --full their masks are compared too.
FULL_CASES = (
    "imported/Omni/edge_count", "imported/Spot/edge_count", "imported/Sun/edge_count", "omni/box/pcss", "spot/post/penumbra_fins",
    "directional/box/shadow_volume")  # fmt: skip
CASE_SIZE = 100  # pixels
TOLERANCE = 1.0 / 255.0
MIN_AGREEING = 0.9999  # fraction of the receivers within the tolerance; measured: all are equal


def run(godot, scene, options, size):
    """Run a scene with that Godot and print how long it took. Return its output."""
    begin = time.monotonic()
    arguments = ["--path", PROJECT, *godot_project.DEVICE_OPTIONS, "--disable-vsync", "--resolution", "%dx%d" % (size, size), scene, "--"]
    usual = os.environ["GODOT"]
    os.environ["GODOT"] = godot
    try:
        output = godot_project.run_godot(arguments + list(options))
    finally:
        os.environ["GODOT"] = usual
    print(output)
    print("%s %s: %.0f s" % (os.path.relpath(godot, addon_project.ROOT), scene, time.monotonic() - begin), flush=True)
    return output


def compare_masks(expected, found):
    """Return what differs, or "" if nothing does."""
    receivers = [(a, b) for a, b in zip(expected, found) if a >= 0.0 and b >= 0.0]
    max_other = (1.0 - MIN_AGREEING) * len(receivers)
    if len(expected) != len(found) or sum((a < 0.0) != (b < 0.0) for a, b in zip(expected, found)) > max_other:
        return "other pixels are receivers"
    other = sum(abs(a - b) > TOLERANCE for a, b in receivers)
    return "%d of %d receivers differ" % (other, len(receivers)) if other > max_other else ""


def load_masks(folder, size):
    """Return name -> mask of the .f32 files in a folder."""
    names = [name for name in os.listdir(folder) if name.endswith(".f32")]
    return {name: godot_images.load_rows(os.path.join(folder, name), size)[0] for name in sorted(names)}


def check_masks(expected, found, count):
    """Compare the masks of this machine and of arm64, of which there are `count`. Return (names of equal ones, failures)."""
    passed, failures = [], []
    for name in sorted(set(expected) | set(found)):
        problem = compare_masks(expected.get(name, ()), found.get(name, ()))
        print("%s: %d pixels are not equal" % (name, sum(a != b for a, b in zip(expected.get(name, ()), found.get(name, ())))))
        if problem:
            failures.append("%s: %s" % (name, problem))
        else:
            passed.append(name)
    if len(passed) + len(failures) != count:
        failures.append("%d masks were drawn, %d are expected" % (len(passed) + len(failures), count))
    return passed, failures


def run_suite(godot, tests):
    """Run tests of tests/godot/addon. Return (names of passed tests, failures, the masks that MASK_TEST stores)."""
    folder = os.path.join(PROJECT, "tests")
    for name in os.listdir(folder):
        if name.endswith(".f32"):
            os.remove(os.path.join(folder, name))
    output = run(godot, "res://tests/suite.tscn", tests, SUITE_SIZE)
    passed = re.findall(r"^PASS (\w+)$", output, re.MULTILINE)
    failures = re.findall(r"^FAIL (.*)$", output, re.MULTILINE)
    failures += ["Godot logged " + line for line in godot_project.find_messages(output)]
    failures += ["%s did not run" % test for test in tests if "TIME %s " % test not in output]
    return passed, failures, load_masks(folder, MASK_SIZE)


def run_cases(godot, folder):
    """Draw FULL_CASES. Return (what Godot logged, the masks)."""
    shutil.rmtree(folder, ignore_errors=True)
    output = run(godot, "res://study/runner.tscn", ["out=" + folder, "size=%d" % CASE_SIZE, "cases=" + ",".join(FULL_CASES)], CASE_SIZE)
    return ["Godot logged " + line for line in godot_project.find_messages(output)], load_masks(folder, CASE_SIZE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--full", action="store_true", help="more tests, and masks of more techniques")
    is_full = parser.parse_args().full
    program = os.path.join(FOLDER, "root", "usr", "bin", "godot")
    if LibraryFile(program).machine != "arm64":
        return addon_project.report([], ["%s is not for arm64" % program])
    addon_project.write(PROJECT)
    _, failures, expected = run_suite(os.environ["GODOT"], [MASK_TEST])
    passed, found_failures, found = run_suite(GODOT_ARM64, TESTS + (FULL_TESTS if is_full else ()))
    failures += found_failures
    masks_passed, masks_failures = check_masks(expected, found, 3)
    passed += masks_passed
    failures += masks_failures
    # A comparison that sees no difference between two lights' masks would see none between two platforms'.
    if not compare_masks(expected["mask_omni.f32"], found["mask_spot.f32"]):
        failures.append("the masks of two lights do not differ")
    if is_full:
        logged, expected = run_cases(os.environ["GODOT"], os.path.join(FOLDER, "cases"))
        logged_arm64, found = run_cases(GODOT_ARM64, os.path.join(FOLDER, "cases_arm64"))
        masks_passed, masks_failures = check_masks(expected, found, len(FULL_CASES))
        passed += masks_passed
        failures += logged + logged_arm64 + masks_failures
    return addon_project.report(passed, failures)


if __name__ == "__main__":
    sys.exit(main())
