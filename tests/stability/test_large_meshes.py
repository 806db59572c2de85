"""Shadow volumes of large open and non-manifold meshes: at light_size=0 the masks agree with traced rays."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from make_large_meshes import MESHES, ROOT, fetch_packages, make_scene  # noqa: E402

GNOMON = os.path.abspath(os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon")))
MAX_WRONG_FRACTION = 0.0005  # of the receivers
# Name -> technique, its settings
METHODS = {
    "compute": ("shadow_volume", "technique.shadow_volume.extrusion=compute"),
    "geometry shader": ("shadow_volume", "technique.shadow_volume.extrusion=geometry_shader"),
    "z-fail": ("shadow_volume", "technique.shadow_volume.method=z_fail"),
    "CPU": ("shadow_volume_cpu",),
}


def run(*arguments):
    result = subprocess.run([GNOMON, *arguments], capture_output=True, text=True, check=False, timeout=600)
    if result.returncode != 0:
        raise AssertionError("gnomon %s: %s" % (" ".join(arguments), result.stderr.strip()))
    return result.stdout


def render(scene, out, technique, *settings):
    arguments = [word for setting in ("light_size=0", *settings) for word in ("--set", setting)]
    return run("visibility", scene, "--technique", technique, "--size", "400x400", "--plan", "--out", out, *arguments)


class LargeMeshes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = cls.holder.name
        fetch_packages(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    def check(self, name):
        scene = make_scene(name, self.folder)
        reference, mask = os.path.join(self.folder, "reference.exr"), os.path.join(self.folder, "mask.exr")
        render(scene, reference, "reference", "reference_samples=1")
        for method_name, (technique, *settings) in METHODS.items():
            with self.subTest(mesh=name, method_name=method_name):
                plan = render(scene, mask, technique, *settings)
                # Parts of a mesh that are not solid need robust volumes (doc/techniques/shadow_volume.md).
                self.assertIn("robust volumes, casters: 1: runs", plan)
                found = json.loads(run("compare", reference, mask))
                # Each value is 0 or 1, so the MAE is the fraction of the receivers that differ.
                wrong = round(found["receiver"]["mae"] * found["pixels"])
                print("%s, %s: %d of %d receivers differ from rays" % (name, method_name, wrong, found["pixels"]))
                self.assertGreater(found["pixels"], 50000)
                self.assertLessEqual(wrong, MAX_WRONG_FRACTION * found["pixels"])


def add_test(name):
    setattr(LargeMeshes, "test_" + name, lambda self: self.check(name))


for mesh in MESHES:
    add_test(mesh)

if __name__ == "__main__":
    unittest.main()
