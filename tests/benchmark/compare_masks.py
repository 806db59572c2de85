#!/usr/bin/env python3
"""Stores the masks of all demo scenes, techniques and types of light, and compares two such folders byte for byte.

    compare_masks.py store --program PROGRAM --out DIR [--size WxH] [--scenes A,B] [--techniques A,B] [--jobs N]
                           [--set PROPERTY=VALUE]...
    compare_masks.py compare BEFORE AFTER

For changes that must not alter any mask: run `store` with the program from before and from after the change, on the same
machine, then `compare`. The last line states how many masks differ. The exit code is 1 if any does.
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

from mask_file import load_mask
from driver import PROGRAM, SCENES, TIMEOUT_S, run

TYPES = ("spot", "point", "directional")
LIGHTS = "KHR_lights_punctual"
SPOT = {"innerConeAngle": 0.6, "outerConeAngle": 0.7}
SIZE_M, ANGLE_DEGREES = 0.3, 5.0  # for lights whose original type lacks the property


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


def store(options):
    names = options.scenes.split(",") if options.scenes else ["*"]
    scenes = sorted(path for name in names for path in glob.glob(os.path.join(SCENES, name + ".gltf")))
    if not scenes:
        raise SystemExit("ERROR: no scene of %s matches %s." % (SCENES, options.scenes))
    techniques = options.techniques.split(",") if options.techniques else list_techniques(options.program)
    settings = [word for setting in options.settings for word in ("--set", setting)]
    os.makedirs(options.out, exist_ok=True)

    def draw(job):
        (path, light), technique = job
        stem = os.path.splitext(os.path.basename(path))[0]
        out = os.path.join(options.out, "%s_%s_%s.exr" % (stem, light, technique))
        command = [options.program, "visibility", path, "--light", light, "--technique", technique, "--size", options.size]
        result = subprocess.run(
            command + ["--out", out] + settings, capture_output=True, text=True, check=False, timeout=TIMEOUT_S
        )
        return "" if result.returncode == 0 else "%s: %s" % (os.path.basename(out), result.stderr.strip())

    with tempfile.TemporaryDirectory() as folder:
        jobs = [(image, technique) for image in write_variants(folder, scenes) for technique in techniques]
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            failed = [line for line in pool.map(draw, jobs) if line]
    for line in failed:
        print(line)
    print("%d masks in %s, %d failed" % (len(jobs) - len(failed), options.out, len(failed)))
    return 1 if failed else 0


def describe_difference(before, after):
    """Return how two mask files differ, as text; "" if they are equal byte for byte."""
    with open(before, "rb") as left, open(after, "rb") as right:
        if left.read() == right.read():
            return ""
    try:
        old, new = load_mask(before), load_mask(after)
    except ValueError:  # a coloured mask of translucent casters, which load_mask() refuses
        return "differs"
    if (old.width, old.height) != (new.width, new.height):
        return "has another size"
    differences = [abs(a - b) for a, b in zip(old.visibility, new.visibility)]
    moved = sum(a != b for a, b in zip(old.receiver, new.receiver))
    return "%d receivers differ by up to %.6f (1/%s); %d pixels changed between receiver and none" % (
        sum(d > 0 for d in differences), max(differences), math.floor(1 / max(differences)) if max(differences) else "inf",
        moved)  # fmt: skip


def compare(options):
    names = [sorted(os.path.basename(path) for path in glob.glob(os.path.join(folder, "*.exr"))) for folder in
             (options.before, options.after)]  # fmt: skip
    missing = sorted(set(names[0]) ^ set(names[1]))
    for name in missing:
        print("%s is in one folder only" % name)
    common = sorted(set(names[0]) & set(names[1]))
    if not common:
        raise SystemExit("ERROR: %s and %s have no mask in common." % (options.before, options.after))
    unequal = 0
    for name in common:
        difference = describe_difference(os.path.join(options.before, name), os.path.join(options.after, name))
        if difference:
            unequal += 1
            print("%s: %s" % (name, difference))
    print("%d masks compared, %d differ, %d in one folder only" % (len(common), unequal, len(missing)))
    return 1 if unequal or missing else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    storing = commands.add_parser("store")
    storing.add_argument("--program", default=PROGRAM)
    storing.add_argument("--out", required=True)
    storing.add_argument("--size", default="200x200")
    storing.add_argument("--scenes", default="", help="scene names; * matches any text")
    storing.add_argument("--techniques", default="")
    storing.add_argument("--jobs", type=int, default=os.cpu_count())
    storing.add_argument("--set", dest="settings", action="append", default=[])
    comparing = commands.add_parser("compare")
    comparing.add_argument("before")
    comparing.add_argument("after")
    options = parser.parse_args()
    return store(options) if options.command == "store" else compare(options)


if __name__ == "__main__":
    sys.exit(main())
