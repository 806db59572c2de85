"""Scenes that the add-on exports from Blender have the same lights and properties in the engine."""

import os
import shutil
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_case import BlenderTest, find_lights, load_gltf  # noqa: E402
from command_line_case import find_technique, load_json  # noqa: E402

# What export_by_hand() sets on Key, Fill and Sun, in the engine's units (0.1 rad in degrees).
BY_HAND = ("light_size=0.5", "light_size=0.4", "light_angular_distance=5.729577951")


def find_selectable_technique():
    """Return a technique that is neither the default, the fallback nor the reference."""
    flags = ("is_default", "is_fallback", "is_reference")
    return next(item["id"] for item in load_json("techniques", "--json") if not any(item[flag] for flag in flags))


def compute_mean_difference(values, others):
    return sum(abs(a - b) for a, b in zip(values, others)) / len(values)


class ExportedFile(BlenderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.default_technique = find_technique("is_default")
        cls.other = find_selectable_technique()
        changes = [
            ["Key", "data.gnomon_technique", cls.other],
            ["Key", "data.gnomon_outer_width", 0.25],
            ["Key", "data.gnomon_inner_width", 0.125],
            ["Fill", "data.use_shadow", False],
        ]
        cls.scene = cls.make("scene.gltf", changes=changes)
        cls.blend = cls.scene + ".blend"
        # Techniques may use penumbra widths instead of the size, so this scene has none.
        cls.sizes = cls.make("sizes.gltf", changes=[["Fill", "scale", [3.0, 3.0, 3.0]]])

    def check_lights(self, path):
        lights = find_lights(load_gltf(path))  # name -> (the node's extras, the light)
        own = {"shadow_technique": self.other, "penumbra_outer_width": 0.25, "penumbra_inner_width": 0.125}
        self.assertEqual(lights["Key"][1]["extras"], {"light_size": 0.35, "shadow_enabled": True, **own})
        self.assertEqual(lights["Fill"][1]["extras"], {"light_size": 0.2, "shadow_enabled": False})
        self.assertEqual(lights["Sun"][1]["extras"], {"light_angular_distance": 6.0, "shadow_enabled": True})
        types = [lights[name][1]["type"] for name in ("Key", "Fill", "Sun")]
        self.assertEqual(types, ["spot", "point", "directional"])

    def test_every_format_has_the_size_and_the_technique_of_each_light(self):
        self.check_lights(self.scene)
        for name, options in (("scene.glb", ()), ("whole.gltf", ("--embedded",))):
            with self.subTest(name=name):
                result = self.export(self.blend, name, *options)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.check_lights(self.path(name))
                self.assertFalse(os.path.exists(self.path("whole.bin")))
                self.assertEqual(self.run_gnomon("run", self.path(name)), self.run_gnomon("run", self.scene))

    def test_the_engine_has_the_radius_that_blender_has(self):
        for light, same, other in (
            ("Key", "light_size=0.35", "light_size=0.36"),
            ("Fill", "light_size=0.2", "light_size=0.21"),
            ("Sun", "light_angular_distance=6", "light_angular_distance=6.2"),
        ):
            with self.subTest(light=light):
                mask = self.hash_mask(self.sizes, self.default_technique, light)
                self.assertEqual(mask, self.hash_mask(self.sizes, self.default_technique, light, same))
                self.assertNotEqual(mask, self.hash_mask(self.sizes, self.default_technique, light, other))

    def test_the_engine_uses_the_technique_and_the_shadow_that_blender_has(self):
        image = self.run_gnomon("run", self.scene)
        key, fill = "light.Key.shadow_technique=", "light.Fill.shadow_enabled="
        self.assertEqual(image, self.run_gnomon("run", self.scene, "--set", key + self.other, "--set", fill + "false"))
        self.assertNotEqual(image, self.run_gnomon("run", self.scene, "--set", key + self.default_technique))
        self.assertNotEqual(image, self.run_gnomon("run", self.scene, "--set", fill + "true"))

    def test_a_technique_that_reads_the_widths_has_those_of_blender(self):
        outer = "penumbra_outer_width="
        readers = []
        for item in load_json("techniques", "--json"):
            if not item["is_reference"]:
                mask = self.hash_mask(self.scene, item["id"], "Key")
                self.assertEqual(mask, self.hash_mask(self.scene, item["id"], "Key", outer + "0.25"), item["id"])
                readers += [item["id"]] if mask != self.hash_mask(self.scene, item["id"], "Key", outer + "0.4") else []
        if not readers:
            self.skipTest("no technique of this build reads the widths")

    def test_the_scale_of_an_object_does_not_change_the_size_of_its_light(self):
        node = next(node for node in load_gltf(self.sizes)["nodes"] if node["name"] == "Fill")
        self.assertAlmostEqual(node["scale"][0], 3.0, places=5)
        images = self.call_for_json("render_scales", "images.json")
        for light in ("Key", "Fill"):
            plain, scaled, larger = (images[light + " " + name] for name in ("plain", "scaled", "larger"))
            self.assertLess(compute_mean_difference(plain, scaled), 1e-5, "Cycles")
            # 100 times the limit above.
            self.assertGreater(compute_mean_difference(plain, larger), 1e-3, "Cycles")


class ExportedProperties(BlenderTest):
    def test_a_custom_property_wins_over_blenders_value(self):
        changes = [
            ["Key", 'data.["light_size"]', 0.7],
            ["Fill", '["radius"]', 0.6],  # another name of light_size
            ["Sun", 'data.["light_angular_distance"]', 2],
        ]
        # name -> (the node's extras, the light)
        lights = find_lights(load_gltf(self.make("typed.gltf", changes=changes)))
        self.assertEqual(lights["Key"][1]["extras"]["light_size"], 0.7)
        self.assertEqual(lights["Fill"][0], {"radius": 0.6})
        self.assertNotIn("light_size", lights["Fill"][1]["extras"])
        self.assertEqual(lights["Sun"][1]["extras"]["light_angular_distance"], 2)
        technique = find_technique("is_default")
        mask = self.hash_mask(self.path("typed.gltf"), technique, "Fill")
        self.assertEqual(mask, self.hash_mask(self.path("typed.gltf"), technique, "Fill", "light_size=0.6"))
        self.assertNotEqual(mask, self.hash_mask(self.path("typed.gltf"), technique, "Fill", "light_size=0.2"))

    def test_instances_export_their_lights_and_hidden_lights_are_not_exported(self):
        blend, _ = self.call("save_instances", "instances.blend")
        result = self.export(blend, "instances.gltf")
        self.assertEqual(result.returncode, 0, result.stderr)
        scene = load_gltf(self.path("instances.gltf"))
        names = [node["name"] for node in scene["nodes"]]
        self.assertEqual(names.count("Lamp"), 2)
        self.assertNotIn("Unused", names)
        self.assertNotIn("Area", names)
        lights = find_lights(scene)
        self.assertEqual(lights["Lamp"][1]["extras"]["light_size"], 0.15)
        # Two objects share one light, and one of them has its own size.
        self.assertEqual(lights["Twin"][1]["name"], lights["Key"][1]["name"])
        self.assertNotIn("light_size", lights["Key"][1]["extras"])
        self.assertEqual(lights["Twin"][0]["light_size"], 0.6)
        self.assertEqual(lights["Key"][0]["light_size"], 0.35)

    def test_an_export_changes_nothing_in_blender(self):
        os.makedirs(self.path("gone"))
        found = self.call_for_json(
            "compare_properties", "found.json", path=self.path("same.glb"), once_folder=self.path("gone")
        )
        self.assertEqual(found["before"]["Key"][1], {"light_size": 0.7})
        self.assertEqual(found["after"], found["before"])
        self.assertEqual(found["after_failure"], found["before"])
        self.assertIn("wrote no file", found["message"])
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith(".gnomon")], [])

    def test_properties_typed_by_hand_need_no_add_on(self):
        scene, _ = self.call("export_by_hand", "hand.gltf")
        technique = find_technique("is_default")
        for light, same in zip(("Key", "Fill", "Sun"), BY_HAND):
            with self.subTest(light=light):
                mask = self.hash_mask(scene, technique, light)
                self.assertEqual(mask, self.hash_mask(scene, technique, light, same))
                name = same.split("=", maxsplit=1)[0]
                self.assertNotEqual(mask, self.hash_mask(scene, technique, light, name + "=0.1"))


