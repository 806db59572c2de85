"""Base class of tests that draw masks with different drivers, and compare them."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[1:1] = [os.path.join(ROOT, "tests", "benchmark"), os.path.join(ROOT, "tests", "command_line")]
from command_line_case import THREE_LIGHTS, CommandLineTest, load_json, run  # noqa: E402
from mask_file import load_mask  # noqa: E402

LIGHTS = ("Spot", "Omni", "Sun")  # of the scene three_lights


def list_techniques():
    """Return the ids of all techniques that run on the device, and that of the default one."""
    found = [item for item in load_json("techniques", "--json") if not item["is_reference"]]
    return [item["id"] for item in found], next(item["id"] for item in found if item["is_default"])


class MaskTest(CommandLineTest):
    def draw(self, technique, light, size, *arguments, **environment):
        """Return the mask of one light of the scene three_lights."""
        path = self.path("%s.%s.exr" % (technique, light))
        result = run("visibility", THREE_LIGHTS, "--light", light, "--technique", technique, "--size", size, "--out", path,
                     *arguments, **environment)  # fmt: skip
        self.assertEqual(result.returncode, 0, "%s, %s: %s" % (technique, light, result.stderr))
        return load_mask(path)

    def compare(self, one, other):
        """Return (mean absolute difference over the receivers of both masks, share of pixels that are a receiver in one only).
        Checks that both have light and shadow, and no value outside 0..1."""
        differences = []
        apart = 0
        for a, b, in_a, in_b in zip(one.visibility, other.visibility, one.receiver, other.receiver):
            self.assertTrue(0 <= a <= 1 and 0 <= b <= 1, (a, b))  # fails for NaN too
            apart += (in_a > 0) != (in_b > 0)
            if in_a > 0 and in_b > 0:
                differences.append(abs(a - b))
        for mask in (one, other):
            values = [value for value, receiver in zip(mask.visibility, mask.receiver) if receiver > 0]
            self.assertGreater(sum(value > 0.95 for value in values), len(values) / 4)
            self.assertGreater(sum(value < 0.5 for value in values), len(values) / 50)
        return sum(differences) / len(differences), apart / len(one.receiver)
