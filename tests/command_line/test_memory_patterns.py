"""Masks do not depend on what new device memory contains: no pass reads what no pass wrote."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import THREE_LIGHTS, CommandLineTest, find_technique, load_json, run  # noqa: E402

LIGHTS = ("Spot", "Omni", "Sun")
PATTERNS = ("1", "deadbeef", "nan", "random")


class MemoryPatterns(CommandLineTest):
    def draw(self, technique, light, pattern):
        """Return the bytes of a mask that is drawn with new memory filled by the pattern (None: as the driver gives it)."""
        out = self.path("mask.exr")
        result = run("visibility", THREE_LIGHTS, "--technique", technique, "--light", light, "--size", "48x48", "--set", "reference_samples=16",
                     "--out", out, GNOMON_MEMORY_PATTERN=pattern)  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(out, "rb") as file:
            return file.read()

    def check(self, technique, patterns):
        for light in LIGHTS:
            expected = self.draw(technique, light, None)
            for pattern in patterns:
                with self.subTest(technique=technique, light=light, pattern=pattern):
                    self.assertEqual(self.draw(technique, light, pattern), expected)

    def test_masks_of_the_default_technique_are_equal_with_memory_of_each_pattern(self):
        self.check(find_technique("is_default"), PATTERNS)

    def test_masks_of_all_other_techniques_are_equal_with_random_memory(self):
        for technique in load_json("techniques", "--json"):
            if not technique["is_default"] and not technique["is_reference"]:
                self.check(technique["id"], ("random",))

    def test_an_unknown_pattern_is_an_error_that_lists_the_known_ones(self):
        result = run("visibility", THREE_LIGHTS, "--technique", find_technique("is_default"), "--size", "16x16", "--out",
                     self.path("mask.exr"), GNOMON_MEMORY_PATTERN="zeros")  # fmt: skip
        self.assertEqual(result.returncode, 1)
        self.assertIn('GNOMON_MEMORY_PATTERN is "zeros", must be 1, deadbeef, nan or random', result.stderr)


if __name__ == "__main__":
    unittest.main()