class BadInput(BlenderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.good = cls.build("good.blend")

    def assert_refused(self, blend, name, *words):
        """Assert that an export fails with exit code 1 and one ERROR line that has all the words, and leaves no file."""
        result = self.export(blend, name)
        errors = [line for line in result.stderr.splitlines() if line.startswith("ERROR: ")]
        self.assertEqual(len(errors), 1, result.stderr)
        for word in words:
            self.assertIn(word, errors[0])
        self.assertEqual(result.returncode, 1)
        self.assertFalse(os.path.exists(self.path(name)))
        self.assertEqual([item for item in os.listdir(self.folder) if item.startswith(".gnomon")], [])

    def test_an_area_light_is_named_with_what_to_do(self):
        blend, _ = self.call("save_instances", "area.blend", area_is_hidden=False)
        self.assert_refused(blend, "area.glb", '"Area"', "AREA", "spot light", "hide")

    def test_a_scene_without_light_is_reported(self):
        self.assert_refused(self.build("dark.blend", lights=()), "dark.glb", '"Scene"', "no light", "Add")

    def test_a_scene_whose_lights_are_hidden_is_reported(self):
        blend = self.build("off.blend", lights=("Key",), changes=[["Key", "hide_viewport", True]])
        self.assert_refused(blend, "off.glb", "no light", "outliner")

    def test_an_angle_beyond_the_engines_range_is_named(self):
        blend = self.build("wide.blend", changes=[["Sun", "data.angle", 2.0]])
        self.assert_refused(blend, "wide.glb", '"Sun"', "114.59", "0..90")  # 2 rad in degrees

    def test_a_name_that_is_no_gltf_is_refused(self):
        self.assert_refused(self.good, "scene.obj", '"scene.obj"', ".gltf", ".glb")

    def test_a_folder_that_is_missing_is_named(self):
        self.assert_refused(self.good, os.path.join("missing", "scene.glb"), "missing")

    def test_a_target_that_cannot_be_replaced_is_named(self):
        os.makedirs(self.path("folder.glb"))
        self.addCleanup(shutil.rmtree, self.path("folder.glb"))
        result = self.export(self.good, "folder.glb")
        self.assertEqual(result.returncode, 1)
        self.assertIn("folder.glb cannot be written", result.stderr)

    def test_a_scene_without_camera_is_exported_with_a_warning(self):
        blend = self.build("blind.blend", has_camera=False)
        result = self.export(blend, "blind.glb")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("WARNING: No perspective camera", result.stderr)
        self.assertTrue(os.path.exists(self.path("blind.glb")))

    def test_wrong_usage_ends_with_2(self):
        result = self.export(self.good, "x.glb", "--gone")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--gone", result.stderr)


if __name__ == "__main__":
    unittest.main()
