"""Importing edited files back into Blender, the add-on in Blender's window, and the editor that reloads an exported file."""

import json
import math
import os
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_case import BlenderTest, find_lights, load_gltf  # noqa: E402
from command_line_case import GNOMON, LIGHTS, load_json  # noqa: E402
from display_case import DisplayTest  # noqa: E402

HAS_EDITOR = "editor" in [item["name"] for item in load_json("modules", "--json")]
WAIT_S = 60


class Reimport(BlenderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = cls.make("scene.gltf", changes=[["Key", "data.gnomon_technique", "some_id"]])

    def change_file(self, name):
        """Write the exported file as the editor would save it, with other sizes and more properties. Return its path."""
        scene = load_gltf(self.scene)
        lights = {light["name"]: light for light in scene["extensions"][LIGHTS]["lights"]}
        lights["Key data"]["extras"].update({"light_size": 0.6, "penumbra_outer_width": 0.3, "some_id_taps": 5})
        lights["Fill data"]["extras"].update({"shadow_enabled": False})
        lights["Sun data"]["extras"].update({"light_angular_distance": 2.5})
        scene["materials"][0]["extras"] = {"scatter": 0.4, "scatter_distance": 0.02}
        next(node for node in scene["nodes"] if node["name"] == "Plane")["extras"] = {"shadow_planar_receiver": True}
        scene["scenes"][0]["extras"] = {"scene_size": 3.5}
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        return self.path(name)

    def test_a_file_brings_sizes_techniques_and_properties_into_blender(self):
        found = self.call_for_json("import_file", "found.json", path=self.change_file("changed.gltf"))
        key, fill, sun = (found["lights"][name] for name in ("Key", "Fill", "Sun"))
        self.assertAlmostEqual(key["shadow_soft_size"], 0.6, places=6)
        self.assertEqual(key["technique"], "some_id")
        self.assertAlmostEqual(key["widths"][0], 0.3, places=6)
        self.assertEqual(key["widths"][1], -1.0)
        own = {"shadow_technique": "some_id", "penumbra_outer_width": 0.3, "some_id_taps": 5}
        self.assertEqual(key["properties"], own, "values that Blender has itself are not stored twice")
        self.assertAlmostEqual(key["energy"], 500.0, places=2)
        self.assertAlmostEqual(fill["shadow_soft_size"], 0.2, places=6)
        self.assertEqual((fill["use_shadow"], fill["properties"]), (False, {}))
        self.assertAlmostEqual(sun["angle"], math.radians(2.5), places=6)
        self.assertEqual(found["others"]["Wax"], {"scatter": 0.4, "scatter_distance": 0.02})
        self.assertEqual(found["others"]["Plane"]["shadow_planar_receiver"], 1)
        self.assertEqual(found["others"]["scene"]["scene_size"], 3.5)

    def test_a_file_that_went_both_ways_has_the_same_lights_and_properties(self):
        changed = self.change_file("there.gltf")
        self.call("import_file", "there.json", path=changed)
        result = self.export(self.path("there.json.blend"), "again.gltf")
        self.assertEqual(result.returncode, 0, result.stderr)
        before, after = load_gltf(changed), load_gltf(self.path("again.gltf"))
        for name, (extras, light) in find_lights(before).items():
            with self.subTest(light=name):
                extras_after, light_after = find_lights(after)[name]
                self.assertEqual((extras_after, light_after["extras"]), (extras, light["extras"]))
                self.assertAlmostEqual(light_after["intensity"] / light["intensity"], 1.0, places=6)
        for kind in ("materials", "scenes"):
            self.assertEqual(after[kind][0]["extras"], before[kind][0]["extras"])


class AddOn(BlenderTest):
    def test_it_is_installed_lists_the_programs_techniques_and_is_removed(self):
        found = self.call_for_json("install", "found.json", program=GNOMON)
        self.assertTrue(found["file"].startswith(self.folder))
        ids = [item["id"] for item in load_json("techniques", "--json")]
        # own_id is used in the file. It is all that is listed if the program does not exist.
        self.assertEqual(found["lists"], [ids + ["own_id"], ["own_id"]])
        self.assertEqual((found["was_there"], found["is_there"]), (True, False))
        self.assertEqual(found["left"], {})


class WithDisplay(BlenderTest, DisplayTest):
    def setUp(self):
        self.items = self.path("items.json")  # the editor writes its state there

    def test_the_panel_is_drawn_for_every_type_of_light(self):
        out, result = self.call("draw_panel", "drawn.json", mode=(), environment={"DISPLAY": self.display})
        with open(out, encoding="utf-8") as file:
            self.assertEqual(json.load(file), ["AREA", "POINT", "SPOT", "SUN"])
        self.assertNotIn("Traceback", result.stdout + result.stderr)

    def wait_for(self, process, matches):
        end, state = time.monotonic() + WAIT_S, {}
        while time.monotonic() < end and process.poll() is None:
            try:
                with open(self.items, encoding="utf-8") as file:
                    state = json.load(file)
            except (OSError, ValueError):  # not written yet
                state = {}
            if state and matches(state):
                return
            time.sleep(0.1)
        self.fail("the editor did not reach the expected state: %s" % state)

    @unittest.skipUnless(HAS_EDITOR, "this build has no editor")
    def test_the_editor_reads_a_file_again_that_is_exported_again(self):
        scene = self.make("followed.gltf")
        process = self.start("edit", scene, "--items", self.items)
        self.wait_for(process, lambda state: state["images"] >= 1)
        blend = self.build("larger.blend", changes=[["Key", "data.shadow_soft_size", 0.9]])
        self.assertEqual(self.export(blend, "followed.gltf").returncode, 0)
        self.wait_for(process, lambda state: "reloaded" in state["status"])
        self.press("key", "ctrl+q")
        self.finish(process)


if __name__ == "__main__":
    unittest.main()
