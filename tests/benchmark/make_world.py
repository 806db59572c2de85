#!/usr/bin/env python3
"""Writes a large world: many low-poly casters on a wide ground, under a low sun, seen from eye height.

    make_world.py [--out DIR] [--seed N] [--casters N] [--extent METRES] [--mesh-per-caster] [--moving N]

Boxes, trees and rocks of 12 to 26 triangles are evenly spread over a square of --extent metres; their order in the file is
random. With --mesh-per-caster each has a mesh of its own, else all share three. With --moving, an
animation moves N of the casters, at even distances in the file, by 3 m in 2 s. The sun has a diameter of 0.53 degrees and
is 25 degrees above the horizon. Equal parameters write equal files. measure_world.py measures these worlds.
"""

import argparse
import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from gltf_animation import Channel, add_animation  # noqa: E402
from gltf_writer import Document, Mesh, quaternion_about, save_files, scale  # noqa: E402
from shapes import make_box, make_icosphere  # noqa: E402

SUN_DEGREES = 0.53
ELEVATION_DEGREES = 25.0
EYE_M = 1.7
CLEARING_M = 5.0  # no caster is nearer to the camera
CASTERS = 20000
MOTION_S = 2.0
MOTION_M = (2.0, 1.0, 2.0)
EXTENT_M = 2000.0


def make_cone(sides, bottom_radius, top_radius, bottom, top):
    """Return a closed cone, or a prism if both radii are equal, about the y axis, with smooth normals."""
    mesh = Mesh()
    rings = []
    for radius, y in ((bottom_radius, bottom), (top_radius, top)):
        angles = [2.0 * math.pi * side / sides for side in range(sides)] if radius > 0.0 else [0.0]
        rings.append([mesh.add_vertex((radius * math.cos(a), y, radius * math.sin(a)), (math.cos(a), 1.0, math.sin(a))) for a in angles])
    low, high = rings
    for side in range(sides):
        after = (side + 1) % sides
        if len(high) == 1:
            mesh.add_triangle(low[side], high[0], low[after])
        else:
            mesh.add_quad(low[side], high[side], high[after], low[after])
    for side in range(1, sides - 1):
        mesh.add_triangle(low[0], low[side], low[side + 1])
        if len(high) > 1:
            mesh.add_triangle(high[0], high[side + 1], high[side])
    return mesh


def make_tree():
    """Return a trunk of 16 and a crown of 10 triangles, 1 m high, on the origin."""
    tree = Mesh()
    tree.add_mesh(make_cone(5, 0.035, 0.025, 0.0, 0.35))
    tree.add_mesh(make_cone(6, 0.2, 0.0, 0.3, 1.0))
    return tree


def make_rock(generator):
    """Return an uneven icosahedron of 20 triangles and about 1 m, about the origin."""
    rock = make_icosphere(0, 0.5)
    rock.positions = [scale(position, generator.uniform(0.8, 1.2)) for position in rock.positions]
    rock.set_smooth_normals()
    return rock


def make_caster(generator, document, materials, shared):
    """Return (kind, mesh, node scale, height of the origin above the ground). shared: kind -> mesh index, or None."""
    kind = generator.choices(("Box", "Tree", "Rock"), (0.3, 0.4, 0.3))[0]
    if shared is not None and kind in shared:
        mesh = shared[kind]
    else:
        shape = make_box((0.5, 0.5, 0.5)) if kind == "Box" else make_tree() if kind == "Tree" else make_rock(generator)
        mesh = document.add_mesh(kind, shape, materials[kind])
        if shared is not None:
            shared[kind] = mesh
    if kind == "Box":
        size = [generator.uniform(1.0, 6.0) for _ in range(3)]
        return kind, mesh, size, 0.5 * size[1] - 0.2  # its bottom is below the ground
    if kind == "Tree":
        height = generator.uniform(4.0, 12.0)
        width = height * generator.uniform(0.8, 1.2)
        return kind, mesh, [width, height, width], -0.1
    size = [generator.uniform(0.4, 2.5) for _ in range(3)]
    return kind, mesh, size, 0.25 * size[1]


def build_world(seed=1, caster_count=CASTERS, extent_m=EXTENT_M, has_mesh_per_caster=False, moving_count=0):
    """Return the world as a Document."""
    generator = random.Random(seed)
    document = Document(round(extent_m * math.sqrt(2.0), 3))
    document.add_camera("Camera", (0.0, EYE_M, 0.0), (0.0, EYE_M - 0.1, -1.0), math.radians(50.0))
    elevation = math.radians(ELEVATION_DEGREES)
    from_direction = (math.cos(elevation) * 0.8, math.sin(elevation), -math.cos(elevation) * 0.6)
    light = {"type": "directional", "color": [1.0, 0.95, 0.9], "intensity": 4.0}
    document.add_light("Sun", light, from_direction, (0.0, 0.0, 0.0), {"shadow_enabled": True, "light_angular_distance": SUN_DEGREES})
    colors = {"Ground": (0.45, 0.5, 0.35), "Box": (0.6, 0.55, 0.5), "Tree": (0.25, 0.4, 0.2), "Rock": (0.5, 0.5, 0.5)}
    materials = {name: document.add_material(name, color) for name, color in colors.items()}
    document.add_object("Ground", make_box((0.5 * extent_m + 20.0, 0.5, 0.5 * extent_m + 20.0)), materials["Ground"], (0.0, -0.5, 0.0))
    shared = None if has_mesh_per_caster else {}
    channels = []
    for index in range(caster_count):
        kind, mesh, size, height = make_caster(generator, document, materials, shared)
        x = z = 0.0
        while max(abs(x), abs(z)) < CLEARING_M:
            x, z = (generator.uniform(-0.5, 0.5) * extent_m for _ in range(2))
        rotation = quaternion_about((0.0, 1.0, 0.0), generator.uniform(0.0, 2.0 * math.pi))
        node = document.add_node("%s %d" % (kind, index), (x, height, z), rotation, mesh=mesh, scale=size)
        if index * moving_count // caster_count != (index + 1) * moving_count // caster_count:
            there = tuple(a + b for a, b in zip((x, height, z), MOTION_M))
            channels.append(Channel(node, "translation", [0.0, MOTION_S], [(x, height, z), there]))
    if channels:
        add_animation(document, "Drift", channels)
    return document


def save_world(folder, seed=1, caster_count=CASTERS, extent_m=EXTENT_M, has_mesh_per_caster=False, moving_count=0):
    """Write the world's files and return the path of the .gltf."""
    stem = "world_%d_%d_%g%s" % (seed, caster_count, extent_m, "_meshes" if has_mesh_per_caster else "")
    stem += "_moving_%d" % moving_count if moving_count else ""
    document = build_world(seed, caster_count, extent_m, has_mesh_per_caster, moving_count)
    save_files(document.build_files(stem), folder)
    return os.path.join(folder, stem + ".gltf")


def add_arguments(parser):
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--casters", type=int, default=CASTERS)
    parser.add_argument("--extent", type=float, default=EXTENT_M, help="of the square, in metres")
    parser.add_argument("--mesh-per-caster", action="store_true")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default=".", help="folder")
    parser.add_argument("--moving", type=int, default=0, help="number of casters that an animation moves")
    add_arguments(parser)
    options = parser.parse_args()
    print(save_world(options.out, options.seed, options.casters, options.extent, options.mesh_per_caster, options.moving))


if __name__ == "__main__":
    main()
