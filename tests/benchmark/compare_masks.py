#!/usr/bin/env python3
"""Stores masks that a program draws, and compares two such folders.

    compare_masks.py store --program PROGRAM --out DIR [--size WxH] [--scenes A,B] [--techniques A,B] [--jobs N]
                           [--set PROPERTY=VALUE]...
    compare_masks.py corpus --program PROGRAM --out DIR [--size WxH] [--scenes A,B] [--lights A,B] [--radii A,B]
                            [--kinds A,B] [--jobs N]
    compare_masks.py compare BEFORE AFTER

`store` draws all demo scenes, techniques and types of light. `corpus` draws edge_count only: 12 scenes, each with a spot,
an omni and a directional light of 0, 2, 10 and 30 % of the scene's size, with 64 and 256 points, without and with
interpolation, and its debug views "solids" and "edges". Run either with the program from before and from after a change,
on the same machine, then `compare`: it prints how each file differs, a summary per kind, and the largest difference by
name. The exit code is 1 if any file differs. To get the program of another commit, build it in a worktree of its own.
"""

import argparse
import concurrent.futures
import copy
import glob
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

from mask_file import compute_mean_error, load_mask
from driver import PROGRAM, SCENES, TIMEOUT_S, run

sys.path.insert(0, SCENES)
from gltf_writer import save_files  # noqa: E402
from make_artist_scenes import SCENES as ARTIST_SCENES  # noqa: E402
from make_artist_scenes import build_scene_files  # noqa: E402
from make_foliage_scenes import build_scene_files as build_foliage_files  # noqa: E402

TYPES = ("spot", "point", "directional")
LIGHTS = "KHR_lights_punctual"
SPOT = {"innerConeAngle": 0.6, "outerConeAngle": 0.7}
SIZE_M, ANGLE_DEGREES = 0.3, 5.0  # for lights whose original type lacks the property
# The corpus: scenes, and per kind of file the debug view of edge_count ("" for masks) and its settings.
STUDY_SCENES = ("sphere", "contact_box", "torus_knot", "stacked_layers", "clutter", "terrain", "open_sheets")
CORPUS_SCENES = (*STUDY_SCENES, *ARTIST_SCENES, "leaves", "courtyard")
RADII = (0.0, 0.02, 0.1, 0.3)  # of a light, as fractions of the scene's size
KINDS = {
    "256exact": ("", ("edge_count_quality=256", "edge_count_interpolation=0")),
    "64exact": ("", ("edge_count_quality=64", "edge_count_interpolation=0")),
    "256": ("", ("edge_count_quality=256",)),
    "64": ("", ("edge_count_quality=64",)),
    "solids": ("solids", ()),
    "edges": ("edges", ()),
}
MASK_STEP = 2.0**-11  # of R16F below 1


def list_lights(root):
    return root.get("extensions", {}).get(LIGHTS, {}).get("lights", [])


def change_type(light, kind):
    """Change the light's type in place. A size that the new type needs and the light lacks is set. Does nothing if it has the type."""
    if light["type"] == kind:
        return
    extras = light.setdefault("extras", {})
    light.pop("spot", None)
    light.pop("range", None)
    light["type"] = kind
    if kind == "directional":
        extras["light_angular_distance"] = extras.pop("light_angular_distance", ANGLE_DEGREES)
    else:
        extras["light_size"] = extras.get("light_size", SIZE_M)
    if kind == "spot":
        light["spot"] = SPOT


def write_variants(folder, scenes):
    """Write each scene once per light type, with all its lights of that type. Yield (path, light name)."""
    for path in scenes:
        with open(path, encoding="utf-8") as file:
            root = json.load(file)
        for name in {element["uri"] for element in root["buffers"] + root.get("images", []) if "uri" in element}:
            target = os.path.join(folder, name)
            if not os.path.exists(target):
                shutil.copy(os.path.join(os.path.dirname(path), name), target)
        stem = os.path.splitext(os.path.basename(path))[0]
        for kind in TYPES:
            variant = copy.deepcopy(root)
            for light in list_lights(variant):
                change_type(light, kind)
            out = os.path.join(folder, "%s_%s.gltf" % (stem, kind))
            with open(out, "w", encoding="utf-8") as file:
                json.dump(variant, file)
            for light in list_lights(variant):
                yield out, light["name"]


def list_techniques(program):
    return [technique["id"] for technique in json.loads(run([program, "techniques", "--json"]))]


