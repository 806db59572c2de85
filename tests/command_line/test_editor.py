"""The editor changes a scene, undoes changes, saves it and reloads it."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import find_technique, load_json  # noqa: E402
import editor_story  # noqa: E402
from editor_case import EditorCase, load  # noqa: E402


class EditorTest(EditorCase):
    def test_the_main_workflow_from_opening_to_the_game(self):
        editor_story.run_story(self, lambda name: None)

    def test_a_light_is_changed_undone_saved_and_read_again(self):
        before = load(self.scene)
        size = self.find_light(before)["extras"]["light_size"]
        self.open_editor()
        self.select_light()
        first = self.capture_viewport()
        self.drag("property light_size", 3)
        self.wait_for(lambda state: state["is_changed"])
        large = self.capture_viewport()
        self.assertGreater(self.compute_changed_fraction(first, large), 0.005)
        self.press("key", "ctrl+z")  # the whole drag is one step
        self.wait_for(lambda state: not state["is_changed"])
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.001)
        self.press("key", "ctrl+shift+z")
        self.wait_for(lambda state: state["is_changed"])
        self.assertLess(self.compute_changed_fraction(large, self.capture_viewport()), 0.001)

        technique = find_technique("is_fallback")
        self.choose("property shadow_technique", technique)
        self.wait_for(lambda state: "property %s_size" % technique in state["items"])
        self.assertGreater(self.compute_changed_fraction(large, self.capture_viewport()), 0.005)
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: not state["is_changed"] and state["status"].startswith("Saved"))
        after = load(self.scene)
        extras = self.find_light(after)["extras"]
        self.assertGreater(extras["light_size"], size + 0.1)
        self.assertEqual(extras["shadow_technique"], technique)
        # Nothing else in the file has changed.
        extras["light_size"] = size
        del extras["shadow_technique"]
        self.assertEqual(after, before)

        self.save(before)
        self.wait_for(lambda state: "reloaded" in state["status"])
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.001)
        self.finish()

    def test_the_size_of_a_light_is_dragged_in_the_viewport(self):
        self.open_editor()
        self.select_light()
        self.press("key", "f")
        self.rest()
        self.drag("handle light_size", 4)
        self.wait_for(lambda state: state["is_changed"])
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()

    def test_the_project_stores_which_modules_are_disabled(self):
        self.open_editor()
        first = self.capture_viewport()
        self.click("tab Modules")
        positions = self.wait_for(lambda state: any(name.startswith("module shadow_") for name in state["items"]))["items"]
        # The topmost module of a technique.
        name = min((name for name in positions if name.startswith("module shadow_")), key=lambda name: positions[name][1])
        module = name.split()[1]
        for word, listed in (("Disabled", True), ("Enabled", False)):
            self.click(name)
            self.wait_for(lambda state: state["status"] == "%s %s" % (word, module))
            self.rest()
            enabled = {item["name"]: item["is_enabled"] for item in load_json("modules", "--json")}
            self.assertTrue(enabled[module], "only the project's list changes")
            with open(os.path.join(self.project, "project.cfg"), encoding="utf-8") as file:
                self.assertEqual(any(line.startswith("disabled=") and module in line for line in file), listed)
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.001)
        self.finish()


if __name__ == "__main__":
    unittest.main()
