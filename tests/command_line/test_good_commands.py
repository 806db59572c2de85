"""Valid commands, and the files that they write."""

import json
import math
import os
import shutil
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import (
    CONTACT_BOX,
    ROOT,
    SMALL,
    THREE_LIGHTS,
    CommandLineTest,
    find_technique,
    load_json,
    read_png_size,
    run,
)  # noqa: E402


class GoodCommands(CommandLineTest):
    def test_models_without_camera_and_light_are_staged(self):
        with open(CONTACT_BOX, encoding="utf-8") as file:
            model = json.load(file)
        for node in model["nodes"]:
            node.pop("camera", None)
            node.pop("extensions", None)
        for key in ("cameras", "extensions", "extensionsUsed"):
            model.pop(key, None)
        path = self.path("model.gltf")
        folder = os.path.dirname(CONTACT_BOX)
        for buffer in model["buffers"]:
            name = buffer["uri"]
            if not name.startswith("data:"):
                shutil.copy(os.path.join(folder, name), self.path(name))
        with open(path, "w", encoding="utf-8") as file:
            json.dump(model, file)
        before = os.stat(path).st_mtime_ns
        line = "Staged: a camera, a spot light and a ground were added"
        image, mask = self.path("model.png"), self.path("model.exr")
        result = run("run", path, "--headless", "--capture", image, "--size", "64x64")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(line, result.stderr)
        self.assertEqual(read_png_size(image), (64, 64))
        result = run("visibility", path, "--technique", self.get_fallback(), "--out", mask, *SMALL)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(line, result.stderr)
        result = run(
            "report", path, "--size", "32x32", "--samples", "16", "--scaling", "none", "--techniques", self.get_fallback(),
            "--out", self.path("report"),
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(os.path.join(self.path("report"), "report.json"), encoding="utf-8") as file:
            self.assertTrue(json.load(file)["cells"])
        self.assertEqual(os.stat(path).st_mtime_ns, before)
        result = run("run", path, "--headless", "--stage", "off")
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no perspective camera", result.stderr)
        self.assertEqual(run("run", path, "--headless", "--stage", "maybe").returncode, 2)

    def test_masks_are_compared(self):
        reference = find_technique("is_reference")
        reference_path, mask, times = self.path("reference.exr"), self.path("mask.exr"), self.path("time.json")
        size = ("--size", "128x128")
        samples = ("--set", "%s_samples=64" % reference)
        result = run("visibility", CONTACT_BOX, "--technique", reference, "--out", reference_path, *size, *samples)
        self.assert_mask(result, "reference.exr")
        result = run(
            "visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", mask, *size, "--time", times
        )
        self.assert_mask(result)
        found = load_json("compare", reference_path, mask)
        self.assertEqual(set(found), {"pixels", "receiver", "penumbra"})
        self.assertEqual(set(found["receiver"]), {"mae", "rmse", "p99", "bias", "wrong"})
        self.assertEqual(set(found["penumbra"]), {"pixels", "mae", "rmse", "p99", "bias", "wrong", "umbra_over"})
        # Each wrong pixel (error above 0.2) adds more than 0.2 to the sum of errors, whose mean is the MAE.
        self.assertLess(0.2 * found["penumbra"]["wrong"], found["penumbra"]["mae"])
        self.assertTrue(0.0 < found["receiver"]["wrong"] < found["penumbra"]["wrong"] <= 1.0)
        self.assertGreater(found["penumbra"]["pixels"], 100)
        self.assertLess(found["penumbra"]["pixels"], found["pixels"])
        self.assertTrue(0.0 < found["receiver"]["mae"] < found["penumbra"]["mae"] < 0.5)
        self.assertLessEqual(abs(found["penumbra"]["bias"]), found["penumbra"]["mae"])
        same = load_json("compare", reference_path, reference_path)
        self.assertEqual(same["penumbra"]["mae"], 0)
        self.assertEqual(same["receiver"]["wrong"], 0)
        with open(times, encoding="utf-8") as file:
            cost = json.load(file)
        # assertLessEqual of sets: the first is a subset of the second.
        self.assertLessEqual(
            {"device", "driver", "threads", "frames", "triangles", "edges", "passes", "total", "bytes"}, set(cost)
        )
        self.assertEqual(set(cost["total"]), {"gpu_ms", "gpu_ms_p90", "wall_ms", "wall_ms_p90"})
        self.assertEqual(cost["frames"], 20)
        self.assertEqual(cost["triangles"], 24)  # of two boxes
        self.assertTrue(cost["passes"])
        for item in cost["passes"]:
            self.assertLessEqual({"name", "gpu_ms", "wall_ms"}, set(item))
        for value in cost["total"].values():
            self.assertTrue(math.isfinite(value) and value > 0.0)

    def test_frames_in_which_nothing_moves_skip_passes(self):
        # The fallback reuses its map, so the pass that draws it is missing.
        passes = {}
        for name, words in (("moving", ()), ("still", ("--still",))):
            times = self.path(name + ".json")
            self.assert_mask(self.compute_mask(CONTACT_BOX, "--time", times, *words))
            with open(times, encoding="utf-8") as file:
                passes[name] = {item["name"] for item in json.load(file)["passes"]}
        self.assertLess(passes["still"], passes["moving"])  # a proper subset
        result = self.compute_mask(CONTACT_BOX, "--still")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--time", result.stderr)

    def test_whole_frames_are_timed_with_and_without_skipping(self):
        found, images, plans = {}, {}, {}
        for name, words in (("lean", ()), ("whole", ("--skip-nothing",))):
            times, image = self.path(name + ".json"), self.path(name + ".png")
            command = ("run", THREE_LIGHTS, "--headless", *SMALL, "--technique", self.get_fallback(), "--plan")
            result = run(*command, "--time", times, "--capture", image, *words)
            self.assertEqual(result.returncode, 0, result.stderr)
            plans[name] = result.stdout
            with open(times, encoding="utf-8") as file:
                found[name] = json.load(file)
            with open(image, "rb") as file:
                images[name] = file.read()
        self.assertEqual(images["lean"], images["whole"])
        self.assertIn("skipped, no casters", plans["lean"])
        self.assertNotIn("skipped, no casters", plans["whole"])
        for name in ("pass_count", "draws", "dispatches"):
            self.assertGreater(found["lean"][name], 0)
            self.assertGreaterEqual(found["whole"][name], found["lean"][name])
        self.assertGreater(found["whole"]["draws"], found["lean"]["draws"])
        # call_ms covers the frame and the program's CPU work for it.
        self.assertGreater(found["lean"]["call_ms"], 0.5 * found["lean"]["frame"]["wall_ms"])
        self.assertGreater(found["lean"]["host_ms"], 0)
        # A light's passes are named LIGHT: PASS.
        self.assertGreater(len({item["name"].split(": ")[0] for item in found["lean"]["passes"]}), 2)

    def test_only_headless_runs_are_timed(self):
        for words in (("--time", self.path("time.json")), ("--skip-nothing",), ("--headless", "--still")):
            result = run("run", THREE_LIGHTS, *SMALL, *words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn("--time" if "--still" in words else "--headless", result.stderr)

    def test_masks_of_other_sizes_are_not_compared(self):
        self.assert_mask(self.compute_mask(CONTACT_BOX))
        other = self.path("other.exr")
        run("visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", other, "--size", "48x32")
        result = run("compare", self.path("mask.exr"), other)
        self.assertEqual(result.returncode, 1)
        self.assertIn("48", result.stderr)

    def test_a_heat_map_and_a_mask_are_written_as_png(self):
        png, heat = self.path("mask.png"), self.path("heat.png")
        self.assert_mask(self.compute_mask(CONTACT_BOX, "--png", png))
        self.assertEqual(read_png_size(png), (32, 32))
        load_json("compare", self.path("mask.exr"), self.path("mask.exr"), "--heatmap", heat)
        self.assertEqual(read_png_size(heat), (32, 32))

    def test_the_same_command_writes_the_same_bytes(self):
        written = []
        for _ in range(2):
            self.assert_mask(self.compute_mask(CONTACT_BOX))
            with open(self.path("mask.exr"), "rb") as file:
                written.append(file.read())
        self.assertEqual(written[0], written[1])

    def test_an_output_is_replaced_whole(self):
        self.write("mask.exr", "old")
        self.assert_mask(self.compute_mask(CONTACT_BOX))
        self.assertEqual(sorted(os.listdir(self.folder)), ["contact_box.bin", "mask.exr"])

    def test_a_moving_light_writes_one_mask_a_frame(self):
        result = self.compute_mask(CONTACT_BOX, "--frames", 3, "--motion", "0.1,0,0")
        self.assertEqual(result.returncode, 0, result.stderr)
        masks = sorted(name for name in os.listdir(self.folder) if name.endswith(".exr"))
        self.assertEqual(masks, ["mask.0000.exr", "mask.0001.exr", "mask.0002.exr"])
        # The mask can be read.
        found = load_json("compare", self.path(masks[0]), self.path(masks[0]))
        self.assertEqual(found["penumbra"]["mae"], 0)

    def test_every_light_of_a_scene_is_found_by_its_name(self):
        for light in ("Spot", "Omni", "Sun"):
            with self.subTest(light=light):
                self.assert_mask(self.compute_mask(THREE_LIGHTS, "--light", light))

    def test_a_headless_run_captures_an_image(self):
        path = self.path("a.png")
        result = run("run", CONTACT_BOX, "--headless", "--size", "48x32", "--frames", 2, "--capture", path, DISPLAY=None)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(read_png_size(path), (48, 32))

    def test_images_are_antialiased_as_the_project_or_the_option_states(self):
        folder = self.path("project")
        os.makedirs(folder)
        for name in ("contact_box.gltf", "contact_box.bin"):
            shutil.copy(os.path.join(os.path.dirname(CONTACT_BOX), name), folder)
        scene = os.path.join(folder, "contact_box.gltf")

        def capture(*words):
            result = run("run", scene, "--headless", *SMALL, "--capture", self.path("a.png"), *words)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(read_png_size(self.path("a.png")), (32, 32))
            with open(self.path("a.png"), "rb") as file:
                return file.read()

        images = [capture("--antialiasing", str(factor)) for factor in (1, 2, 3, 4)]
        self.assertEqual(len(set(images)), 4)
        self.assertEqual(capture(), images[1])
        with open(os.path.join(folder, "project.cfg"), "w", encoding="utf-8") as file:
            file.write("[project]\nname=\"Test\"\n[defaults]\nantialiasing=3\n")
        self.assertEqual(capture(), images[2])
        self.assertEqual(capture("--antialiasing", "1"), images[0])
        # Debug views are not antialiased.
        self.assertEqual(capture("--debug-view", "mask"), capture("--debug-view", "mask", "--antialiasing", "1"))
        with open(os.path.join(folder, "project.cfg"), "w", encoding="utf-8") as file:
            file.write("[project]\nname=\"Test\"\n[defaults]\nantialiasing=9\n")
        result = run("run", scene, "--headless", *SMALL)
        self.assertEqual(result.returncode, 1)
        self.assertIn('antialiasing in [defaults] is "9", must be 1..4', result.stderr)
        self.assertEqual(run("run", scene, "--headless", "--antialiasing", "5").returncode, 2)

    def test_a_project_runs_its_start_scene(self):
        path = self.path("a.png")
        result = run("run", os.path.join(ROOT, "demo_project"), "--headless", *SMALL, "--capture", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(read_png_size(path), (32, 32))

    def test_the_error_against_a_reference_is_shown(self):
        self.assert_mask(self.compute_mask(CONTACT_BOX))
        images = {}
        for name, more in (("error", ("--debug-view", "error")), ("image", ())):
            path = self.path(name + ".png")
            result = run("run", CONTACT_BOX, "--headless", *SMALL, "--reference", self.path("mask.exr"), "--capture", path, *more)
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(path, "rb") as file:
                images[name] = file.read()
        self.assertNotEqual(images["error"], images["image"])

    def test_switching_a_shadow_off_changes_the_image(self):
        images = []
        for number, settings in enumerate(((), ("--set", "light.Light.shadow_enabled=false"))):
            path = self.path("%d.png" % number)
            result = run("run", CONTACT_BOX, "--headless", "--size", "64x64", "--capture", path, *settings)
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(path, "rb") as file:
                images.append(file.read())
        self.assertNotEqual(images[0], images[1])


class Listings(CommandLineTest):
    def test_techniques_are_listed_with_all_their_fields(self):
        techniques = load_json("techniques", "--json")
        keys = {"id", "name", "source", "is_default", "is_fallback", "is_reference", "is_example", "properties", "settings"}
        for item in techniques:
            self.assertLessEqual(keys | {"derived_widths"}, set(item))
            self.assertEqual({"outer_per_size", "inner_per_size"}, set(item["derived_widths"]))
            for value in item["properties"] + item["settings"]:
                self.assertLessEqual({"name", "type", "default", "range", "unit", "tooltip"}, set(value))
                self.assertTrue(value["tooltip"], value["name"])
        for flag in ("is_default", "is_fallback", "is_reference"):
            self.assertEqual(sum(1 for item in techniques if item[flag]), 1, flag)
        self.assertEqual(len({item["id"] for item in techniques}), len(techniques))

    def test_modules_are_listed_with_all_their_fields(self):
        modules = load_json("modules", "--json")
        keys = {"name", "description", "source", "version", "doc", "layer", "can_disable", "is_enabled", "dependencies"}
        names = {item["name"] for item in modules}
        for item in modules:
            self.assertLessEqual(keys, set(item))
            self.assertTrue(item["description"])
            self.assertLessEqual(set(item["dependencies"]), names)
            if item["doc"]:
                self.assertTrue(os.path.isfile(os.path.join(ROOT, item["doc"])), item["doc"])

    def test_devices_are_listed_with_all_their_fields(self):
        info = load_json("info", "--json")
        self.assertLessEqual({"version", "devices", "chosen", "cpu", "threads"}, set(info))
        for item in info["devices"]:
            self.assertLessEqual(
                {"index", "name", "driver", "type", "api_version", "memory_bytes", "is_usable", "refusal"}, set(item)
            )
        self.assertIn(info["chosen"], [item["index"] for item in info["devices"] if item["is_usable"]])

    def test_listings_without_json_are_not_empty(self):
        for command in ("techniques", "modules", "info"):
            with self.subTest(command=command):
                result = run(command)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue(result.stdout.strip())

    def test_examples_are_listed_only_as_json(self):
        for command, key in (("techniques", "id"), ("modules", "name")):
            examples = [item[key] for item in load_json(command, "--json") if item["is_example"]]
            self.assertEqual(len(examples), 1)
            self.assertNotRegex(run(command).stdout, r"(?m)^%s\b" % examples[0])


if __name__ == "__main__":
    unittest.main()
