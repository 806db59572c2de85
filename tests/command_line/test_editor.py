"""`gnomon edit` as a user drives it: mouse and keys under Xvfb, the saved file, the picture.

Where widgets are, and what the editor says, comes from the file of --items.
"""

import json
import os
import shutil
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import ROOT, find_technique, load_json  # noqa: E402
from display_case import TIMEOUT_S, DisplayTest  # noqa: E402

LIGHT = "Spot"
DRAG_STEPS = 12


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


@unittest.skipUnless("editor" in [item["name"] for item in load_json("modules", "--json")], "this build has no editor")
class EditorTest(DisplayTest):
    def setUp(self):
        super().setUp()
        self.project = self.path("project")
        shutil.copytree(os.path.join(ROOT, "demo_project"), self.project, ignore=shutil.ignore_patterns("out", "third_party"))
        self.scene = os.path.join(self.project, "scenes", "three_lights.gltf")
        self.items = self.path("items.json")

    def open_editor(self):
        self.process = self.start("edit", self.project, "--items", self.items, "--validation")
        self.wait_for(lambda state: state["pictures"] >= 1)

    def get_state(self):
        try:
            return load(self.items)
        except (OSError, ValueError):  # not there yet
            return {"items": {}, "selected": "", "status": "", "is_changed": False, "is_resting": False, "pictures": 0}

    def wait_for(self, is_wanted):
        """The first state that is wanted. None comes in time: the test fails with the last one."""
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end:
            state = self.get_state()
            if is_wanted(state):
                return state
            if self.process.poll() is not None:
                self.fail("the editor ended: %s" % self.process.communicate()[1])
            time.sleep(0.05)
        self.fail("the editor did not get there: %s" % json.dumps(self.get_state()))

    def find_middle(self, name):
        place, before = self.wait_for(lambda state: name in state["items"])["items"][name], None
        while place != before:  # what opens finds its place first
            time.sleep(0.3)
            before, place = place, self.wait_for(lambda state: name in state["items"])["items"][name]
        left, top, right, bottom = place
        return str(int((left + right) / 2)), str(int((top + bottom) / 2))

    def click(self, name):
        # As long as a hand takes: what is under the mouse is known a frame later.
        self.press("mousemove", *self.find_middle(name), "sleep", "0.3", "mousedown", "1", "sleep", "0.2", "mouseup", "1")

    def drag(self, name, step_px):
        self.press("mousemove", *self.find_middle(name), "sleep", "0.1", "mousedown", "1")
        for _ in range(DRAG_STEPS):
            self.press("mousemove_relative", "--", str(step_px), "0", "sleep", "0.02")
        self.press("sleep", "0.1", "mouseup", "1")

    def rest(self):
        """Waits until the window shows all that there is, and sharply."""
        time.sleep(0.3)  # what was pressed last has arrived
        self.wait_for(lambda state: state["is_resting"])

    def photograph(self):
        """What the viewport shows, as raw bytes."""
        self.rest()
        left, top, right, bottom = (int(value) for value in self.get_state()["items"]["viewport"])
        command = ["import", "-silent", "-window", "root", "-crop", "%dx%d+%d+%d" % (right - left, bottom - top, left, top)]
        environment = {**os.environ, "DISPLAY": self.display}
        return subprocess.run([*command, "+repage", "-depth", "8", "rgb:-"], env=environment, capture_output=True, check=True).stdout

    def count_different(self, one, other):
        self.assertEqual(len(one), len(other))
        return sum(abs(a - b) > 8 for a, b in zip(one, other)) / len(one)

    def finish(self):
        self.press("key", "ctrl+q")
        _, errors = self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(self.process.returncode, 0, errors)
        self.assertNotIn("VUID", errors)
        self.assertNotIn("SYNC-HAZARD", errors)

    def find_light(self, scene):
        lights = scene["extensions"]["KHR_lights_punctual"]["lights"]
        return next(light for light in lights if light["name"] == LIGHT)

    def test_a_light_is_changed_undone_saved_and_read_anew(self):
        before = load(self.scene)
        size = self.find_light(before)["extras"]["light_size"]
        self.open_editor()
        self.click("node " + LIGHT)
        self.wait_for(lambda state: state["selected"] == LIGHT)
        first = self.photograph()
        self.drag("property light_size", 3)
        self.wait_for(lambda state: state["is_changed"])
        large = self.photograph()
        self.assertGreater(self.count_different(first, large), 0.005)
        self.press("key", "ctrl+z")  # the whole drag is one step
        self.wait_for(lambda state: not state["is_changed"])
        self.assertLess(self.count_different(first, self.photograph()), 0.001)
        self.press("key", "ctrl+shift+z")
        self.wait_for(lambda state: state["is_changed"])
        self.assertLess(self.count_different(large, self.photograph()), 0.001)

        technique = find_technique("is_fallback")
        self.click("property shadow_technique")
        self.click("choice " + technique)
        self.wait_for(lambda state: "property %s_size" % technique in state["items"])
        self.assertGreater(self.count_different(large, self.photograph()), 0.005)
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: not state["is_changed"] and state["status"].startswith("Saved"))
        after = load(self.scene)
        extras = self.find_light(after)["extras"]
        self.assertGreater(extras["light_size"], size + 0.1)
        self.assertEqual(extras["shadow_technique"], technique)
        # Nothing else of the file is another.
        extras["light_size"] = size
        del extras["shadow_technique"]
        self.assertEqual(after, before)

        with open(self.scene, "w", encoding="utf-8") as file:
            json.dump(before, file)
        self.wait_for(lambda state: "read anew" in state["status"])
        self.assertLess(self.count_different(first, self.photograph()), 0.001)
        self.finish()

    def test_the_size_of_a_light_is_dragged_in_the_viewport(self):
        self.open_editor()
        self.click("node " + LIGHT)
        self.wait_for(lambda state: state["selected"] == LIGHT)
        self.press("key", "f")
        self.rest()
        self.drag("handle light_size", 4)
        self.wait_for(lambda state: state["is_changed"])
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()

    def test_a_module_is_switched_off_and_on_and_the_project_knows(self):
        self.open_editor()
        first = self.photograph()
        self.click("tab Modules")
        places = self.wait_for(lambda state: any(name.startswith("module shadow_") for name in state["items"]))["items"]
        name = min((name for name in places if name.startswith("module shadow_")), key=lambda name: places[name][1])
        module = name.split()[1]
        for word, listed in (("Disabled", True), ("Enabled", False)):
            self.click(name)
            self.wait_for(lambda state: state["status"].startswith(word) or module in state["status"])
            self.rest()
            enabled = {item["name"]: item["is_enabled"] for item in load_json("modules", "--json")}
            self.assertTrue(enabled[module], "only the project's list changes")
            with open(os.path.join(self.project, "project.cfg"), encoding="utf-8") as file:
                self.assertEqual(any(line.startswith("disabled=") and module in line for line in file), listed)
        self.assertLess(self.count_different(first, self.photograph()), 0.001)
        self.finish()

    def test_a_file_that_breaks_on_disk_leaves_the_scene_as_it_is(self):
        self.open_editor()
        first = self.photograph()
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write("{ broken")
        self.wait_for(lambda state: "three_lights.gltf" in state["status"] and "Opened" not in state["status"])
        self.assertLess(self.count_different(first, self.photograph()), 0.001)
        self.finish()


if __name__ == "__main__":
    unittest.main()
