#!/usr/bin/env python3
"""Masks that the add-on makes inside Godot equal those of `gnomon visibility` for the same scene.

$GODOT renders the study scenes of demo_project/godot and exports them as glTF. Of the pixels that are receivers in both masks, 99.9 % must
agree within 1/255. Pixels that are receivers in only one, at outlines, are counted separately. The techniques are those of
study/runner.gd. three_lights is imported by Godot, which then draws it with fewer triangles; kitbash and grass are generated scenes with
which no technique was tuned.

Cut-out scenes, leaves and courtyard, are compared directly: both programs read the same file. Godot's importer rounds the file's
coordinates to 16 bits, so only 99.5 % of the receivers must agree, within 2/255. The same holds for courtyard at four times of its
animation, in which a skinned figure walks and a flag of morph targets waves.

A failed case leaves images in build/godot_masks: NAME_godot.png, NAME_gnomon.png, and NAME_difference.png, 16 times as bright.
Last line: N passed, N failed, N skipped.
"""

import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENES = os.path.join(ROOT, "demo_project", "scenes")
sys.path[:0] = [os.path.join(ROOT, "demo_project"), SCENES, os.path.join(ROOT, "tests", "benchmark")]
import gltf_writer  # noqa: E402
import godot_images  # noqa: E402
import godot_project  # noqa: E402
import make_artist_scenes  # noqa: E402
import make_foliage_scenes  # noqa: E402
from mask_file import load_mask  # noqa: E402

UNTUNED_LIGHTS = [(scene, light) for scene in ("kitbash", "grass") for light in ("Spot", "Omni", "Sun")]
CUT_OUT_LIGHTS = [("leaves", "Spot"), ("courtyard", "Sun"), ("courtyard", "Lamp")]
# Whole frames of the 30 in a second to which Godot's importer resamples cubic splines.
WALK_TIMES = ("0.7", "2.2", "3.6", "5.1")
WALK_LIGHTS = [("courtyard", "%s@%s" % (light, time)) for light in ("Sun", "Lamp") for time in WALK_TIMES]
# Cases of study/runner.gd: 3 lights x 4 casters x 4 techniques, 3 of three_lights, 6 untuned ones, and 11 cut-out ones x 2
# techniques.
CASE_COUNT = 79
OUT = os.path.join(ROOT, "build", "godot_masks")
FILES = os.path.join(OUT, "files")
SIZE = 400
# Tolerance, and the fraction of receivers that must be within it.
EXPORTED = (1.0 / 255.0, 0.999)
SAME_FILE = (2.0 / 255.0, 0.995)
DIFFERENCE_GAIN = 16.0
MAX_OUTLINE_FRACTION = 0.001  # of all receivers


def get_path(scene):
    return os.path.join(FILES, scene + ".gltf")


def make_scenes():
    """Write the generated scenes without scene_size. Godot's scenes have none, so add-on and program derive it from the casters."""
    for module, lights in ((make_artist_scenes, UNTUNED_LIGHTS), (make_foliage_scenes, CUT_OUT_LIGHTS)):
        for scene in sorted({scene for scene, _light in lights}):
            document = module.build_scene(scene)
            del document.root["scenes"][0]["extras"]["scene_size"]
            gltf_writer.save_files(document.build_files(scene), FILES)


def render_in_program(gltf, light, technique, out):
    """Compute the mask with bin/gnomon. light: LIGHT, or LIGHT@SECONDS for a time of the file's animation."""
    light, _at, seconds = light.partition("@")
    command = [os.path.join(ROOT, "bin", "gnomon"), "visibility", gltf, "--technique", technique, "--light", light, "--out", out]
    command += ["--size", "%dx%d" % (SIZE, SIZE), "--depth-alone", "--validation"]
    command += ["--at", seconds] if seconds else []
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise SystemExit("FAILED: %s\n%s" % (" ".join(command), done.stdout))
    return load_mask(out)


def save_images(name, found, expected):
    shown = [value if receiver >= 0.5 else -1.0 for value, receiver in zip(expected.visibility, expected.receiver)]
    differences = [min(abs(a - b) * DIFFERENCE_GAIN, 1.0) if min(a, b) >= 0.0 else -1.0 for a, b in zip(found, shown)]
    for kind, values in (("godot", found), ("gnomon", shown), ("difference", differences)):
        godot_images.save_gray_png("%s_%s.png" % (name, kind), values, SIZE)


def check_case(light, caster, technique):
    """Compare one mask of Godot and return what is wrong, or "". light, caster: those of a study scene, or a scene and its light."""
    stem = os.path.join(OUT, "%s_%s" % (light, caster))
    name = "%s_%s" % (stem, technique)
    found, _height = godot_images.load_rows(name + ".f32", SIZE)
    is_cut_out = (light, caster) in CUT_OUT_LIGHTS + WALK_LIGHTS
    is_scene = is_cut_out or light == "imported" or (light, caster) in UNTUNED_LIGHTS
    gltf = get_path(light) if is_cut_out else stem + ".gltf"
    tolerance, min_equal = SAME_FILE if is_cut_out else EXPORTED
    expected = render_in_program(gltf, caster if is_scene else "Light", technique, name + ".exr")
    both = equal = outline = shadowed = 0
    for pixel, value in enumerate(found):
        if (value >= 0.0) != (expected.receiver[pixel] >= 0.5):
            outline += 1
        elif value >= 0.0:
            both += 1
            equal += abs(value - expected.visibility[pixel]) <= tolerance
            shadowed += value < 0.5
    print("%s: %d receivers, %.4f %% equal, %d at outlines" % (os.path.basename(name), both, 100.0 * equal / max(both, 1), outline))
    problem = ""
    if both < SIZE * SIZE / 4 or shadowed < 100:
        problem = "%d receivers, %d in shadow: not the study scene" % (both, shadowed)
    elif equal < min_equal * both or outline > MAX_OUTLINE_FRACTION * both:
        problem = "%d of %d receivers differ, %d pixels are receivers in only one mask" % (both - equal, both, outline)
    if problem:
        save_images(name, found, expected)
    return problem


def main():
    shutil.rmtree(OUT, ignore_errors=True)
    godot_project.prepare()
    make_scenes()
    options = ["out=" + OUT, "size=%d" % SIZE]
    for option, lights in (("file_lights", UNTUNED_LIGHTS), ("cut_out_lights", CUT_OUT_LIGHTS + WALK_LIGHTS)):
        options.append(option + "=" + ",".join("%s/%s" % (get_path(scene), light) for scene, light in lights))
    output = godot_project.run("res://study/runner.tscn", options, SIZE)
    failures = ["Godot logged " + line for line in godot_project.find_messages(output)]
    passed = compared = 0
    for name in sorted(os.listdir(OUT)):
        if name.endswith(".f32"):
            light, caster, technique = name[: -len(".f32")].split("_", 2)
            problem = check_case(light, caster, technique)
            passed += not problem
            compared += 1
            if problem:
                failures.append("%s: %s" % (name, problem))
    if compared < CASE_COUNT:
        failures.append("%d cases ran, %d are expected" % (compared, CASE_COUNT))
    for failure in failures:
        print("FAILED: " + failure)
    print("%d passed, %d failed, 0 skipped" % (passed, len(failures)))
    return 0 if not failures else 1


if __name__ == "__main__":
    sys.exit(main())