def draw_files(options, jobs, make_command):
    """Run make_command(job), which returns a file name and a command that writes it to --out, for each job. Return the exit code."""
    os.makedirs(options.out, exist_ok=True)

    def draw(job):
        name, command = make_command(job)
        result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=TIMEOUT_S)
        return "" if result.returncode == 0 else "%s: %s" % (name, result.stderr.strip())

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        failed = [line for line in pool.map(draw, jobs) if line]
    for line in failed:
        print(line)
    print("%d files in %s, %d failed" % (len(jobs) - len(failed), options.out, len(failed)))
    return 1 if failed else 0


def find_stem(path):
    return os.path.splitext(os.path.basename(path))[0]


def list_settings(settings):
    return [word for setting in settings for word in ("--set", setting)]


def store(options):
    names = options.scenes.split(",") if options.scenes else ["*"]
    scenes = sorted(path for name in names for path in glob.glob(os.path.join(SCENES, name + ".gltf")))
    if not scenes:
        raise SystemExit("ERROR: no scene of %s matches %s." % (SCENES, options.scenes))
    techniques = options.techniques.split(",") if options.techniques else list_techniques(options.program)

    def make_command(job):
        (path, light), technique = job
        name = "%s_%s_%s.exr" % (find_stem(path), light, technique)
        command = [options.program, "visibility", path, "--light", light, "--technique", technique, "--size", options.size]
        return name, command + ["--out", os.path.join(options.out, name)] + list_settings(options.settings)

    with tempfile.TemporaryDirectory() as folder:
        jobs = [(image, technique) for image in write_variants(folder, scenes) for technique in techniques]
        return draw_files(options, jobs, make_command)


def choose(option, known, convert=str):
    """Return the items of a comma-separated option, all known ones if it is empty. Exits if one is unknown."""
    chosen = [convert(item) for item in option.split(",")] if option else list(known)
    unknown = [item for item in chosen if item not in known]
    if unknown:
        raise SystemExit("ERROR: unknown %s, must be of: %s." % (", ".join(map(str, unknown)), ", ".join(map(str, known))))
    return chosen


def make_corpus_scene(name, folder):
    """Return the path of one of CORPUS_SCENES. Those that the repository lacks are written to the folder."""
    path = os.path.join(SCENES, name + ".gltf")
    if name not in STUDY_SCENES:
        build = build_scene_files if name in ARTIST_SCENES else build_foliage_files
        save_files(build(name), folder)
        path = os.path.join(folder, name + ".gltf")
    return path


def corpus(options):
    scenes = choose(options.scenes, CORPUS_SCENES)
    types, radii = choose(options.lights, TYPES), choose(options.radii, RADII, float)
    kinds = choose(options.kinds, KINDS)

    def make_command(job):
        (path, light, scene_size_m), radius, kind = job
        view, settings = KINDS[kind]
        size = "light_size=%g" % (radius * scene_size_m)
        if path.endswith("_directional.gltf"):
            size = "light_angular_distance=%.6f" % (2 * math.degrees(math.atan(radius)))
        settings = (size, "penumbra_outer_width=-1", "penumbra_inner_width=-1", *settings)
        name = "%s_%g%%_%s.%s" % (find_stem(path), 100 * radius, kind, "png" if view else "exr")
        out = os.path.join(options.out, name)
        if not view:
            command = ["visibility", path, "--light", light, "--out", out, *list_settings(settings)]
        else:
            settings = ["light.%s.%s" % (light, setting) for setting in settings]
            command = ["run", path, "--headless", "--debug-view", view, "--antialiasing", "1", "--capture", out, *list_settings(settings)]
        return name, [options.program, *command, "--technique", "edge_count", "--size", options.size]

    with tempfile.TemporaryDirectory() as folder:
        images = []
        for name in scenes:
            path = make_corpus_scene(name, folder)
            with open(path, encoding="utf-8") as file:
                scene_size_m = json.load(file)["scenes"][0]["extras"]["scene_size"]
            first = {variant: light for variant, light in reversed(list(write_variants(folder, [path])))}  # each file's first light
            images += [(variant, light, scene_size_m) for variant, light in first.items()
                       if variant.rpartition("_")[2][: -len(".gltf")] in types]  # fmt: skip
        return draw_files(options, [(image, radius, kind) for image in images for radius in radii for kind in kinds], make_command)


class Difference:
    """How two files of masks or debug views differ. count: pixels that differ. largest, mean: of the absolute differences, over
    receivers for masks, over pixels for views. moved: pixels that are a receiver in one file only."""

    def __init__(self, text="", count=0, share=0.0, largest=0.0, mean=0.0, moved=0):
        self.text, self.count, self.share, self.largest, self.mean, self.moved = text, count, share, largest, mean, moved

    def __str__(self):
        return self.text or "%d pixels (%.4f %%) differ, by up to %.6f (%.1f steps of R16F), mean %.2g; %d changed between receiver and none" % (
            self.count, 100 * self.share, self.largest, self.largest / MASK_STEP, self.mean, self.moved)  # fmt: skip


