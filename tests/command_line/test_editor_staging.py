"""Editing a model without camera and light: added nodes are marked as staged, and saved only after this mark is removed."""

import json
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import run  # noqa: E402
from editor_case import EditorCase, load  # noqa: E402

ADDED = ("Stage camera", "Stage light", "Stage ground")
LINE = "Staged: a camera, a spot light and a ground were added."


class EditorStaging(EditorCase):
    def setUp(self):
        super().setUp()
        model = load(self.scene)
        for key in ("cameras", "extensions", "extensionsUsed"):
            model.pop(key, None)
        for node in model["nodes"]:
            node.pop("camera", None)
            node.pop("extensions", None)
        self.save(model)
        with open(self.scene, encoding="utf-8") as file:
            self.before = file.read()

    def read_scene(self):
        with open(self.scene, encoding="utf-8") as file:
            return file.read()

    def list_names(self):
        return {node["name"] for node in load(self.scene)["nodes"]}

    def save_changes(self):
        self.press("key", "ctrl+s")
        return self.wait_for(lambda state: not state["is_changed"] and state["status"].startswith("Saved"))["status"]

    def test_staged_nodes_are_saved_or_not(self):
        self.open_editor(project=self.scene)
        self.wait_for(lambda state: LINE in state["status"] and {"node " + name for name in ADDED} <= set(state["items"]))
        self.click("node Stage light")
        self.wait_for(lambda state: state["selected"] == "Stage light")

        # Changes of a staged node are not saved, and the status reports it.
        self.drag("property light_size", 3)
        self.wait_for(lambda state: state["is_changed"])
        status = self.save_changes()
        for name in ADDED:
            self.assertIn(name, status)
        self.assertFalse(self.list_names() & set(ADDED))
        self.assertEqual(json.loads(self.read_scene()), json.loads(self.before))

        # Removing the mark can be undone.
        self.click("property staged")
        self.wait_for(lambda state: state["is_changed"])
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.press("key", "ctrl+shift+z")
        self.wait_for(lambda state: state["is_changed"])
        status = self.save_changes()
        self.assertIn("Stage camera", status)
        self.assertNotIn("Stage light", status)
        self.assertEqual(self.list_names() & set(ADDED), {"Stage light"})
        self.finish()
        result = run("run", self.scene, "--headless", "--size", "32x32")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("Staged: a camera was added.", result.stderr)


if __name__ == "__main__":
    unittest.main()
