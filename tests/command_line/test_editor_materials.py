"""The editor changes the material of a mesh, which changes the image, and saves it at its index in the file."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from editor_case import EditorCase, load  # noqa: E402

MESH = "Knot"


class EditorMaterialTest(EditorCase):
    def find_material(self):
        scene = load(self.scene)
        node = next(node for node in scene["nodes"] if node["name"] == MESH)
        return scene["materials"][scene["meshes"][node["mesh"]]["primitives"][0]["material"]]

    def test_a_mesh_is_made_translucent_undone_done_again_and_saved(self):
        before = self.find_material()
        self.open_editor()
        self.click("node " + MESH)
        self.wait_for(lambda state: state["selected"] == MESH)
        opaque = self.capture_viewport()
        self.drag("property scatter", 12)
        self.wait_for(lambda state: state["is_changed"])
        translucent = self.capture_viewport()
        self.assertGreater(self.compute_changed_fraction(opaque, translucent), 0.0005)
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.assertEqual(self.compute_changed_fraction(opaque, self.capture_viewport()), 0)
        self.press("key", "ctrl+y")
        self.wait_for(lambda state: state["is_changed"])
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()
        after = self.find_material()
        self.assertGreater(after["extras"].pop("scatter"), 0)
        after.pop("extras")
        self.assertEqual(after, before)


if __name__ == "__main__":
    unittest.main()
