"""Scenes for the measurements of shadow volumes, and save(), which other benchmarks also use.

They are generated because they are too large to be committed.
"""

import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from gltf_writer import Document, quaternion_about, save_files  # noqa: E402
from shapes import make_box, make_icosphere, make_torus_knot  # noqa: E402

GREY = (0.6, 0.6, 0.6)
YARD_M = 40.0
ROW_COUNT = 5
WALLS_PER_ROW = 4
WALL_HALF = (0.15, 2.0, 4.2)
# Triangle count -> segments along and around the knot.
KNOT_SEGMENTS = {2080: (65, 16), 10240: (160, 32), 51200: (400, 64), 204800: (800, 128), 1008000: (1800, 280)}


def add_sun(document, from_direction):
    light = {"type": "directional", "color": [1.0, 1.0, 1.0], "intensity": 5.0}
    document.add_light("Sun", light, from_direction, (0.0, 0.0, 0.0), {"shadow_enabled": True})


def make_yard(caster_count, has_walls, folder):
    """Balls of 80 triangles between rows of long walls, which shadow most balls from a low sun. Some balls stick
    out above the walls or are in the gaps. Returns the scene's path."""
    document = Document(YARD_M)
    document.add_camera("Camera", (-6.0, 14.0, 26.0), (0.0, 0.0, 2.0), math.radians(60.0))
    add_sun(document, (30.0, 10.0, 3.0))
    material = document.add_material("Grey", GREY)
    document.add_object("Ground", make_box((0.5 * YARD_M, 0.1, 0.5 * YARD_M)), material, (0.0, -0.1, 0.0))
    if has_walls:
        wall = make_box(WALL_HALF)
        for row in range(ROW_COUNT):
            for part in range(WALLS_PER_ROW):
                x = 0.45 * YARD_M - row * YARD_M / ROW_COUNT
                # 2 half lengths would leave no gaps between the walls.
                z = (part - 0.5 * (WALLS_PER_ROW - 1)) * 2.3 * WALL_HALF[2]
                document.add_object("Wall %d.%d" % (row, part), wall, material, (x, WALL_HALF[1] + 0.01, z))
    ball = document.add_mesh("Ball", make_icosphere(1, 0.12), material)
    generator = random.Random(5)
    for index in range(caster_count):
        at = (generator.uniform(-0.48, 0.48) * YARD_M, generator.uniform(0.13, 2.0), generator.uniform(-0.45, 0.45) * YARD_M)
        document.add_node("Ball %d" % index, at, mesh=ball)
    return save(document, "yard_%d_%d" % (caster_count, has_walls), folder)


def make_knot(triangle_count, folder):
    """One knot of triangle_count triangles, a key of KNOT_SEGMENTS, above a floor. Returns the scene's path."""
    document = Document(4.0)
    document.add_camera("Camera", (-2.0, 3.5, 4.0), (0.0, 0.4, 0.0), math.radians(45.0))
    light = {
        "type": "spot",
        "color": [1.0, 1.0, 1.0],
        "intensity": 100.0,
        "spot": {"innerConeAngle": 0.4, "outerConeAngle": 0.5},
    }
    document.add_light("Light", light, (1.0, 5.0, 1.0), (0.0, 0.5, 0.0), {"shadow_enabled": True})
    material = document.add_material("Grey", GREY)
    document.add_object("Ground", make_box((3.0, 0.1, 3.0)), material, (0.0, -0.1, 0.0))
    knot = make_torus_knot(0.36, 0.16, *KNOT_SEGMENTS[triangle_count])
    rotation = quaternion_about((1.0, 0.0, 0.0), 0.5)
    document.add_object("Knot", knot, material, (0.0, 1.4, 0.0), rotation)
    return save(document, "knot_%d" % triangle_count, folder)


def save(document, stem, folder):
    save_files(document.build_files(stem), folder)
    return os.path.join(folder, stem + ".gltf")
