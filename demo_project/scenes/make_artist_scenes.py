#!/usr/bin/env python3
"""Makes scenes of meshes for which no technique was tuned: merged, pierced, open and doubled parts.

    make_artist_scenes.py [--scenes A,B] [--seed N] [--count N] [--out DIR]

The same seed and count give the same bytes. The default output is beside this file and not committed; run_demo.sh and
tests/stability make it.
"""

import argparse
import math
import os
import random

from artist_shapes import make_grass, make_hull, make_kitbash, make_rigging
from gltf_writer import Document, save_files
from make_scenes import AMBER, BARK, FOLDER, MOSS, SAND, SCENE_SIZE_M, add_ground, make_light_extras

DEFAULT_SEED = 1
MOST_PARTS = 20000
LIGHT_SHARE = 0.1  # of S: the size of each light
SUN_ANGLE_DEG = round(2.0 * math.degrees(math.atan(LIGHT_SHARE)), 6)


def make_artist_set(camera_eye=(-3.6, 3.6, 5.0), camera_target=(-0.25, 0.5, 0.05)):
    """Camera, a light of each type of a tenth of the scene's size, and the study's ground."""
    document = Document(SCENE_SIZE_M)
    document.add_camera("Camera", camera_eye, camera_target, math.radians(36.87))
    size = make_light_extras("light_size", LIGHT_SHARE * SCENE_SIZE_M)
    cone = {"innerConeAngle": round(math.atan(0.6), 9), "outerConeAngle": round(math.atan(0.75), 9)}
    spot = {"type": "spot", "color": [1.0, 0.80, 0.55], "intensity": 170.0, "spot": cone}
    document.add_light("Spot", spot, (2.6, 5.2, 1.8), (0.0, 0.5, 0.0), size)
    # Further from all parts than five times its size: pcss searches blockers in a wider cone else.
    omni = {"type": "point", "color": [0.45, 0.70, 1.0], "intensity": 45.0}
    document.add_light("Omni", omni, (-2.9, 3.8, -2.2), None, size)
    sun = {"type": "directional", "color": [1.0, 0.93, 0.85], "intensity": 1.3}
    document.add_light("Sun", sun, (2.0, 5.0, -3.0), (0.0, 0.0, 0.0), make_light_extras("light_angular_distance", SUN_ANGLE_DEG))
    add_ground(document)
    return document


def make_kitbash_scene(generator, count):
    document = make_artist_set()
    # Not double-sided: a card seen from behind is not there for the camera, but casts.
    document.add_object("Kitbash", make_kitbash(generator, count), document.add_material("Kitbash", SAND, roughness=0.7))
    return document


def make_rigging_scene(generator, count):
    document = make_artist_set(camera_target=(-0.1, 0.75, 0.15))
    hull = document.add_material("Hull", BARK, roughness=0.8, is_double_sided=True)
    document.add_object("Hull", make_hull(), hull)
    document.add_object("Ropes", make_rigging(generator, count), document.add_material("Ropes", AMBER, roughness=0.8))
    return document


def make_grass_scene(generator, count):
    document = make_artist_set(camera_eye=(-2.6, 4.6, 3.8), camera_target=(-0.1, 0.05, 0.0))
    blades = document.add_material("Grass", MOSS, roughness=0.7, is_double_sided=True)
    document.add_object("Grass", make_grass(generator, count), blades)
    return document


# Name -> how it is built, and how many parts, ropes or blades it has by default.
SCENES = {
    "kitbash": (make_kitbash_scene, 300),
    "rigging": (make_rigging_scene, 400),
    "grass": (make_grass_scene, 2000),
}


def build_scene(name, seed=DEFAULT_SEED, count=None):
    build, default_count = SCENES[name]
    return build(random.Random(seed), count or default_count)


def build_scene_files(name, seed=DEFAULT_SEED, count=None):
    """File name -> bytes."""
    return build_scene(name, seed, count).build_files(name)


def main():
    parser = argparse.ArgumentParser(description="Makes the scenes of merged, open and piercing parts.")
    parser.add_argument("--scenes", default=",".join(SCENES), help="comma-separated (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=DEFAULT_SEED, help="of the random numbers (default: %(default)s)")
    parser.add_argument("--count", type=int, help="parts, ropes or blades, 1..%d (default: the scene's)" % MOST_PARTS)
    parser.add_argument("--out", default=FOLDER, help="folder to write to (default: beside this file)")
    arguments = parser.parse_args()
    names = [name for name in arguments.scenes.split(",") if name]
    unknown = [name for name in names if name not in SCENES]
    if unknown or not names:
        parser.error("--scenes is %r, must be of: %s" % (arguments.scenes, ", ".join(SCENES)))
    if arguments.count is not None and not 1 <= arguments.count <= MOST_PARTS:
        parser.error("--count is %d, must be 1..%d" % (arguments.count, MOST_PARTS))
    for name in names:
        save_files(build_scene_files(name, arguments.seed, arguments.count), arguments.out)
        print(os.path.join(arguments.out, name + ".gltf"))


if __name__ == "__main__":
    main()
