#!/usr/bin/env python3
"""Writes the demo scenes next to this file.

    make_scenes.py [--out DIR]     writes every scene
    make_scenes.py --check         exits 1 when a committed scene differs from what would be written

The first six of SCENES are those of the study in doc/benchmarks.md, unchanged, so that results are comparable.
Units are metres, +Y is up.
"""

import argparse
import math
import os
import sys

from gltf_writer import Document, quaternion_about, quaternion_from_y, save_files
from shapes import (
    make_box,
    make_cloth,
    make_clutter,
    make_cylinder,
    make_icosphere,
    make_quad,
    make_teapot,
    make_terrain,
    make_torus,
    make_torus_knot,
)

FOLDER = os.path.dirname(os.path.abspath(__file__))

SCENE_SIZE_M = 4
# LIGHT_TANGENT: tangent of the half angle of the spot light's cone.
LIGHT_EYE, LIGHT_TARGET, LIGHT_TANGENT = (1.8, 6.0, 1.2), (0.0, 0.4, 0.0), 0.95
CAMERA_EYE, CAMERA_TARGET, CAMERA_FOV_DEG = (-3.2, 4.6, 4.6), (-0.3, 0.45, -0.2), 36.87
LIGHT_SIZE_M = 0.4
LIGHT_INTENSITY_CD = 260.0  # about 7 lx at 6 m; exposure is automatic
WARM_WHITE = [1.0, 0.95, 0.87]
GROUND_HALF = (4.2, 0.2, 4.2)

GROUND_COLOR = (0.60, 0.58, 0.55)
CORAL = (0.86, 0.24, 0.16)
TEAL = (0.06, 0.44, 0.46)
AMBER = (0.92, 0.56, 0.10)
PLUM = (0.42, 0.14, 0.40)
MOSS = (0.28, 0.46, 0.12)
SKY = (0.22, 0.46, 0.80)
BARK = (0.28, 0.17, 0.10)
SAND = (0.66, 0.52, 0.34)
JADE = (0.46, 0.74, 0.56)

# About 16 pixels on the teapot at 512 x 512, so that both methods of receiver_scatter, in metres and in pixels, have
# the same radius there.
SCATTER_DISTANCE_M = 0.12


def make_ground():
    """Return the ground box with its top in the plane y = 0 of the node."""
    mesh = make_box(GROUND_HALF)
    mesh.positions = [(x, 0.0 if y > 0.0 else -2.0 * GROUND_HALF[1], z) for x, y, z in mesh.positions]
    return mesh


def add_ground(document):
    material = document.add_material("Ground", GROUND_COLOR, roughness=0.9)
    document.add_object("Ground", make_ground(), material, extras={"shadow_planar_receiver": True})


def make_light_extras(size_name, size):
    """Return extras with the size of a light. The widths of its penumbra are derived from it."""
    return {size_name: size, "shadow_enabled": True}


def add_spot_light(document, eye=LIGHT_EYE, target=LIGHT_TARGET, tangent=LIGHT_TANGENT):
    light = {
        "type": "spot",
        "color": WARM_WHITE,
        "intensity": LIGHT_INTENSITY_CD,
        "spot": {
            "innerConeAngle": round(math.atan(0.9 * tangent), 9),
            "outerConeAngle": round(math.atan(tangent), 9),
        },
    }
    document.add_light("Light", light, eye, target, make_light_extras("light_size", LIGHT_SIZE_M))


def make_document(camera_target=CAMERA_TARGET, vertical_fov_deg=CAMERA_FOV_DEG, **light):
    """Return a document with the camera and the spot light of all study scenes."""
    document = Document(SCENE_SIZE_M)
    document.add_camera("Camera", CAMERA_EYE, camera_target, math.radians(vertical_fov_deg))
    add_spot_light(document, **light)
    return document


def make_sphere_scene():
    document = make_document()
    add_ground(document)
    material = document.add_material("Coral", CORAL, roughness=0.45)
    document.add_object("Sphere", make_icosphere(4, 0.8), material, (0.0, 1.3, 0.0))
    return document


def make_contact_box_scene():
    document = make_document(camera_target=(-0.35, 0.55, -0.25))
    add_ground(document)
    material = document.add_material("Teal", TEAL, roughness=0.6)
    rotation = quaternion_about((0.0, 1.0, 0.0), 0.4)
    document.add_object("Box", make_box((0.35, 1.02, 0.35)), material, (0.2, 0.97, 0.1), rotation)
    return document


def make_torus_knot_scene():
    document = make_document()
    add_ground(document)
    material = document.add_material("Amber", AMBER, roughness=0.4)
    document.add_object("Knot", make_torus_knot(0.36, 0.16, 500, 30), material, (0.0, 1.4, 0.0))
    return document


