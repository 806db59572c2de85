"""Views of the editor: the error against the reference, two techniques, reloaded shaders, and what was open last time."""

import os
import shutil
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import ROOT, find_technique  # noqa: E402
from editor_case import EditorCase, load  # noqa: E402
from editor_story import REFERENCE_RAYS  # noqa: E402

MAX_SOFT_MAE = 0.05  # of the penumbra: a soft shadow is below, a hard one far above
TONE_MAP = os.path.join("renderer", "tone_map.comp")


class EditorViewsTest(EditorCase):
    def test_the_error_panel_distinguishes_a_soft_shadow_from_a_hard_one(self):
        self.open_editor()
        self.select_light()
        self.click("tab Error")
        soft = self.wait_for(lambda state: state["error"]["rays"] >= REFERENCE_RAYS)["error"]
        self.assertEqual(soft["light"], "Spot")
        self.assertGreater(soft["penumbra_mae"], 0.0)
        self.assertLess(soft["penumbra_mae"], MAX_SOFT_MAE)
        self.choose("property shadow_technique", find_technique("is_fallback"))
        hard = self.wait_for(lambda state: state["error"]["penumbra_mae"] > 2.0 * MAX_SOFT_MAE)["error"]
        self.assertGreaterEqual(hard["rays"], REFERENCE_RAYS)  # the reference is the same, and was not traced again
        screenshot = self.capture_viewport()
        self.click("image error")  # a click shows it in the viewport
        self.assertGreater(self.compute_changed_fraction(screenshot, self.capture_viewport()), 0.2)
        self.click("image error")
        self.assertLess(self.compute_changed_fraction(screenshot, self.capture_viewport()), 0.001)
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()

    def test_the_reference_can_be_stopped_and_started(self):
        self.open_editor()
        self.click("tab Error")
        self.select_light()
        self.wait_for(lambda state: state["error"]["rays"] >= 16)
        self.click("button reference")
        self.rest()
        stopped = self.wait_for(lambda state: not state["error"]["is_tracing"])["error"]["rays"]
        self.rest()
        self.assertEqual(self.get_state()["error"]["rays"], stopped, "the rays traced so far stay")
        self.assertGreaterEqual(stopped, 16)
        self.drag("property light_size", 3)  # another light has another reference
        self.wait_for(lambda state: state["is_changed"] and state["error"]["rays"] == 0)
        self.rest()
        error = self.get_state()["error"]
        self.assertEqual((error["rays"], error["is_tracing"]), (0, False), "nothing is traced while it is stopped")
        self.click("button reference")
        self.wait_for(lambda state: state["error"]["rays"] >= 16)
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()

    def test_without_a_shadow_there_is_no_error_and_the_editor_rests(self):
        scene = load(self.scene)
        for light in scene["extensions"]["KHR_lights_punctual"]["lights"]:
            light.setdefault("extras", {})["shadow_enabled"] = False
        self.save(scene)
        self.open_editor()
        self.click("tab Error")
        self.wait_for(lambda state: "No light" in state["error"]["refusal"])
        screenshot = self.capture_viewport()
        self.choose("view", "error")
        self.assertLess(self.compute_changed_fraction(screenshot, self.capture_viewport()), 0.001)  # the image, as there is no error
        count = self.get_state()["images"]
        self.rest()
        self.assertEqual(self.get_state()["images"], count)
        self.finish()

    def test_two_techniques_are_side_by_side(self):
        self.open_editor()
        # The images of the two techniques meet at a line in the middle, which the screenshots omit.
        left, right = self.capture_viewport(0.0, 0.49), self.capture_viewport(0.51, 1.0)
        self.choose("against", find_technique("is_fallback"))
        self.wait_for(lambda state: "line" in state["items"])
        self.assertLess(self.compute_changed_fraction(left, self.capture_viewport(0.0, 0.49)), 0.001)
        self.assertGreater(self.compute_changed_fraction(right, self.capture_viewport(0.51, 1.0)), 0.0005)
        before = self.get_state()["items"]["line"][0]
        self.drag("line", -12)  # pixels per step, to the left: farther than the 50 required below
        self.wait_for(lambda state: state["items"]["line"][0] < before - 50)
        self.assertGreater(self.compute_changed_fraction(left, self.capture_viewport(0.0, 0.49)), 0.001)
        self.choose("against", "one technique")
        self.wait_for(lambda state: "line" not in state["items"])
        self.assertLess(self.compute_changed_fraction(left, self.capture_viewport(0.0, 0.49)), 0.001)
        self.finish()

    def test_a_click_selects_what_is_under_the_mouse(self):
        self.open_editor()
        self.click("mark Omni")
        self.wait_for(lambda state: state["selected"] == "Omni")
        self.click("viewport")
        self.wait_for(lambda state: state["selected"] in ("Knot", "Box", "Sphere", "Ground"))
        self.finish()

    def test_a_changed_shader_is_seen_and_a_broken_one_is_reported(self):
        shaders = self.path("shaders")
        shutil.copytree(os.path.join(ROOT, "shaders"), shaders)
        tone_map = os.path.join(shaders, TONE_MAP)
        with open(tone_map, encoding="utf-8") as file:
            source = file.read()
        self.assertIn("void main() {", source)

        def write(text, is_seen):
            before = self.get_state()["images"]
            with open(tone_map, "w", encoding="utf-8") as file:
                file.write(text)
            self.wait_for(lambda state: is_seen(state, before))

        def is_reloaded(state, before):
            return state["images"] > before and "recompiled" in state["status"]

        def is_refused(state, _):
            return "does not compile" in state["status"]

        self.open_editor("--shaders", shaders)
        first = self.capture_viewport()
        wrong = "void main() {\n\tconst float wrong = nothing;"
        write(source.replace("void main() {", wrong), is_refused)
        # The last valid shader stays in use. Only the message covers the image's upper edge.
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.3)
        black = "void main() {\n\tif (gl_GlobalInvocationID.x > 0u) {\n\t\treturn;\n\t}"
        write(source.replace("void main() {", black), is_reloaded)
        self.assertGreater(self.compute_changed_fraction(first, self.capture_viewport()), 0.5)
        write(source, is_reloaded)
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.001)
        self.finish()

    def test_the_last_scene_and_tab_are_reopened(self):
        self.open_editor()
        self.click("button Open")
        self.click("open terrain.gltf")
        self.wait_for(lambda state: "Opened" in state["status"] and "terrain.gltf" in state["status"])
        self.click("tab Modules")
        self.rest()
        self.finish()
        self.open_editor(project="")
        self.wait_for(lambda state: "terrain.gltf" in state["status"])
        self.wait_for(lambda state: any(name.startswith("module ") for name in state["items"]))
        self.finish()


if __name__ == "__main__":
    unittest.main()
