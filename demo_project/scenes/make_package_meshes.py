#!/usr/bin/env python3
"""Makes scenes of third-party meshes in Debian packages, unrepaired: open, duplicated and intersecting, in many formats.

    make_package_meshes.py [--scenes A,B] [--out DIR]

Needs the packages assimp-utils (command assimp), assimp-testmodels and glmark2-data. By default it writes package_NAME.gltf
next to this file; these files are not committed. A mesh that is missing or cannot be converted is named on stderr, the others
are made, and the exit code is 1.
"""

import argparse
import math
import os
import subprocess
import sys
import tempfile
from collections import namedtuple

from gltf_writer import Mesh, add, cross, dot, normalize, quaternion_about, rotate, save_files, scale, subtract
from make_artist_scenes import make_artist_set
from make_scenes import AMBER, BARK, CORAL, FOLDER, JADE, MOSS, PLUM, SAND, SKY, TEAL
from package_files import MeshUnavailable, find_package_file, load_obj

PREFIX = "package_"
TIMEOUT_S = 120
MAX_HEIGHT_M, MAX_WIDTH_M = 1.9, 2.6  # about the size of the study's casters
LIFT_M = 0.002  # a flat sole in the ground's plane would cause z-fighting
CREASE_COSINE = math.cos(math.radians(50.0))  # between face normals; flatter edges are shaded smoothly
MIN_DOUBLE_AREA_SQUARED_M4 = 1e-18  # of (2 x area)^2; smaller triangles count as having no area

TEST_MODELS, BENCHMARK_MODELS = "assimp-testmodels", "glmark2-data"
UPRIGHT = (0.0, 0.0, 0.0, 1.0)
Z_UP = quaternion_about((1.0, 0.0, 0.0), -0.5 * math.pi)
Z_DOWN = quaternion_about((1.0, 0.0, 0.0), 0.5 * math.pi)
X_DOWN = quaternion_about((0.0, 0.0, 1.0), -0.5 * math.pi)

# ending: of the file's path. rotation: takes the file's up direction to +Y.
PackageMesh = namedtuple("PackageMesh", "package ending rotation color")
MESHES = {
    "jeep": PackageMesh(TEST_MODELS, "/MS3D/jeep1.ms3d", UPRIGHT, MOSS),
    "spider": PackageMesh(TEST_MODELS, "/OBJ/spider.obj", UPRIGHT, BARK),
    "regr01": PackageMesh(TEST_MODELS, "/OBJ/regr01.obj", Z_UP, SAND),
    "wuson": PackageMesh(TEST_MODELS, "/OBJ/WusonOBJ.obj", UPRIGHT, CORAL),
    "duck": PackageMesh(TEST_MODELS, "/Collada/duck.dae", UPRIGHT, AMBER),
    "grail": PackageMesh(TEST_MODELS, "/SMD/holy_grailref.smd", Z_UP, SAND),
    "epileptic": PackageMesh(TEST_MODELS, "/X/BCN_Epileptic.X", Z_DOWN, TEAL),
    "cat": PackageMesh(BENCHMARK_MODELS, "/cat.3ds", Z_DOWN, PLUM),
    "horse": PackageMesh(BENCHMARK_MODELS, "/horse.3ds", X_DOWN, SKY),
}


def convert_to_triangles(path):
    """Return (vertices, triangles) of a file in any format that assimp reads; the transforms of its nodes are applied."""
    with tempfile.TemporaryDirectory() as folder:
        converted = os.path.join(folder, "mesh.obj")
        try:
            result = subprocess.run(
                ["assimp", "export", path, converted, "-tri"], capture_output=True, text=True, errors="replace",
                check=False, timeout=TIMEOUT_S,
            )  # fmt: skip
        except FileNotFoundError as error:
            raise MeshUnavailable("the command assimp is missing. Install package assimp-utils") from error
        except subprocess.TimeoutExpired as error:
            raise MeshUnavailable("assimp did not convert %s within %d s" % (path, TIMEOUT_S)) from error
        if result.returncode != 0 or not os.path.isfile(converted):
            lines = (result.stdout + result.stderr).strip().splitlines()
            raise MeshUnavailable("assimp did not convert %s: %s" % (path, lines[-1] if lines else "no message"))
        try:
            return load_obj(converted)
        except (ValueError, IndexError) as error:
            raise MeshUnavailable("what assimp made of %s cannot be read: %s" % (path, error)) from error


