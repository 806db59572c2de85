"""The simplest scenes: one box and one torus on a plane, with a spot, an omni light and a sun."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from gltf_writer import save_files  # noqa: E402
from make_artist_scenes import make_artist_set  # noqa: E402
from make_scenes import CORAL  # noqa: E402
from shapes import make_box, make_torus  # noqa: E402

SHAPES = {"plain_box": make_box((0.5, 0.5, 0.5)), "plain_torus": make_torus(0.7, 0.25, 48, 24)}


def make_plain_scenes(folder):
    """Paths by name."""
    paths = {}
    for name, mesh in SHAPES.items():
        document = make_artist_set()
        document.add_object("Caster", mesh, document.add_material("Caster", CORAL), (0.0, 0.8, 0.0))
        save_files(document.build_files(name), folder)
        paths[name] = os.path.join(folder, name + ".gltf")
    return paths
