#!/usr/bin/env python3
"""Makes scenes of meshes for which no technique was tuned: merged, intersecting, open and duplicated parts.

    make_artist_scenes.py [--scenes A,B] [--seed N] [--count N] [--out DIR]

--count is the number of parts, ropes or blades of each scene.

The same seed and count give the same bytes. By default the files are written next to this file. They are not committed;
run_demo.sh and tests generate them.
"""

import math

from artist_shapes import make_grass, make_hull, make_kitbash, make_rigging
from gltf_writer import Document
from make_scenes import AMBER, BARK, MOSS, SAND, SCENE_SIZE_M, add_ground, make_light_extras
from seeded_scenes import SeededScenes

MAX_PARTS = 20000
LIGHT_SIZE_FRACTION = 0.1  # of the scene's size: the size of each light
# The sun looks as large as such a light at a distance of the scene's size.
SUN_ANGLE_DEG = round(2.0 * math.degrees(math.atan(LIGHT_SIZE_FRACTION)), 6)


def make_artist_set(camera_eye=(-3.6, 3.6, 5.0), camera_target=(-0.25, 0.5, 0.05)):
    """Return a document with a camera, the ground of the study, and a light of each type, a tenth of the scene in size."""
    document = Document(SCENE_SIZE_M)
    document.add_camera("Camera", camera_eye, camera_target, math.radians(36.87))
    size = make_light_extras("light_size", LIGHT_SIZE_FRACTION * SCENE_SIZE_M)
    cone = {"innerConeAngle": round(math.atan(0.6), 9), "outerConeAngle": round(math.atan(0.75), 9)}
    spot = {"type": "spot", "color": [1.0, 0.80, 0.55], "intensity": 170.0, "spot": cone}
    document.add_light("Spot", spot, (2.6, 5.2, 1.8), (0.0, 0.5, 0.0), size)
    # Farther from all parts than five times its size, because nearer casters exceed the limit of pcss (doc/stability.md).
    omni = {"type": "point", "color": [0.45, 0.70, 1.0], "intensity": 45.0}
    document.add_light("Omni", omni, (-2.9, 3.8, -2.2), None, size)
    sun = {"type": "directional", "color": [1.0, 0.93, 0.85], "intensity": 1.3}
    document.add_light("Sun", sun, (2.0, 5.0, -3.0), (0.0, 0.0, 0.0), make_light_extras("light_angular_distance", SUN_ANGLE_DEG))
    add_ground(document)
    return document


def make_kitbash_scene(generator, count):
    document = make_artist_set()
    # Not double-sided: a card seen from behind is invisible to the camera, but casts a shadow.
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


# Name -> (function that builds it, default number of parts, ropes or blades).
SCENES = {
    "kitbash": (make_kitbash_scene, 300),
    "rigging": (make_rigging_scene, 400),
    "grass": (make_grass_scene, 2000),
}
_seeded = SeededScenes(SCENES, "parts, ropes or blades", MAX_PARTS)
build_scene = _seeded.build
build_scene_files = _seeded.build_files


if __name__ == "__main__":
    _seeded.run("Makes the scenes of merged, open and intersecting parts.")
