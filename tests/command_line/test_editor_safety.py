"""The editor loses no work when files are broken, the disk is full or it is killed."""

import os
import resource
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import ROOT  # noqa: E402
from display_case import TIMEOUT_S  # noqa: E402
from editor_case import EditorCase, load  # noqa: E402

FULL_DISK_BYTES = 6000  # limit of file sizes: the scene is larger, the file of --items smaller
AUTOSAVE_S = 2  # short, so that the test need not wait for the default interval


def fill_disk():
    resource.setrlimit(resource.RLIMIT_FSIZE, (FULL_DISK_BYTES, resource.RLIM_INFINITY))


class EditorSafetyTest(EditorCase):
    def read_scene(self):
        with open(self.scene, encoding="utf-8") as file:
            return file.read()

    def write_scene(self, text):
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(text)

    def change_light(self):
        self.select_light()
        self.drag("property light_size", 3)
        self.wait_for(lambda state: state["is_changed"])

    def assert_saved_larger(self):
        before = load(os.path.join(ROOT, "demo_project", "scenes", "three_lights.gltf"))
        size = self.find_light(before)["extras"]["light_size"]
        self.assertGreater(self.find_light(load(self.scene))["extras"]["light_size"], size)

    def test_a_file_that_breaks_on_disk_leaves_the_scene_as_it_is(self):
        self.open_editor()
        first = self.capture_viewport()
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write("{ broken")
        self.wait_for(lambda state: "three_lights.gltf" in state["status"] and "Opened" not in state["status"])
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.001)
        self.finish()

    def test_a_broken_scene_opens_with_its_error_and_is_read_once_repaired(self):
        whole = self.read_scene()
        self.write_scene("{ broken")
        self.open_editor()
        self.wait_for(lambda state: "three_lights.gltf" in state["status"] and "parse" in state["status"])
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: "nothing to save" in state["status"])
        self.assertEqual(self.read_scene(), "{ broken")
        self.write_scene(whole)
        self.wait_for(lambda state: "reloaded" in state["status"] and "node Spot" in state["items"])
        self.finish()

    def test_a_full_disk_is_reported_and_nothing_is_lost(self):
        whole = self.read_scene()
        self.assertGreater(len(whole), FULL_DISK_BYTES)
        # The editor inherits from Python that SIGXFSZ is ignored, so that its writes fail instead.
        self.open_editor(preexec_fn=fill_disk, restore_signals=False)
        self.change_light()
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: "Cannot write" in state["status"])
        self.assertTrue(self.get_state()["is_changed"])
        self.assertEqual(self.read_scene(), whole)
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()

    def test_closing_prompts_and_what_was_changed_is_saved(self):
        self.open_editor()
        self.change_light()
        self.press("key", "ctrl+q")
        self.click("button Cancel")
        self.wait_for(lambda state: "button Cancel" not in state["items"])
        self.press("key", "ctrl+q")
        self.click("button Save and close")
        self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(self.process.returncode, 0)
        self.assert_saved_larger()

    def test_a_killed_editor_loses_nothing_that_is_older_than_its_autosave(self):
        os.makedirs(self.path("config"))
        with open(os.path.join(self.path("config"), "editor.json"), "w", encoding="utf-8") as file:
            file.write('{ "autosave_s": %d }' % AUTOSAVE_S)
        self.open_editor()
        self.change_light()
        recovery = os.path.join(self.project, "scenes", ".three_lights.recovery.gltf")
        self.wait_for(lambda state: os.path.exists(recovery))
        self.process.kill()
        self.process.communicate()
        self.open_editor()
        self.click("button Recover")
        self.wait_for(lambda state: state["is_changed"])
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()
        self.assert_saved_larger()
        self.assertFalse(os.path.exists(recovery))


if __name__ == "__main__":
    unittest.main()
