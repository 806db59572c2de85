#!/usr/bin/env python3
"""Masks that the add-on makes inside Godot equal those of `gnomon visibility` for the same scene.

$GODOT renders the study scenes of demo_project/godot and exports them as glTF. Receivers that both have must agree within
1/255 in 99.9 % of the pixels; pixels that only one has, outlines, are counted apart. The techniques are those of
study/runner.gd. three_lights is imported by Godot, which then draws it with fewer triangles; kitbash and grass are generated scenes that
nothing here was written for. Last line: N passed, N failed, N skipped.
"""

import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "demo_project"), os.path.join(ROOT, "tests", "benchmark")]
import godot_images  # noqa: E402
import godot_project  # noqa: E402
from mask_file import load_mask  # noqa: E402

SCENES = os.path.join(ROOT, "demo_project", "scenes")
GENERATED = ("kitbash", "grass")
OUT = os.path.join(ROOT, "build", "godot_masks")
SIZE = 400
TOLERANCE = 1.0 / 255.0
LEAST_EQUAL = 0.999
MOST_OUTLINE = 0.001  # of all receivers


def render_in_program(gltf, light, technique, out):
    command = [os.path.join(ROOT, "bin", "gnomon"), "visibility", gltf, "--technique", technique, "--light", light, "--out", out]
    command += ["--size", "%dx%d" % (SIZE, SIZE), "--depth-alone", "--validation"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise SystemExit("FAILED: %s\n%s" % (" ".join(command), done.stdout))
    return load_mask(out)


def check_case(light, caster, technique):
    """What is wrong; empty when nothing is."""
    stem = os.path.join(OUT, "%s_%s" % (light, caster))
    name = "%s_%s" % (stem, technique)
    found, _height = godot_images.load_rows(name + ".f32", SIZE)
    in_file = caster if light in ("imported",) + GENERATED else "Light"
    expected = render_in_program(stem + ".gltf", in_file, technique, name + ".exr")
    both = equal = outline = shadowed = 0
    for pixel, value in enumerate(found):
        if (value >= 0.0) != (expected.receiver[pixel] >= 0.5):
            outline += 1
        elif value >= 0.0:
            both += 1
            equal += abs(value - expected.visibility[pixel]) <= TOLERANCE
            shadowed += value < 0.5
    print("%s: %d receivers, %.4f %% equal, %d at outlines" % (os.path.basename(name), both, 100.0 * equal / max(both, 1), outline))
    if both < SIZE * SIZE / 4 or shadowed < 100:
        return "%d receivers, %d in shadow: not the study scene" % (both, shadowed)
    if equal < LEAST_EQUAL * both or outline > MOST_OUTLINE * both:
        return "%d of %d receivers differ, %d pixels have one in one alone" % (both - equal, both, outline)
    return ""


def main():
    shutil.rmtree(OUT, ignore_errors=True)
    godot_project.prepare()
    scenes = [os.path.join(SCENES, name + ".gltf") for name in GENERATED]
    if not all(map(os.path.exists, scenes)):
        subprocess.run([sys.executable, os.path.join(SCENES, "make_artist_scenes.py")], check=True)
    options = ["out=" + OUT, "size=%d" % SIZE, "scenes=" + ",".join(scenes)]
    output = godot_project.run("res://study/runner.tscn", options, SIZE)
    failures = ["Godot logged " + line for line in godot_project.find_messages(output)]
    passed = 0
    for name in sorted(os.listdir(OUT)):
        if name.endswith(".f32"):
            light, caster, technique = name[: -len(".f32")].split("_", 2)
            problem = check_case(light, caster, technique)
            passed += not problem
            if problem:
                failures.append("%s: %s" % (name, problem))
    if passed + len(failures) < 57:
        failures.append("%d cases ran, 57 are expected" % passed)
    for failure in failures:
        print("FAILED: " + failure)
    print("%d passed, %d failed, 0 skipped" % (passed, len(failures)))
    return 0 if not failures else 1


if __name__ == "__main__":
    sys.exit(main())
