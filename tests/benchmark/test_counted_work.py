"""Work of edge_count that does not depend on the machine, as its shaders count it: enough invocations for a GPU, and
none with a long chain of steps."""

import json
import os
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MIN_SUBGROUP = 4  # invocations
MIN_INVOCATIONS = 50000
MAX_STEPS = 300


def count_work(scene):
    with tempfile.TemporaryDirectory() as folder:
        times = os.path.join(folder, "times.json")
        subprocess.run(
            [os.path.join(ROOT, "bin", "gnomon"), "visibility", os.path.join(ROOT, "demo_project", "scenes", scene + ".gltf"),
             "--technique", "edge_count", "--size", "1920x1080", "--out", os.path.join(folder, "mask.exr"), "--time", times],
            check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        with open(times, encoding="utf-8") as file:
            return json.load(file)["counters"]


class CountedWorkTest(unittest.TestCase):
    def test_passes_over_edges_have_many_invocations_and_short_chains(self):
        for scene in ("torus_knot", "clutter"):
            with self.subTest(scene=scene):
                counters = count_work(scene)
                # list_leaves has a subgroup for each leaf, the passes that count edges 64 invocations or more.
                self.assertGreater(counters["leaves"] * MIN_SUBGROUP, MIN_INVOCATIONS)
                self.assertGreater(counters["longest_walk"], 10)
                self.assertLess(counters["longest_walk"], MAX_STEPS)
                self.assertGreater(counters["longest_count"], 10)
                self.assertLess(counters["longest_count"], MAX_STEPS)


if __name__ == "__main__":
    unittest.main()
