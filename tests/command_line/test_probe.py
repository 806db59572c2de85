#!/usr/bin/env python3
"""`gnomon visibility --probe`: what is printed of one pixel, for any technique."""

import json
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import SMALL, CommandLineTest, run  # noqa: E402


class Probe(CommandLineTest):
    def probe(self, pixel, *arguments):
        """Return what --probe-json wrote and what was printed."""
        path = self.path("probe.json")
        result = run("visibility", self.write_scene(self.scene), "--technique", self.get_fallback(), *SMALL,
                     "--probe", pixel, "--probe-json", path, *arguments)  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(path, encoding="utf-8") as file:
            return json.load(file), result.stdout

    def test_a_receiver_is_described_with_its_reference(self):
        found, printed = self.probe("16,20")
        self.assertEqual(found["pixel"], {"x": 16, "y": 20})
        self.assertEqual(found["technique"], self.get_fallback())
        self.assertEqual(found["light"], self.get_light()["name"])
        surface = found["surface"]
        self.assertAlmostEqual(sum(x * x for x in surface["normal_world"]), 1.0, places=5)
        side = sum(n * p for n, p in zip(surface["normal_world"], surface["position_world_m"])) + surface["plane_offset_m"]
        self.assertAlmostEqual(side, 0.0, places=4)
        self.assertTrue(0 <= found["mask"] <= 1)
        self.assertAlmostEqual(found["reference_mask"]["error_of_the_mask"], found["mask"] - found["reference_mask"]["visibility"])
        self.assertIn("pixel:\n    x: 16\n    y: 20\n", printed)
        self.assertIn("    plane_offset_m: ", printed)

    def test_the_worst_pixel_has_the_largest_error(self):
        worst, _ = self.probe("worst")
        error = abs(worst["reference_mask"]["error_of_the_mask"])
        for x in range(8, 32, 6):
            found, _ = self.probe("%d,20" % x)
            if "reference_mask" in found:
                self.assertLessEqual(abs(found["reference_mask"]["error_of_the_mask"]), error)
        again, _ = self.probe("%d,%d" % (worst["pixel"]["x"], worst["pixel"]["y"]))
        self.assertEqual(again, worst)

    def test_the_background_and_surfaces_without_light_say_so(self):
        found, _ = self.probe("0,0")
        self.assertIn("background", found["surface"])
        self.find_node("Light")["translation"] = [0.0, -50.0, 0.0]
        found, _ = self.probe("16,20")
        self.assertIn("none", found["mask"])

    def test_the_mask_is_written_as_well_if_it_is_requested(self):
        self.probe("16,20", "--out", self.path("mask.exr"))
        self.assertTrue(os.path.exists(self.path("mask.exr")))

    def test_pixels_outside_the_image_are_refused(self):
        scene = self.write_scene(self.scene)
        for pixel in ("32,0", "0,32", "-1,0", "1", "1,", ",1", "1,2,3", "1.5,2", "best", ""):
            result = run("visibility", scene, "--technique", self.get_fallback(), *SMALL, "--probe", pixel)
            self.assert_refused(result, "--probe", "31,31", "worst", code=2)
        result = run("visibility", scene, "--technique", self.get_fallback(), *SMALL)
        self.assert_refused(result, "--out", "--probe", code=2)


if __name__ == "__main__":
    unittest.main()
