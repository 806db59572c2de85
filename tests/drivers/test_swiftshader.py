#!/usr/bin/env python3
"""Compares masks of SwiftShader, which is part of Chromium, with those of the usual driver.

Needs bin/gnomon and the package chromium. SwiftShader has no geometry shaders, few texels per buffer, and subgroups of 4, so
it takes other paths than llvmpipe. It snaps corners of triangles to 1/16 of a pixel, so that depths differ a little.
"""

import glob
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mask_case import MaskTest, list_techniques, run  # noqa: E402

DRIVERS = "/usr/lib*/chromium*/vk_swiftshader_icd.json"
# In smaller images the snapped corners move receivers behind their surface: a plane shadows itself.
SIZE = "160x160"
LIGHTS = ("Omni", "Sun")
MAX_ERROR = 0.02
# It tests whether a receiver is on the plane within less than SwiftShader's depths are off, so its shadows are missing.
IMPRECISE = ("planar",)
MAX_APART = 0.01  # share of pixels, at outlines


class SwiftShaderTest(MaskTest):
    def test_masks_are_those_of_the_usual_driver(self):
        drivers = glob.glob(DRIVERS)
        self.assertTrue(drivers, "SwiftShader is not installed: no file %s. Install chromium." % DRIVERS)
        techniques, default = list_techniques()
        techniques.remove(default)  # its largest shader takes SwiftShader minutes to compile
        techniques = [technique for technique in techniques if technique not in IMPRECISE]
        info = run("info", VK_ICD_FILENAMES=drivers[0])
        self.assertIn("SwiftShader", info.stdout, info.stderr)
        for technique in techniques:
            for light in LIGHTS:
                with self.subTest(technique=technique, light=light):
                    usual = self.draw(technique, light, SIZE)
                    other = self.draw(technique, light, SIZE, "--validation", VK_ICD_FILENAMES=drivers[0])
                    error, apart = self.compare(usual, other)
                    self.assertLess(error, MAX_ERROR)
                    self.assertLess(apart, MAX_APART)


if __name__ == "__main__":
    unittest.main()
