#!/usr/bin/env python3
"""Tests shadows without Gnomon's renderer: compares tests/embed/embed.cpp with `gnomon visibility` on the same scene.

Needs bin/gnomon and bin/gnomon_embed.
"""

import array
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project", "scenes"))
sys.path.insert(0, os.path.join(ROOT, "tests", "benchmark"))

from gltf_writer import Document, Mesh, add, cross, normalize, save_files  # noqa: E402
from mask_file import load_mask  # noqa: E402

SIZE = "256x256"
TIMEOUT_S = 300
STEP = 1 / 255  # of an 8-bit mask
# The quads of embed.cpp: corner, right, up.
QUADS = {
    "wall": ((-3, -1.5, -1.5), (6, 0, 0), (0, 4.5, 0)),
    "ground": ((-3, -1.5, 4.5), (6, 0, 0), (0, 0, -6)),
    "card": ((-1, -0.75, 0), (1.25, 0.25, 0.5), (-0.25, 1.5, 0.25)),
    "plank": ((-0.5, -1.5, 1), (2.5, 2, -1), (-0.125, 0.25, 0.25)),
}


def write_scene(folder):
    """Write the scene of embed.cpp as a glTF file.

    All coordinates are exact in float32, and nothing is rotated, so that both scenes are equal bit for bit. Field of view and
    near plane are the defaults of CameraSnapshot.
    """
    scene = Document(scene_size_m=8)
    material = scene.add_material("plain", (1.0, 1.0, 1.0), is_double_sided=True)
    for name, (corner, right, up) in QUADS.items():
        mesh = Mesh(is_closed=False)
        normal = normalize(cross(right, up))
        for position in (corner, add(corner, right), add(add(corner, right), up), add(corner, up)):
            mesh.add_vertex(position, normal)
        mesh.add_triangle(0, 1, 2)
        mesh.add_triangle(0, 2, 3)
        scene.add_object(name, mesh, material)
    scene.root["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.785398163, "znear": 0.05}}]
    scene.add_node("Camera", (0, 0.5, 6), None, camera=0)
    scene.add_light("Lamp", {"type": "point", "intensity": 100.0}, (1.5, 2.25, 4), None, {"light_size": 0.25})
    save_files(scene.build_files("embed"), folder)
    return os.path.join(folder, "embed.gltf")


def run(*arguments):
    result = subprocess.run(arguments, capture_output=True, text=True, check=False, timeout=TIMEOUT_S, cwd=ROOT)
    if result.returncode != 0:
        raise AssertionError("%s ended with %d: %s" % (" ".join(arguments), result.returncode, result.stderr))
    return result.stdout


def load_floats(path):
    values = array.array("f")
    with open(path, "rb") as file:
        values.frombytes(file.read())
    return values


class EmbedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        path = write_scene(cls.folder.name)
        out = os.path.join(cls.folder.name, "mask.exr")
        run("bin/gnomon", "visibility", path, "--technique", "edge_count", "--size", SIZE, "--out", out,
            "--surfaces", cls.folder.name)  # fmt: skip
        cls.mask = load_mask(out)

    def draw(self, *surfaces):
        out = os.path.join(self.folder.name, "embed.f32")
        plan = run("bin/gnomon_embed", out, *(os.path.join(self.folder.name, name) for name in surfaces))
        return load_floats(out), plan

    def test_the_scene_has_penumbrae_and_umbrae(self):
        values = [v for v, r in zip(self.mask.visibility, self.mask.receiver) if r > 0]
        self.assertGreater(len(values), 30000)
        self.assertGreater(len(self.mask.find_penumbra()), 3000)
        self.assertGreater(sum(v < 0.002 for v in values), 1000)  # below find_penumbra's range

    def test_fed_the_renderers_surfaces_the_mask_is_the_renderers_bit_for_bit(self):
        values, plan = self.draw("depth.f32", "normal.u32")
        expected = [v if r > 0 else -1.0 for v, r in zip(self.mask.visibility, self.mask.receiver)]
        self.assertEqual(list(values), expected)
        self.assertNotIn("normals from depth", plan)

    def test_with_its_own_depth_and_normals_from_it_nearly_all_receivers_agree(self):
        values, plan = self.draw()
        self.assertIn("normals from depth: runs", plan)
        both = [(a, b) for a, b, r in zip(values, self.mask.visibility, self.mask.receiver) if r > 0 and a >= 0]
        apart = sum((a >= 0) != (r > 0) for a, r in zip(values, self.mask.receiver))
        differing = sum(abs(a - b) > STEP for a, b in both)
        self.assertLessEqual(differing + apart, 0.001 * len(both))

    def test_the_program_needs_no_library_of_windows_files_or_rays(self):
        libraries = run("ldd", "bin/gnomon_embed")
        self.assertIn("libvulkan", libraries)
        for name in ("glfw", "OpenEXR", "embree", "X11", "imgui"):
            self.assertNotIn(name, libraries)

    def test_the_program_has_at_most_200_lines(self):
        with open(os.path.join(ROOT, "tests", "embed", "embed.cpp"), encoding="utf-8") as file:
            self.assertLessEqual(len(file.readlines()), 200)

    def test_surfaces_of_another_size_are_refused_by_name(self):
        path = os.path.join(self.folder.name, "short.f32")
        with open(path, "wb") as file:
            file.write(b"\0" * 4)
        result = subprocess.run(["bin/gnomon_embed", path, path, path], capture_output=True, text=True, check=False,
                                timeout=TIMEOUT_S, cwd=ROOT)  # fmt: skip
        self.assertEqual(result.returncode, 1)
        self.assertIn("short.f32", result.stderr)
        self.assertIn("--size 256x256", result.stderr)


if __name__ == "__main__":
    unittest.main()
