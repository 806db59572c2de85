#!/usr/bin/env python3
"""Makes scenes of casters that are cut out by the alpha of their textures: a leaf, a fence, a tree, and a courtyard with fence
and tree, in which a figure walks and a flag waves.

    make_foliage_scenes.py [--scenes A,B] [--seed N] [--count N] [--out DIR]

--count is the number of leaves of a tree.

The same seed and count give the same bytes. By default the files are written next to this file. They are not committed;
run_demo.sh and tests generate them.
"""

import math

from animated_casters import add_walk
from foliage_shapes import make_card, make_chain_png, make_leaf_png, make_leaves, make_stone_png
from gltf_writer import Mesh, quaternion_about
from make_artist_scenes import make_artist_set
from make_scenes import BARK, SAND, SCENE_SIZE_M, Document, make_light_extras
from seeded_scenes import SeededScenes
from shapes import make_cylinder

MAX_LEAVES = 100000
# The tree's kinds of leaves: shape, sRGB colour.
LEAVES = (("oval", (0.36, 0.62, 0.20)), ("oval", (0.55, 0.70, 0.24)), ("star", (0.78, 0.52, 0.18)))
WHITE = (1.0, 1.0, 1.0)


def add_cut_out(document, name, file_name, png, roughness=0.7):
    material = document.add_material(name, WHITE, roughness=roughness, is_double_sided=True)
    document.set_texture(material, document.add_texture(file_name, png), is_cut_out=True)
    return material


def add_tree(document, generator, count, position, stem, height_m=1.55, radius_m=0.75, leaf_m=0.075):
    """Add a trunk and leaves with three textures. count: the number of leaves."""
    bark = document.add_material("Bark", BARK, roughness=0.9)
    x, y, z = position
    document.add_object("Trunk", make_cylinder(0.07, 0.5 * height_m, 24), bark, (x, y + 0.5 * height_m, z))
    center = (x, y + height_m + 0.2, z)
    for index, (shape, color) in enumerate(LEAVES):
        leaf_count = count * (index + 1) // len(LEAVES) - count * index // len(LEAVES)
        material = add_cut_out(document, "Leaves %d" % (index + 1), "%s_leaf_%d.png" % (stem, index + 1), make_leaf_png(shape, color))
        document.add_object("Leaves %d" % (index + 1), make_leaves(generator, leaf_count, leaf_m, center, radius_m), material)


def make_leaf_scene(_generator, _count):
    document = make_artist_set()
    material = add_cut_out(document, "Leaf", "leaf_card.png", make_leaf_png("star", LEAVES[2][1], 128))
    turn = quaternion_about((1.0, 0.2, 0.1), -1.2)
    document.add_object("Leaf", make_card(0.9, 0.9), material, (0.0, 1.1, 0.0), turn)
    return document


def make_fence_scene(_generator, _count):
    document = make_artist_set(camera_target=(-0.1, 0.55, 0.0))
    material = add_cut_out(document, "Chain link", "fence_chain.png", make_chain_png(), 0.4)
    post = document.add_material("Posts", SAND, roughness=0.5)
    turn = quaternion_about((0.0, 1.0, 0.0), 0.35)
    document.add_object("Chain link", make_card(1.5, 0.6, (15.0, 6.0)), material, (0.0, 0.66, 0.0), turn)
    for side in (-1.0, 1.0):
        x, z = 1.5 * side * math.cos(0.35), -1.5 * side * math.sin(0.35)  # an end of the card
        document.add_object("Post", make_cylinder(0.04, 0.68, 24), post, (x, 0.68, z))
    return document


def make_leaves_scene(generator, count):
    document = make_artist_set(camera_target=(-0.2, 0.8, 0.0))
    add_tree(document, generator, count, (0.0, 0.0, 0.0), "leaves")
    return document


