"""Tests `--animation`, `--at` and `--speed`: which time of a scene's animation is drawn, and which values are refused."""

import json
import os
import shutil
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import SCENES, CommandLineTest, run  # noqa: E402

COURTYARD = os.path.join(SCENES, "courtyard.gltf")
SMALL = ("--size", "48x36", "--camera", "Walk camera")


class AnimationTest(CommandLineTest):
    def inputs(self):
        return super().inputs() + ("project.cfg", *(name for name in os.listdir(SCENES) if name.startswith("courtyard")))

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def draw(self, *arguments, scene=COURTYARD):
        """Draw headless and return the bytes of the PNG."""
        words = ("run", scene, "--headless", *SMALL, "--antialiasing", "1", "--technique", self.get_fallback(), *arguments)
        result = run(*words, "--capture", self.path("shown.png"))
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.read("shown.png")

    def make_mask(self, *arguments):
        result = run("visibility", COURTYARD, "--technique", self.get_fallback(), *SMALL, *arguments, "--out", self.path("mask.exr"))
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.read("mask.exr")

    def make_project(self, defaults):
        for name in os.listdir(SCENES):
            if name.startswith("courtyard"):
                shutil.copy(os.path.join(SCENES, name), self.folder)
        self.write("project.cfg", '[project]\nstart_scene="courtyard.gltf"\n\n[defaults]\n%s\n' % defaults)
        return self.folder

    def test_masks_show_the_pose_at_the_given_time(self):
        at_rest = self.make_mask()
        self.assertEqual(self.make_mask(), at_rest)
        moved = self.make_mask("--at", "1.5")
        self.assertNotEqual(moved, at_rest)
        self.assertEqual(self.make_mask("--animation", "Walk", "--at", "1.5"), moved)
        # The walk is a loop of 6 s.
        self.assertEqual(self.make_mask("--at", "7.5"), moved)
        self.assertNotEqual(self.make_mask("--at", "1.7"), moved)

    def test_headless_frames_are_sixtieths_of_a_second(self):
        shown = self.draw("--frames", "7")  # the first frame is at 0 s, the last one at 6/60 s
        self.assertEqual(self.draw("--at", "0.1"), shown)
        self.assertEqual(self.draw("--frames", "4", "--speed", "2"), shown)
        self.assertEqual(self.draw("--frames", "7", "--at", "0.2", "--speed", "-1"), shown)
        self.assertNotEqual(self.draw(), shown)
        self.assertEqual(self.draw("--frames", "7", "--speed", "0"), self.draw())

    def test_the_project_sets_the_animation(self):
        walk = self.draw("--at", "1.5")
        self.assertEqual(self.draw("--at", "1.5", scene=self.make_project('animation="Walk"')), walk)
        # A name that the scene lacks stands for its first animation, an empty name for none.
        self.assertEqual(self.draw("--at", "1.5", scene=self.make_project('animation="Run"')), walk)
        still = self.draw("--frames", "20", scene=self.make_project('animation=""'))
        self.assertEqual(self.draw("--frames", "1", scene=self.make_project('animation=""')), still)
        self.assertEqual(self.draw("--animation", "Walk", "--at", "1.5", scene=self.folder), walk)

    def test_the_plan_reports_that_an_unchanged_pose_is_not_deformed_again(self):
        result = run("visibility", COURTYARD, "--technique", self.get_fallback(), *SMALL, "--at", "1", "--frames", "2", "--plan",
                     "--out", self.path("mask.exr"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("their pose is the same", result.stdout)

    def test_times_of_all_lights_hold_their_common_deform_pass_once(self):
        times = self.path("times.json")
        result = run("run", COURTYARD, "--headless", "--size", "64x64", "--at", "0.5", "--time", times)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(times, encoding="utf-8") as file:
            names = [item["name"] for item in json.load(file)["passes"]]
        self.assertEqual(names.count("deform"), 1)
        self.assertTrue(any(name.startswith("Lamp: ") for name in names) and any(name.startswith("Sun: ") for name in names))

    def test_bad_arguments_are_refused(self):
        words = ("visibility", COURTYARD, "--technique", self.get_fallback(), *SMALL, "--out", self.path("mask.exr"))
        self.assert_refused(run(*words, "--animation", "Run"), "courtyard.gltf", 'no animation "Run"', '"Walk"')
        self.assert_refused(run(*words, "--at", "-1"), "--at is -1", "0 or more", code=2)
        self.assert_refused(run(*words, "--at", "nan"), "--at is nan", "finite", code=2)
        self.assert_refused(self.compute_mask(self.write_scene(self.scene), "--at", "1"), "has no animation", "--at")
        self.assert_refused(run("run", COURTYARD, "--headless", *SMALL, "--speed", "fast"), "--speed", code=2)

    def test_a_pose_beyond_the_range_of_float_is_refused(self):
        self.make_project('size="48x36"')
        with open(self.path("courtyard.gltf"), encoding="utf-8") as file:
            scene = json.load(file)
        for node in scene["nodes"]:
            if node["name"] == "Hips":
                node["scale"] = [1e30, 1, 1]
        with open(self.path("courtyard.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        result = run("visibility", self.path("courtyard.gltf"), "--technique", self.get_fallback(), *SMALL, "--out", self.path("mask.exr"))
        self.assert_refused(result, 'Node "Figure"', "pose moves vertices", "must be within")
