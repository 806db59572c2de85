"""Finds files of installed Debian packages, and reads Wavefront OBJ meshes."""

import subprocess


class MeshUnavailable(Exception):
    """A mesh is missing or unusable. The text names what is missing, and the next step where there is one."""


def find_package_file(package, ending):
    """Return the path of the package's first file whose path ends with ending. Raises MeshUnavailable."""
    try:
        result = subprocess.run(["dpkg", "-L", package], capture_output=True, text=True, check=False)
    except FileNotFoundError as error:
        raise MeshUnavailable("dpkg is missing, so that files of package %s cannot be found" % package) from error
    if result.returncode != 0:
        raise MeshUnavailable("package %s is not installed. Install it with apt-get" % package)
    for line in result.stdout.splitlines():
        if line.endswith(ending):
            return line
    raise MeshUnavailable("package %s has no file %s. Is this Debian 12?" % (package, ending))


def load_obj(path):
    """Return (vertices, triangles) of a Wavefront OBJ file of convex polygons, with all groups merged."""
    points, triangles = [], []
    with open(path, encoding="utf-8", errors="replace") as file:  # names may have any encoding
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