def make_wall(half_x, half_y, repeats):
    """Return a box for a wall, without its bottom."""
    mesh = Mesh(is_closed=False)
    card = make_card(half_x, half_y, repeats)
    thickness = 0.08  # half that of the wall
    for turn, depth in ((0.0, thickness), (math.pi, -thickness)):
        mesh.add_mesh(card, quaternion_about((0.0, 1.0, 0.0), turn), (0.0, half_y, depth))
    top = make_card(half_x, thickness, (repeats[0], 0.25))
    mesh.add_mesh(top, quaternion_about((1.0, 0.0, 0.0), -0.5 * math.pi), (0.0, 2.0 * half_y, 0.0))
    end = make_card(thickness, half_y, (0.25, repeats[1]))
    for turn in (0.5 * math.pi, -0.5 * math.pi):
        mesh.add_mesh(end, quaternion_about((0.0, 1.0, 0.0), turn), (half_x if turn > 0.0 else -half_x, half_y, 0.0))
    return mesh


def make_courtyard_scene(generator, count):
    document = Document(2.0 * SCENE_SIZE_M)
    document.add_camera("Camera", (-4.2, 2.5, 5.4), (0.2, 0.95, 0.0), math.radians(40.0))
    sun = {"type": "directional", "color": [1.0, 0.93, 0.82], "intensity": 2.6}
    document.add_light("Sun", sun, (-2.4, 5.0, 2.2), (0.0, 0.0, 0.0), make_light_extras("light_angular_distance", 2.0))
    lamp = {"type": "point", "color": [1.0, 0.72, 0.42], "intensity": 9.0}
    document.add_light("Lamp", lamp, (1.9, 1.9, -0.9), None, make_light_extras("light_size", 0.1))
    stone = document.add_material("Stone", WHITE, roughness=0.9)
    document.set_texture(stone, document.add_texture("courtyard_stone.png", make_stone_png(generator)))
    paving = make_card(4.4, 4.4, (6.0, 6.0))
    document.add_object("Paving", paving, stone, rotation=quaternion_about((1.0, 0.0, 0.0), -0.5 * math.pi))
    document.add_object("Back wall", make_wall(3.2, 0.95, (3.2, 0.95)), stone, (0.2, 0.0, -2.4))
    document.add_object("Side wall", make_wall(2.4, 0.95, (2.4, 0.95)), stone, (3.3, 0.0, -0.1), quaternion_about((0.0, 1.0, 0.0), 0.5 * math.pi))
    add_tree(document, generator, count, (0.5, 0.0, -0.5), "courtyard")
    chain = add_cut_out(document, "Chain link", "courtyard_chain.png", make_chain_png(), 0.4)
    post = document.add_material("Posts", SAND, roughness=0.5)
    document.add_object("Chain link", make_card(1.2, 0.5, (12.0, 5.0)), chain, (-1.7, 0.52, 0.9), quaternion_about((0.0, 1.0, 0.0), 0.6))
    for side in (-1.0, 1.0):
        x, z = -1.7 + 1.2 * side * math.cos(0.6), 0.9 - 1.2 * side * math.sin(0.6)
        document.add_object("Post", make_cylinder(0.035, 0.54, 24), post, (x, 0.54, z))
    add_walk(document, (1.85, 0.0, 0.5), (-1.35, 0.0, -1.9), 2.2, "courtyard")
    # From the first camera, which looks away from the sun, the figure hides its shadow. From here the shadow is on the right.
    document.add_camera("Walk camera", (1.1, 2.4, 5.5), (0.75, 0.85, -0.4), math.radians(38.0))
    return document


# Name -> (function that builds it, default number of leaves, unused by leaf and fence).
SCENES = {
    "leaf": (make_leaf_scene, 1),
    "fence": (make_fence_scene, 0),
    "leaves": (make_leaves_scene, 2000),
    "courtyard": (make_courtyard_scene, 2000),
}
_seeded = SeededScenes(SCENES, "leaves", MAX_LEAVES)
build_scene = _seeded.build
build_scene_files = _seeded.build_files


if __name__ == "__main__":
    _seeded.run("Makes the scenes of casters with holes.")
