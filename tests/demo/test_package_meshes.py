"""Meshes of Debian packages are converted to scenes. Missing or broken ones are reported, and the others are still converted."""

import contextlib
import io
import math
import os
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENES = os.path.join(ROOT, "demo_project", "scenes")
sys.path.insert(0, SCENES)
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import gltf_writer  # noqa: E402
import make_package_meshes  # noqa: E402
import package_files  # noqa: E402
from project_scenes import list_project_scenes  # noqa: E402

# In OBJ. The third face has texture coordinates. The fourth has negative indices, which count from
# the last vertex.
TETRAHEDRON = "v 0 0 0\nv 4 0 0\nv 0 0 4\nv 0 8 0\nf 1 2 3\nf 1 4 2\nf 1/1 3/2 4/3\nf -3 -1 -2\n"


def is_installed(package):
    result = subprocess.run(["dpkg", "-L", package], capture_output=True, check=False)
    return result.returncode == 0


class PackageMeshes(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = os.path.join(self.holder.name, "out")

    def make(self, meshes):
        """Convert meshes. Return (names that failed, messages on stderr)."""
        messages = io.StringIO()
        with contextlib.redirect_stderr(messages), contextlib.redirect_stdout(io.StringIO()):
            failed = make_package_meshes.make_scenes(meshes, self.folder)
        return failed, messages.getvalue()

    def test_every_mesh_of_the_packages_becomes_a_scene(self):
        for package in ("assimp-utils", make_package_meshes.TEST_MODELS, make_package_meshes.BENCHMARK_MODELS):
            if not is_installed(package):
                self.skipTest("package %s is not installed" % package)
        failed, messages = self.make(make_package_meshes.MESHES)
        self.assertEqual((failed, messages), ([], ""))
        expected = {"package_%s.%s" % (name, kind) for name in make_package_meshes.MESHES for kind in ("gltf", "bin")}
        self.assertEqual(set(os.listdir(self.folder)), expected)

    def test_a_missing_and_a_broken_mesh_are_named_and_the_others_are_made(self):
        paths = {"/good.obj": TETRAHEDRON, "/broken.dae": "<no", "/empty.obj": "# nothing\n"}
        for ending, text in paths.items():
            with open(self.holder.name + ending, "w", encoding="utf-8") as file:
                file.write(text)

        def find(package, ending):
            if ending not in paths:
                raise package_files.MeshUnavailable("package %s has no file %s" % (package, ending))
            return self.holder.name + ending

        def item(ending):
            return make_package_meshes.PackageMesh("some-package", ending, make_package_meshes.UPRIGHT, (1, 1, 1))

        endings = {"gone": "/gone.obj", "broken": "/broken.dae", "empty": "/empty.obj", "good": "/good.obj"}
        meshes = {name: item(ending) for name, ending in endings.items()}
        with mock.patch.object(make_package_meshes, "find_package_file", find):
            failed, messages = self.make(meshes)
        expected = ["gone", "broken", "empty"]
        if not is_installed("assimp-utils"):
            expected.append("good")
            self.assertIn("Install package assimp-utils", messages)
        self.assertEqual(failed, expected)
        lines = messages.splitlines()
        self.assertEqual(len(lines), len(failed))
        for name, line in zip(failed, lines):
            self.assertTrue(line.startswith("ERROR: package mesh %s (" % name), line)
        # The folder is made with the first scene that is written.
        self.assertEqual("good" in failed, not os.path.isdir(self.folder))

    def test_a_package_that_is_not_installed_is_named(self):
        with self.assertRaisesRegex(package_files.MeshUnavailable, "no-such-package is not installed"):
            package_files.find_package_file("no-such-package", "/x.obj")

    def test_an_obj_is_read_with_polygons_negative_indices_and_bytes_that_are_not_utf_8(self):
        path = os.path.join(self.holder.name, "mesh.obj")
        with open(path, "wb") as file:
            file.write(b"o \xe6\xff\n" + TETRAHEDRON.encode() + b"f 1 2 4 3\n")
        points, triangles = package_files.load_obj(path)
        self.assertEqual(points[3], (0.0, 8.0, 0.0))
        self.assertEqual(triangles, [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2), (0, 1, 3), (0, 3, 2)])

    def test_a_mesh_is_scaled_to_the_scene_and_is_above_the_ground(self):
        points = make_package_meshes.fit_points([(10, 500, 0), (30, 500, 0), (10, 540, 70)], make_package_meshes.UPRIGHT)
        heights = [point[1] for point in points]
        self.assertAlmostEqual(min(heights), make_package_meshes.LIFT_M)
        self.assertLessEqual(max(heights) - min(heights), make_package_meshes.MAX_HEIGHT_M + 1e-9)
        for axis in (0, 2):
            values = [point[axis] for point in points]
            self.assertAlmostEqual(min(values), -max(values))
            self.assertLessEqual(max(values), 0.5 * make_package_meshes.MAX_WIDTH_M + 1e-9)

    def test_rotations_turn_their_axis_up(self):
        for rotation, upward in (
            (make_package_meshes.Z_UP, (0, 0, 1)),
            (make_package_meshes.Z_DOWN, (0, 0, -1)),
            (make_package_meshes.X_DOWN, (-1, 0, 0)),
        ):
            self.assertLess(math.dist(gltf_writer.rotate(rotation, upward), (0, 1, 0)), 1e-12)

    def test_duplicate_faces_stay_and_degenerate_ones_are_removed(self):
        points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (2.0, 0.0, 0.0)]
        # The last two have no area: three points on a line, and a corner that occurs twice.
        mesh = make_package_meshes.make_creased_mesh(points, [(0, 1, 2), (0, 1, 2), (0, 2, 1), (0, 1, 3), (0, 0, 1)])
        self.assertEqual(len(mesh.triangles), 3)
        mesh.check("doubled")
        for a, _, _ in mesh.triangles:
            self.assertAlmostEqual(abs(mesh.normals[a][2]), 1.0)

    def test_the_project_lists_every_scene(self):
        listed = list_project_scenes()
        expected = {"scenes/package_%s.gltf" % name for name in make_package_meshes.MESHES}
        self.assertEqual({item for item in listed if "/package_" in item}, expected)


if __name__ == "__main__":
    unittest.main()
