#!/usr/bin/env python3
"""Makes the bunny scenes from the mesh of Debian's package glmark2-data.

    make_bunny.py [OUT.gltf]       default: bunny.gltf beside this file (not committed)

The mesh (69,666 triangles, closed) is scaled to 1.9 m and put on the ground of the study's scenes. Beside OUT.gltf,
OUT_wax.gltf has a translucent one, before a wall and a point light, as in figure 8 of Wang and Xiao 2015; its
self-shadow is what it is about.
"""

import argparse
import os
import subprocess
import sys

from gltf_writer import Document, Mesh, save_files
from make_scenes import CORAL, FOLDER, SCENE_SIZE_M, add_ground, add_translucent_set, make_document, make_scatter_extras

PACKAGE = "glmark2-data"
HEIGHT_M = 1.9
TRIANGLE_COUNT = 69666


def find_mesh_file():
    try:
        result = subprocess.run(["dpkg", "-L", PACKAGE], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise SystemExit("ERROR: bunny: dpkg is missing, so package %s cannot be asked. Give the .obj with --mesh." % PACKAGE)
    for line in result.stdout.splitlines():
        if line.endswith("/bunny.obj"):
            return line
    raise SystemExit("ERROR: bunny: package %s is not installed. Install it, or give the .obj with --mesh." % PACKAGE)


def load_obj(path):
    """Vertices and triangles of a Wavefront OBJ of triangles or convex polygons."""
    points, triangles = [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append(tuple(float(word) for word in words[1:4]))
            elif words[0] == "f":
                corners = [int(word.split("/")[0]) for word in words[1:]]
                corners = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
                triangles += [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]
    return points, triangles


def make_bunny(points, triangles):
    low = [min(point[axis] for point in points) for axis in range(3)]
    high = [max(point[axis] for point in points) for axis in range(3)]
    factor = HEIGHT_M / (high[1] - low[1])
    middle = ((low[0] + high[0]) / 2.0, low[1], (low[2] + high[2]) / 2.0)
    mesh = Mesh()
    for point in points:
        mesh.add_vertex([(point[axis] - middle[axis]) * factor for axis in range(3)], (0.0, 1.0, 0.0))
    mesh.triangles = triangles
    mesh.set_smooth_normals()
    return mesh


def make_scene(mesh):
    document = make_document()
    add_ground(document)
    material = document.add_material("Bunny", CORAL, roughness=0.5)
    document.add_object("Bunny", mesh, material)
    return document


def make_wax_scene(mesh):
    document = Document(SCENE_SIZE_M)
    # From the side, so that ears and head cast on the body.
    add_translucent_set(document, light_eye=(-4.4, 4.4, 1.6))
    material = document.add_material("Wax", (0.85, 0.66, 0.52), roughness=0.5, extras=make_scatter_extras(0.8))
    document.add_object("Bunny", mesh, material)
    return document


def main():
    parser = argparse.ArgumentParser(description="Makes the bunny scene.")
    parser.add_argument("out", nargs="?", default=os.path.join(FOLDER, "bunny.gltf"))
    parser.add_argument("--mesh", help="the .obj (default: that of package %s)" % PACKAGE)
    arguments = parser.parse_args()
    stem, extension = os.path.splitext(os.path.basename(arguments.out))
    if extension != ".gltf":
        raise SystemExit("ERROR: bunny: output %s must end in .gltf." % arguments.out)
    path = arguments.mesh or find_mesh_file()
    try:
        points, triangles = load_obj(path)
    except (OSError, ValueError, IndexError) as error:
        raise SystemExit("ERROR: bunny: cannot read %s: %s" % (path, error))
    if len(triangles) != TRIANGLE_COUNT:
        print("WARNING: bunny: %s has %d triangles, not %d." % (path, len(triangles), TRIANGLE_COUNT), file=sys.stderr)
    mesh = make_bunny(points, triangles)
    files = make_scene(mesh).build_files(stem)
    files.update(make_wax_scene(mesh).build_files(stem + "_wax"))
    save_files(files, os.path.dirname(os.path.abspath(arguments.out)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
