"""Scenes that measure_lean.py renders. In each of them a rule for skipping work takes effect."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from gltf_writer import Document  # noqa: E402
from shapes import make_box, make_icosphere, make_quad, make_torus_knot  # noqa: E402
from volume_scenes import save  # noqa: E402

GREY = (0.6, 0.6, 0.6)
SCENE_SIZE_M = 4.0
VISIBLE_COUNT = 4


def begin(eye=(-3.2, 4.6, 4.6), target=(-0.3, 0.45, -0.2), fov_deg=40.0):
    """Return a document with a camera, and the index of its grey material."""
    document = Document(SCENE_SIZE_M)
    document.add_camera("Camera", eye, target, math.radians(fov_deg))
    return document, document.add_material("Grey", GREY)


def add_ground(document, material, half_m=4.0):
    document.add_object("Ground", make_box((half_m, 0.2, half_m)), material, (0.0, -0.2, 0.0))


def add_spot(document, name, eye, target=(0.0, 0.0, 0.0), size_m=0.1, **extras):
    light = {
        "type": "spot",
        "color": [1.0, 1.0, 1.0],
        "intensity": 60.0,
        "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.6},
    }
    document.add_light(name, light, eye, target, {"shadow_enabled": True, "light_size": size_m, **extras})


def add_omni(document, name, position, range_m=None, **extras):
    light = {"type": "point", "color": [1.0, 1.0, 1.0], "intensity": 60.0}
    if range_m is not None:
        light["range"] = range_m
    document.add_light(name, light, position, None, {"shadow_enabled": True, "light_size": 0.1, **extras})


def make_balls(folder, stem="balls"):
    """Nine balls above a ground, lit by one spot light."""
    document, material = begin()
    add_ground(document, material)
    ball = document.add_mesh("Ball", make_icosphere(3, 0.3), material)
    for index in range(9):
        document.add_node("Ball %d" % index, (index % 3 - 1.0, 0.8, index // 3 - 1.0), mesh=ball)
    add_spot(document, "Light", (1.8, 6.0, 1.2))
    return save(document, stem, folder)


def make_lights(hidden_count, folder):
    """Four spot lights that light the view, and `hidden_count` lights that do not: spot lights that point upwards, and omni lights
    with too short a range. Shadow maps are small, so that those of all lights would fit into memory."""
    small = {"shadow_map_size": 128}
    document, material = begin()
    add_ground(document, material)
    ball = document.add_mesh("Ball", make_icosphere(3, 0.4), material)
    for index in range(4):
        document.add_node("Ball %d" % index, (index % 2 - 0.5, 0.8, index // 2 - 0.5), mesh=ball)
    for index in range(VISIBLE_COUNT):
        add_spot(document, "Visible %d" % index, (1.5 * math.cos(1.5 * index), 5.0, 1.5 * math.sin(1.5 * index)), **small)
    for index in range(hidden_count):
        position = (3.0 * (index % 16) - 24.0, 4.0, 10.0 + 2.0 * (index // 16))
        if index % 2:
            add_omni(document, "Hidden %d" % index, position, range_m=2.0, **small)
        else:
            add_spot(document, "Hidden %d" % index, position, (position[0], 9.0, position[2] + 0.5), **small)
    return save(document, "lights_%d" % hidden_count, folder)


def make_tower(folder):
    """An omni light so high that only its downward view has casters."""
    document, material = begin()
    add_ground(document, material, 2.5)
    document.add_object("Knot", make_torus_knot(0.3, 0.14, 160, 32), material, (0.0, 1.0, 0.0))
    add_omni(document, "Light", (0.0, 6.0, 0.0))
    return save(document, "tower", folder)


def make_room(folder):
    """An omni light among pillars and walls, and a camera that looks at one wall."""
    document, material = begin((0.0, 1.2, 0.5), (2.0, 1.0, 0.0), 35.0)
    add_ground(document, material, 2.2)
    knot = document.add_mesh("Knot", make_torus_knot(0.12, 0.06, 160, 32), material)
    for index in range(4):
        direction = ((1, 0), (-1, 0), (0, 1), (0, -1))[index]
        half = (0.1, 2.0, 2.0) if direction[0] else (2.0, 2.0, 0.1)
        document.add_object("Wall %d" % index, make_box(half), material, (2.1 * direction[0], 1.9, 2.1 * direction[1]))
        document.add_node("Knot %d" % index, (1.1 * direction[0], 1.0, 1.1 * direction[1]), mesh=knot)
    add_omni(document, "Light", (0.0, 1.0, 0.0))
    return save(document, "room", folder)


def make_quads(folder):
    """Single quads side by side: there is no second depth layer behind the first."""
    document, material = begin()
    facing_up = (-0.5**0.5, 0.0, 0.0, 0.5**0.5)  # rotated by -90 degrees about X
    quad = document.add_mesh("Quad", make_quad(0.18, 0.18), material)
    for index in range(100):
        position = (0.4 * (index % 10 - 4.5), 0.5, 0.4 * (index // 10 - 4.5))
        document.add_node("Quad %d" % index, position, facing_up, mesh=quad)
    add_spot(document, "Light", (0.3, 6.0, 0.2))
    return save(document, "quads", folder)


def make_knots(folder):
    """Nine knots of 10,240 triangles each over a ground."""
    document, material = begin()
    add_ground(document, material)
    knot = document.add_mesh("Knot", make_torus_knot(0.13, 0.06, 160, 32), material)
    for index in range(9):
        document.add_node("Knot %d" % index, (1.1 * (index % 3 - 1), 1.0, 1.1 * (index // 3 - 1)), mesh=knot)
    add_spot(document, "Light", (1.8, 6.0, 1.2))
    return save(document, "knots", folder)