def make_stacked_layers_scene():
    document = make_document()
    add_ground(document)
    teal = document.add_material("Teal", TEAL, roughness=0.6)
    coral = document.add_material("Coral", CORAL, roughness=0.6)
    amber = document.add_material("Amber", AMBER, roughness=0.6)
    document.add_object("Lower disc", make_cylinder(0.6, 0.04, 48), teal, (-0.2, 0.6, -0.2))
    lean = quaternion_from_y((-0.2, 1.0, 0.0))
    document.add_object("Upper disc", make_cylinder(0.55, 0.04, 48), coral, (0.15, 1.3, 0.25), lean)
    rotation = quaternion_about((0.0, 1.0, 0.0), 0.3)
    document.add_object("Board", make_box((0.5, 0.05, 0.35)), amber, (0.7, 2.1, -0.1), rotation)
    return document


def make_clutter_scene():
    document = make_document()
    add_ground(document)
    leaves = document.add_material("Leaves", MOSS, roughness=0.7)
    bark = document.add_material("Bark", BARK, roughness=0.9)
    mesh = make_clutter(300, (0.11, 0.01, 0.07), (0.0, 1.6, 0.0), 0.95, seed=300)
    document.add_object("Leaves", mesh, leaves)
    document.add_object("Trunk", make_box((0.08, 0.65, 0.08)), bark, (0.0, 0.6, 0.0))
    return document


def make_terrain_scene():
    document = make_document(vertical_fov_deg=48.9, eye=(4.4, 3.9, 2.6), target=(0.0, 0.1, 0.0), tangent=0.85)
    material = document.add_material("Sand", SAND, roughness=0.95)
    document.add_object("Terrain", make_terrain(150, 3.6, -0.8, seed=150), material)
    return document


def make_open_sheets_scene():
    document = make_document()
    add_ground(document)
    plum = document.add_material("Cloth", PLUM, roughness=0.8, is_double_sided=True)
    sky = document.add_material("Leaning sheet", SKY, roughness=0.7, is_double_sided=True)
    amber = document.add_material("Standing sheet", AMBER, roughness=0.7, is_double_sided=True)
    document.add_object("Cloth", make_cloth(24, 0.75, 0.09), plum, (-0.1, 1.2, -0.1))
    lean = quaternion_about((1.0, 0.4, 0.2), -0.6)
    document.add_object("Leaning sheet", make_quad(0.35, 0.5), sky, (-1.2, 0.75, 0.7), lean)
    rotation = quaternion_about((0.0, 1.0, 0.0), -0.5)
    document.add_object("Standing sheet", make_quad(0.5, 0.4), amber, (1.05, 0.4, -0.9), rotation)
    return document


def make_three_lights_scene():
    """Return the start scene: a light of each type and a few casters."""
    document = Document(SCENE_SIZE_M)
    document.add_camera("Camera", (-3.6, 3.6, 5.0), (-0.1, 0.62, -0.1), math.radians(36.87))
    spot = {
        "type": "spot",
        "color": [1.0, 0.80, 0.55],
        "intensity": 170.0,
        "spot": {"innerConeAngle": round(math.atan(0.55), 9), "outerConeAngle": round(math.atan(0.7), 9)},
    }
    document.add_light("Spot", spot, (2.6, 5.2, 1.8), (0.0, 0.5, 0.0), make_light_extras("light_size", 0.35))
    omni = {"type": "point", "color": [0.45, 0.70, 1.0], "intensity": 16.0}
    document.add_light("Omni", omni, (-2.3, 2.3, -1.5), None, make_light_extras("light_size", 0.2))
    sun = {"type": "directional", "color": [1.0, 0.93, 0.85], "intensity": 1.3}
    sun_extras = make_light_extras("light_angular_distance", 6.0)
    document.add_light("Sun", sun, (-3.0, 6.0, 4.0), (0.0, 0.0, 0.0), sun_extras)
    add_ground(document)
    amber = document.add_material("Amber", AMBER, roughness=0.35)
    teal = document.add_material("Teal", TEAL, roughness=0.6)
    coral = document.add_material("Coral", CORAL, roughness=0.4)
    document.add_object("Knot", make_torus_knot(0.26, 0.12, 240, 20), amber, (-0.15, 1.2, -0.2))
    rotation = quaternion_about((0.0, 1.0, 0.0), 0.5)
    document.add_object("Box", make_box((0.32, 0.45, 0.32)), teal, (1.35, 0.45, -0.75), rotation)
    document.add_object("Sphere", make_icosphere(4, 0.38), coral, (-0.95, 0.38, 1.05))
    return document


def make_wall():
    """Return an upright wall, to be put behind the objects."""
    return make_box((4.2, 2.4, 0.1))


def add_translucent_set(document, light_eye=(-2.6, 4.3, 4.6)):
    """Add camera, a light without size, and opaque ground and wall with the shading model of Wang and Xiao 2015, section 2."""
    document.add_camera("Camera", (0.5, 2.1, 6.6), (0.05, 0.78, 0.0), math.radians(30.0))
    light = {
        "type": "spot",
        "color": WARM_WHITE,
        "intensity": 310.0,
        "spot": {"innerConeAngle": round(math.atan(0.75), 9), "outerConeAngle": round(math.atan(0.85), 9)},
    }
    document.add_light("Light", light, light_eye, (0.0, 0.7, 0.0), make_light_extras("light_size", 0.0))
    opaque = document.add_material("Ground", GROUND_COLOR, roughness=0.9, extras={"shading_model": "phong"})
    document.add_object("Ground", make_ground(), opaque, extras={"shadow_planar_receiver": True})
    wall = document.add_material("Wall", (0.5, 0.53, 0.6), roughness=0.9, extras={"shading_model": "phong"})
    document.add_object("Wall", make_wall(), wall, (0.0, 2.4, -1.8), extras={"shadow_planar_receiver": True})


