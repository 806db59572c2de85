#!/usr/bin/env python3
"""Tests llvmpipe with other widths of its vectors, which are the sizes of its subgroups: 8 by default (256 bits).

Needs bin/gnomon and bin/gnomon_tests. Other drivers ignore the variable.
"""

import glob
import os
import re
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mask_case import LIGHTS, ROOT, MaskTest, list_techniques, run  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "tests", "benchmark"))
import twig_scenes  # noqa: E402
from gltf_writer import save_files  # noqa: E402

TIMEOUT_S = 600
WIDE, NARROW = "512", "128"  # 16 and 4 invocations
SIZE = "64x64"
MAX_ERROR = 1e-3  # rounding; a fault of subgroups changes whole blocks
# Tests whose file has one of these draw: with 4 invocations llvmpipe's rasteriser crashes at random.
DRAWING = re.compile("raster_pipeline|begin_rendering|MaskFixture|render_mask")
COMPUTING = re.compile("kernel_fixture.h|subgroups.comp")
MIN_FILES = 10


def find_compute_tests():
    """Return the paths of C++ test files that run compute shaders and draw nothing."""
    found = []
    for pattern in ("modules/*/tests/test_*.cpp", "tests/shaders/test_*.cpp"):
        for path in sorted(glob.glob(os.path.join(ROOT, pattern))):
            with open(path, encoding="utf-8") as file:
                text = file.read()
            if COMPUTING.search(text) and not DRAWING.search(text):
                found.append(os.path.relpath(path, ROOT))
    return found


class WideVectorsTest(MaskTest):
    def test_masks_of_all_techniques_and_types_of_light_are_equal_with_subgroups_of_16(self):
        for technique in list_techniques()[0]:
            for light in LIGHTS:
                with self.subTest(technique=technique, light=light):
                    usual = self.draw(technique, light, SIZE)
                    error, apart = self.compare(usual, self.draw(technique, light, SIZE, LP_NATIVE_VECTOR_WIDTH=WIDE))
                    self.assertLess(error, MAX_ERROR)
                    self.assertEqual(apart, 0)


class IterationsTest(MaskTest):
    """llvmpipe ends all loops after an invocation has made 65,535 iterations in them."""

    def test_lists_of_very_many_edges_are_complete_or_not_used(self):
        scene = twig_scenes.build_scene(seed=1, count=8, alpha_mode="MASK")
        save_files(scene.build_files(twig_scenes.STEM), self.folder)
        # With the pattern, passes that read what none wrote find a fault, at which run() fails.
        result = run("visibility", self.path(twig_scenes.STEM + ".gltf"), "--technique", list_techniques()[1], "--light", "Omni",
                     "--size", "280x280", "--out", self.path("mask.exr"), GNOMON_MEMORY_PATTERN="deadbeef")  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)


class NarrowVectorsTest(unittest.TestCase):
    def test_compute_shaders_that_draw_nothing_pass_their_tests_with_subgroups_of_4(self):
        files = find_compute_tests()
        self.assertGreaterEqual(len(files), MIN_FILES)
        environment = dict(os.environ, LP_NATIVE_VECTOR_WIDTH=NARROW)
        command = [os.path.join(ROOT, "bin", "gnomon_tests"), "--source-file=" + ",".join("*" + path for path in files)]
        result = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        passed = int(re.search(r"^(\d+) passed, 0 failed", result.stdout, re.MULTILINE).group(1))
        self.assertGreaterEqual(passed, len(files))


if __name__ == "__main__":
    unittest.main()
