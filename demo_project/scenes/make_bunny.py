#!/usr/bin/env python3
"""Makes the bunny scenes from the mesh of Debian's package glmark2-data.

    make_bunny.py [OUT.gltf] [--mesh FILE.obj]

OUT.gltf is by default bunny.gltf next to this file (not committed), --mesh the mesh of the package.

The mesh (69,666 triangles, closed) is scaled to a height of 1.9 m and put on the ground of the study's scenes. The second file,
OUT_wax.gltf, has a translucent bunny with a wall and a light without size, as in figure 8 of Wang and Xiao 2015, to show
its self-shadow.
"""

import argparse
import os
import sys

from gltf_writer import Document, Mesh, save_files
from make_scenes import CORAL, FOLDER, SCENE_SIZE_M, add_ground, add_translucent_set, make_document, make_scatter_extras
from package_files import MeshUnavailable, find_package_file, load_obj

PACKAGE = "glmark2-data"
HEIGHT_M = 1.9
TRIANGLE_COUNT = 69666


def make_bunny(points, triangles):
    """Return the mesh, HEIGHT_M high, with its foot on y = 0 and centred on the Y axis."""
    low = [min(point[axis] for point in points) for axis in range(3)]
    high = [max(point[axis] for point in points) for axis in range(3)]
    factor = HEIGHT_M / (high[1] - low[1])
    middle = ((low[0] + high[0]) / 2.0, low[1], (low[2] + high[2]) / 2.0)
    mesh = Mesh()
    for point in points:
        # set_smooth_normals() below replaces this normal.
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
    # From the side, so that ears and head cast shadows on the body.
    add_translucent_set(document, light_eye=(-4.4, 4.4, 1.6))
    material = document.add_material("Wax", (0.85, 0.66, 0.52), roughness=0.5, extras=make_scatter_extras(0.8))
    document.add_object("Bunny", mesh, material)
    return document


def main():
    parser = argparse.ArgumentParser(description="Makes the bunny scenes.")
    parser.add_argument("out", nargs="?", default=os.path.join(FOLDER, "bunny.gltf"))
    parser.add_argument("--mesh", help="the .obj (default: that of package %s)" % PACKAGE)
    arguments = parser.parse_args()
    stem, extension = os.path.splitext(os.path.basename(arguments.out))
    if extension != ".gltf":
        raise SystemExit("ERROR: bunny: output %s must end in .gltf." % arguments.out)
    try:
        path = arguments.mesh or find_package_file(PACKAGE, "/bunny.obj")
    except MeshUnavailable as error:
        raise SystemExit("ERROR: bunny: %s. Or give the .obj with --mesh." % error)
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
