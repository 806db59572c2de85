"""The editor plays and pauses an animation, and saves neither its time nor its pose."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from editor_case import EditorCase  # noqa: E402


class EditorTimelineTest(EditorCase):
    def setUp(self):
        super().setUp()
        self.scene = os.path.join(self.project, "scenes", "courtyard.gltf")

    def press_save(self):
        """Delete the scene file, press save, and return what the editor writes."""
        os.remove(self.scene)
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: os.path.exists(self.scene))
        with open(self.scene, "rb") as file:
            return file.read()

    def test_an_animation_is_chosen_scrubbed_played_paused_and_not_saved(self):
        self.open_editor(project=self.scene)
        before = self.press_save()
        at_rest = self.capture_viewport()
        self.assertEqual(self.get_state()["timeline"], {"animation": "", "time_s": 0, "is_playing": False})
        self.choose("timeline animation", "Walk")
        self.click("timeline time")
        time_s = self.wait_for(lambda state: state["timeline"]["time_s"] > 0)["timeline"]["time_s"]
        self.assertAlmostEqual(time_s, 3, delta=0.2)  # a click hits the middle of the slider, and the walk lasts 6 s
        self.assertGreater(self.compute_changed_fraction(at_rest, self.capture_viewport()), 0.005)

        self.press("key", "space")
        self.wait_for(lambda state: state["timeline"]["is_playing"] and state["timeline"]["time_s"] != time_s)
        self.click("timeline play")
        self.wait_for(lambda state: not state["timeline"]["is_playing"])
        self.rest()
        paused = self.get_state()
        self.wait_frames(20)
        self.assertEqual(self.get_state()["images"], paused["images"], "nothing moves, so nothing is drawn")
        self.assertFalse(paused["is_changed"])
        self.assertEqual(self.press_save(), before)

        self.choose("timeline animation", "at rest")
        self.wait_for(lambda state: state["timeline"]["animation"] == "")
        self.assertLess(self.compute_changed_fraction(at_rest, self.capture_viewport()), 0.001)
        self.finish()

    def test_a_space_that_is_typed_plays_nothing(self):
        self.open_editor(project=self.scene)
        self.click("node Trunk")
        self.wait_for(lambda state: "property position" in state["items"])
        self.click("search properties")
        self.press("type", "no such")
        self.wait_for(lambda state: state["items"] and "property position" not in state["items"])
        self.wait_frames()
        self.assertFalse(self.get_state()["timeline"]["is_playing"])
        self.click("node Trunk")  # takes the focus from the field, which would get all keys
        self.wait_frames()
        self.finish()

    def test_a_scene_without_animations_has_no_timeline(self):
        self.open_editor()
        self.rest()
        self.assertNotIn("timeline play", self.get_state()["items"])
        self.finish()


if __name__ == "__main__":
    unittest.main()