def load_gray_levels(path):
    """Return width, height and the bytes of a PNG's red channel (debug views are gray), by ImageMagick."""
    data = subprocess.run(["convert", path, "-channel", "R", "-separate", "-depth", "8", "pgm:-"], capture_output=True, check=True).stdout
    width, height = map(int, data.split(maxsplit=3)[1:3])
    return width, height, data[-width * height :]


def find_difference(before, after):
    """Return the Difference of two files; None if they are equal byte for byte."""
    with open(before, "rb") as left, open(after, "rb") as right:
        if left.read() == right.read():
            return None
    if before.endswith(".png"):
        old, new = load_gray_levels(before), load_gray_levels(after)
        if old[:2] != new[:2]:
            return Difference("has another size")
        differences = [abs(a - b) / 255.0 for a, b in zip(old[2], new[2])]
        pixels, moved = len(differences), 0
        mean = sum(differences) / pixels
    else:
        try:
            old, new = load_mask(before), load_mask(after)
        except ValueError:  # a coloured mask of translucent casters, which load_mask() refuses
            return Difference("differs")
        if (old.width, old.height) != (new.width, new.height):
            return Difference("has another size")
        differences = [abs(a - b) for a, b in zip(old.visibility, new.visibility)]
        moved = sum(a != b for a, b in zip(old.receiver, new.receiver))
        receivers = [i for i, value in enumerate(old.receiver) if value >= 0.5]
        pixels, mean = max(len(receivers), 1), compute_mean_error(old, new, receivers)
    count = sum(difference > 0 for difference in differences)
    return Difference(count=count, share=count / pixels, largest=max(differences), mean=mean, moved=moved)


def summarize(kind, differences, file_count):
    """Print one line on the files of a kind. differences: name -> Difference."""
    if not differences:
        print("%s: %d files, all equal" % (kind, file_count))
        return
    worst = max(differences, key=lambda name: differences[name].largest)
    widest = max(differences, key=lambda name: differences[name].share)
    print("%s: %d files, %d differ; largest %.6f in %s; most pixels %.4f %% in %s; largest mean %.2g" % (
        kind, file_count, len(differences), differences[worst].largest, worst, 100 * differences[widest].share, widest,
        max(difference.mean for difference in differences.values())))  # fmt: skip


def compare(options):
    names = [{name for name in os.listdir(folder) if name.endswith((".exr", ".png"))} for folder in (options.before, options.after)]
    missing = sorted(names[0] ^ names[1])
    for name in missing:
        print("%s is in one folder only" % name)
    common = sorted(names[0] & names[1])
    if not common:
        raise SystemExit("ERROR: %s and %s have no file in common." % (options.before, options.after))
    differences = {}
    for name in common:
        difference = find_difference(os.path.join(options.before, name), os.path.join(options.after, name))
        if difference:
            differences[name] = difference
            print("%s: %s" % (name, difference))
    for kind in KINDS:
        files = [name for name in common if find_stem(name).endswith("_" + kind)]
        if files:
            summarize(kind, {name: differences[name] for name in files if name in differences}, len(files))
    print("%d files compared, %d differ, %d in one folder only" % (len(common), len(differences), len(missing)))
    return 1 if differences or missing else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    storing, drawing = commands.add_parser("store"), commands.add_parser("corpus")
    for command, size in ((storing, "200x200"), (drawing, "400x400")):
        command.add_argument("--program", default=PROGRAM)
        command.add_argument("--out", required=True)
        command.add_argument("--size", default=size)
        command.add_argument("--scenes", default="", help="scene names")
        command.add_argument("--jobs", type=int, default=os.cpu_count())
    storing.add_argument("--techniques", default="")
    storing.add_argument("--set", dest="settings", action="append", default=[])
    drawing.add_argument("--lights", default="", help="of: " + ", ".join(TYPES))
    drawing.add_argument("--radii", default="", help="of: " + ", ".join(map(str, RADII)))
    drawing.add_argument("--kinds", default="", help="of: " + ", ".join(KINDS))
    comparing = commands.add_parser("compare")
    comparing.add_argument("before")
    comparing.add_argument("after")
    options = parser.parse_args()
    return {"store": store, "corpus": corpus, "compare": compare}[options.command](options)


if __name__ == "__main__":
    sys.exit(main())
