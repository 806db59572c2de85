"""The valley of make_valley.py: a world that is not committed."""

import json
import os
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project", "scenes"))

import make_valley  # noqa: E402


def read_files(folder):
    """Return the content of each file by its name."""
    files = {}
    for name in os.listdir(folder):
        with open(os.path.join(folder, name), "rb") as file:
            files[name] = file.read()
    return files


class ValleyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = []
        for seed in (1, 1, 2):
            with tempfile.TemporaryDirectory() as folder:
                path = make_valley.save_valley(folder, seed, is_small=True)
                cls.files.append(read_files(folder))
            if seed == 1:
                cls.root = json.loads(cls.files[0][os.path.basename(path)])

    def test_equal_seeds_write_equal_files_and_others_do_not(self):
        self.assertEqual(self.files[0], self.files[1])
        self.assertNotEqual(sorted(self.files[0].values()), sorted(self.files[2].values()))

    def test_it_has_20_000_casters_on_a_terrain_and_three_suns(self):
        names = [node["name"].split(" ")[0] for node in self.root["nodes"] if "mesh" in node]
        counts = {name: names.count(name) for name in set(names)}
        self.assertEqual(counts["Terrain"], make_valley.PIECES**2)
        self.assertEqual(counts["House"], make_valley.HOUSES)
        self.assertEqual(counts["Tree"] + counts["Rock"] + counts["House"], 20000)
        lights = self.root["extensions"]["KHR_lights_punctual"]["lights"]
        self.assertEqual([light["name"] for light in lights], ["Low", "High", "Overcast"])

    def test_the_walk_has_600_frames_at_eye_height(self):
        animation = self.root["animations"][0]
        accessor = self.root["accessors"][animation["samplers"][0]["input"]]
        self.assertEqual(accessor["count"], make_valley.FRAMES)
        self.assertAlmostEqual(accessor["max"][0], (make_valley.FRAMES - 1) / make_valley.FRAMES_PER_S, places=4)


if __name__ == "__main__":
    unittest.main()
