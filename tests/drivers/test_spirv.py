#!/usr/bin/env python3
"""Tests the SPIR-V of the release build. Needs the build, glslangValidator and spirv-opt."""

import glob
import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))
sys.path.insert(0, os.path.join(ROOT, "shaders"))
import spirv_phis  # noqa: E402

MIN_FILES = 80
# Promotes variables to values without splitting them before: makes phis of structures.
BAD_PASSES = ("--eliminate-local-single-block", "--ssa-rewrite")


class SpirvTest(unittest.TestCase):
    def test_no_shader_has_a_phi_of_a_structure_or_array(self):
        paths = glob.glob(os.path.join(ROOT, "build", "release", "shaders", "*", "*.spv"))
        self.assertGreater(len(paths), MIN_FILES)
        for path in paths:
            self.assertEqual(spirv_phis.count_aggregate_phis(spirv_phis.load_words(path)), 0, path)

    def test_such_a_phi_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "phi.spv")
            source = os.path.join(FOLDER, "structure_phi.comp")
            subprocess.run(["glslangValidator", "-V", "--quiet", "--target-env", "vulkan1.1", "-o", path, source], check=True)
            self.assertEqual(spirv_phis.count_aggregate_phis(spirv_phis.load_words(path)), 0)
            subprocess.run(["spirv-opt", *BAD_PASSES, path, "-o", path], check=True)
            self.assertEqual(spirv_phis.count_aggregate_phis(spirv_phis.load_words(path)), 2)

    def test_a_file_without_spirv_is_an_error_that_names_it(self):
        with self.assertRaisesRegex(ValueError, "structure_phi.comp holds no SPIR-V"):
            spirv_phis.load_words(os.path.join(FOLDER, "structure_phi.comp"))


if __name__ == "__main__":
    unittest.main()