def make_scatter_extras(scatter):
    return {"scatter": scatter, "scatter_distance": SCATTER_DISTANCE_M}


def make_teapot_scene(scatter):
    """Return the scene of figures 4 to 7 of Wang and Xiao 2015: an opaque ring casts a shadow on a translucent teapot."""
    document = Document(SCENE_SIZE_M)
    add_translucent_set(document)
    jade = document.add_material("Jade", JADE, roughness=0.35, extras=make_scatter_extras(scatter))
    rotation = quaternion_about((0.0, 1.0, 0.0), 0.35)
    document.add_object("Teapot", make_teapot(0.5, 10), jade, (0.0, 0.0, 0.0), rotation)
    coral = document.add_material("Ring", CORAL, roughness=0.6, extras={"shading_model": "phong"})
    towards_light = quaternion_from_y((-2.6, 3.4, 4.6))  # about the direction from the ring to the light
    document.add_object("Ring", make_torus(0.42, 0.085, 64, 24), coral, (-0.72, 1.8, 1.35), towards_light)
    return document


def make_stained_glass_scene():
    """Return panes and a sphere of coloured glass behind each other that cast on an opaque ground and a translucent block."""
    document = make_document()
    add_ground(document)
    wax = document.add_material("Wax", (0.85, 0.80, 0.68), roughness=0.5, extras={"scatter": 0.8, "scatter_distance": 0.25})
    document.add_object("Block", make_box((0.55, 0.12, 0.55)), wax, (-1.15, 0.12, 0.75))
    red = document.add_glass("Red glass", (0.95, 0.16, 0.10), transmission=0.9)
    blue = document.add_glass("Blue glass", (0.12, 0.30, 0.95), transmission=0.9)
    pane = make_box((0.55, 0.45, 0.015))
    document.add_object("Red pane", pane, red, (-0.45, 1.45, 0.3), quaternion_about((0.3, 1.0, 0.1), 0.7))
    document.add_object("Blue pane", pane, blue, (0.05, 0.75, -0.05), quaternion_about((0.3, 1.0, -0.2), 0.5))
    amber = document.add_glass(
        "Amber glass", (1.0, 0.82, 0.40), transmission=0.95,
        thickness_m=0.6, attenuation_color=(0.95, 0.72, 0.40), attenuation_distance_m=0.5,
    )  # fmt: skip
    document.add_object("Amber ball", make_icosphere(4, 0.34), amber, (0.75, 1.15, 0.65))
    moss = document.add_material("Moss", MOSS, roughness=0.7)
    document.add_object("Ring", make_torus(0.3, 0.06, 48, 16), moss, (0.25, 1.9, 0.45), quaternion_from_y((1.0, 2.0, 0.3)))
    return document


SCENES = {
    "sphere": make_sphere_scene,
    "contact_box": make_contact_box_scene,
    "torus_knot": make_torus_knot_scene,
    "stacked_layers": make_stacked_layers_scene,
    "clutter": make_clutter_scene,
    "terrain": make_terrain_scene,
    "open_sheets": make_open_sheets_scene,
    "three_lights": make_three_lights_scene,
    "stained_glass": make_stained_glass_scene,
    "teapot_s15": lambda: make_teapot_scene(0.15),
    "teapot_s50": lambda: make_teapot_scene(0.50),
    "teapot_s80": lambda: make_teapot_scene(0.80),
}
# Scenes that differ only in their materials share a .bin.
BINARIES = {"teapot_s15": "teapot", "teapot_s50": "teapot", "teapot_s80": "teapot"}


def build_all_files():
    files = {}
    for name, build in SCENES.items():
        files.update(build().build_files(name, BINARIES.get(name)))
    return files


def find_differences(files, folder):
    """Return the names of files that are missing in the folder or have other bytes there."""
    differing = []
    for name, data in sorted(files.items()):
        path = os.path.join(folder, name)
        if not os.path.isfile(path):
            differing.append(name)
            continue
        with open(path, "rb") as file:
            if file.read() != data:
                differing.append(name)
    return differing


def main():
    parser = argparse.ArgumentParser(description="Writes the demo scenes.")
    parser.add_argument("--out", default=FOLDER, help="folder to write to (default: next to this file)")
    parser.add_argument("--check", action="store_true", help="write nothing, compare with the files there")
    arguments = parser.parse_args()
    files = build_all_files()
    if not arguments.check:
        save_files(files, arguments.out)
        return 0
    differing = find_differences(files, arguments.out)
    for name in differing:
        print("ERROR: %s is not what make_scenes.py writes. Run it and commit the result." % name, file=sys.stderr)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