def fit_points(points, rotation):
    """Return the points, rotated, scaled to fit MAX_WIDTH_M and MAX_HEIGHT_M, and centred on the Y axis LIFT_M above y = 0."""
    rotated_points = [rotate(rotation, point) for point in points]
    low = [min(point[axis] for point in rotated_points) for axis in range(3)]
    high = [max(point[axis] for point in rotated_points) for axis in range(3)]
    width = max(high[0] - low[0], high[2] - low[2])
    if not all(math.isfinite(value) for value in low + high) or width <= 0.0:
        raise MeshUnavailable("its vertices reach from %s to %s, which cannot be scaled" % (low, high))
    factor = min(MAX_WIDTH_M / width, MAX_HEIGHT_M / max(high[1] - low[1], 1e-6 * width))
    foot = (0.5 * (low[0] + high[0]), low[1], 0.5 * (low[2] + high[2]))
    return [add(scale(subtract(point, foot), factor), (0.0, LIFT_M, 0.0)) for point in rotated_points]


def make_creased_mesh(points, triangles):
    """Return a mesh of all triangles that have an area; vertices are split at creases."""
    mesh = Mesh(is_closed=False, is_manifold=False)
    faces, area_normals, faces_of = [], [], {}
    for triangle in triangles:
        corners = [points[index] for index in triangle]
        area_normal = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]))
        if dot(area_normal, area_normal) <= MIN_DOUBLE_AREA_SQUARED_M4:
            continue
        for corner in corners:
            faces_of.setdefault(corner, []).append(len(faces))
        faces.append(corners)
        area_normals.append(area_normal)
    if not faces:
        raise MeshUnavailable("it has no triangle with an area")
    directions = [normalize(area_normal) for area_normal in area_normals]
    known = {}
    for face, corners in enumerate(faces):
        indices = []
        for corner in corners:
            total = (0.0, 0.0, 0.0)
            for other in faces_of[corner]:
                if dot(directions[face], directions[other]) >= CREASE_COSINE:
                    total = add(total, area_normals[other])
            key = (corner, tuple(round(value, 5) for value in normalize(total)))
            if key not in known:
                known[key] = mesh.add_vertex(corner, total)
            indices.append(known[key])
        mesh.add_triangle(*indices)
    return mesh


def build_scene_files(name, item):
    """Return file name -> bytes of a scene with the mesh. Raises MeshUnavailable."""
    points, triangles = convert_to_triangles(find_package_file(item.package, item.ending))
    if not triangles:
        raise MeshUnavailable("%s has no triangles" % item.ending)
    mesh = make_creased_mesh(fit_points(points, item.rotation), triangles)
    document = make_artist_set()
    # These formats do not define which side of an open mesh is seen; viewers show both.
    document.add_object("Mesh", mesh, document.add_material("Mesh", item.color, roughness=0.6, is_double_sided=True))
    return document.build_files(PREFIX + name)


def make_scenes(meshes, folder):
    """Make the scenes. Return the names of those that failed, after printing an error for each."""
    failed = []
    for name, item in meshes.items():
        try:
            save_files(build_scene_files(name, item), folder)
            print(os.path.join(folder, PREFIX + name + ".gltf"))
        except (MeshUnavailable, ValueError) as error:
            print("ERROR: package mesh %s (%s of %s): %s." % (name, item.ending, item.package, error), file=sys.stderr)
            failed.append(name)
    return failed


def main():
    parser = argparse.ArgumentParser(description="Makes scenes of meshes of Debian packages.")
    parser.add_argument("--scenes", default=",".join(MESHES), help="comma-separated (default: %(default)s)")
    parser.add_argument("--out", default=FOLDER, help="folder to write to (default: next to this file)")
    arguments = parser.parse_args()
    names = [name for name in arguments.scenes.split(",") if name]
    if not names or any(name not in MESHES for name in names):
        parser.error("--scenes is %r, must be of: %s" % (arguments.scenes, ", ".join(MESHES)))
    return 1 if make_scenes({name: MESHES[name] for name in names}, arguments.out) else 0


if __name__ == "__main__":
    sys.exit(main())
