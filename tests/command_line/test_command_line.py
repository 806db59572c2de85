"""bin/gnomon from outside: what good commands write, and what every bad input is answered.

The program is bin/gnomon, or $GNOMON. Technique ids come from the program itself.
"""

import copy
import json
import math
import os
import shutil
import struct
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GNOMON = os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon"))
SCENES = os.path.join(ROOT, "demo_project", "scenes")
CONTACT_BOX = os.path.join(SCENES, "contact_box.gltf")
THREE_LIGHTS = os.path.join(SCENES, "three_lights.gltf")
TIMEOUT_S = 180
SMALL = ("--size", "32x32")
LIGHTS = "KHR_lights_punctual"


def run(*arguments, **environment):
    """The finished process. A value of None takes the variable out of the environment."""
    variables = {**os.environ, **environment}
    variables = {name: value for name, value in variables.items() if value is not None}
    command = [GNOMON, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, env=variables, check=False)


def load_json(*arguments):
    result = run(*arguments)
    if result.returncode != 0:
        raise AssertionError("%s ended with %d: %s" % (" ".join(map(str, arguments)), result.returncode, result.stderr))
    return json.loads(result.stdout)


def find_technique(flag):
    return next(item["id"] for item in load_json("techniques", "--json") if item[flag])


def read_png_size(path):
    with open(path, "rb") as file:
        data = file.read(24)
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", data[16:24])


class CommandLineTest(unittest.TestCase):
    """A folder for each test, and the scene that its inputs are made from."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        with open(CONTACT_BOX, encoding="utf-8") as file:
            self.scene = json.load(file)
        shutil.copy(os.path.join(SCENES, "contact_box.bin"), self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data if isinstance(data, bytes) else data.encode("utf-8"))
        return self.path(name)

    def write_scene(self, scene, *replacements):
        """The scene as a file; replacements (old, new) are made in its text."""
        text = json.dumps(scene, indent="\t")
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        return self.write("changed.gltf", text)

    def build_glb(self):
        scene = copy.deepcopy(self.scene)
        del scene["buffers"][0]["uri"]
        text = json.dumps(scene).encode("utf-8")
        text += b" " * (-len(text) % 4)
        with open(self.path("contact_box.bin"), "rb") as file:
            binary = file.read()
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def find_node(self, name):
        return next(node for node in self.scene["nodes"] if node["name"] == name)

    def get_light(self):
        return self.scene["extensions"][LIGHTS]["lights"][0]

    def compute_mask(self, scene, *arguments, **environment):
        """visibility with small defaults; returns the process. The output is mask.exr."""
        return run("visibility", scene, "--technique", self.get_fallback(), "--out", self.path("mask.exr"), *SMALL, *arguments, **environment)

    fallback = None

    def get_fallback(self):
        if CommandLineTest.fallback is None:
            CommandLineTest.fallback = find_technique("is_fallback")
        return CommandLineTest.fallback

    def assert_refused(self, result, *words, code=1):
        """One ERROR line that has all the words; the exit code; and nothing was written."""
        lines = result.stderr.splitlines()
        errors = [line for line in lines if line.startswith("ERROR: ")]
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(len(errors), 1, result.stderr)
        for word in words:
            self.assertIn(str(word), errors[0])
        left = [name for name in os.listdir(self.folder) if name not in self.inputs()]
        self.assertEqual(left, [], "left behind")

    def inputs(self):
        return ("changed.gltf", "contact_box.bin", "broken.gltf", "broken.glb", "notes.txt")

    def assert_mask(self, result, name="mask.exr"):
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path(name), "rb") as file:
            self.assertEqual(file.read(4), b"\x76\x2f\x31\x01", "an EXR begins so")


class BadScenes(CommandLineTest):
    def test_a_missing_scene_is_named(self):
        self.assert_refused(self.compute_mask(self.path("gone.gltf")), "gone.gltf")

    def test_a_folder_in_place_of_a_scene_is_named(self):
        self.assert_refused(self.compute_mask(os.path.join(ROOT, "doc")), "doc")

    def test_a_file_that_is_no_scene_is_named(self):
        self.assert_refused(self.compute_mask(self.write("notes.txt", "hello")), "notes.txt")

    def test_a_truncated_gltf_is_named(self):
        text = json.dumps(self.scene)
        for length in (0, 1, len(text) // 2, len(text) - 1):
            with self.subTest(length=length):
                self.assert_refused(self.compute_mask(self.write("broken.gltf", text[:length])), "broken.gltf")

    def test_a_truncated_glb_is_named(self):
        data = self.build_glb()
        for length in (0, 3, 11, 20, len(data) // 2, len(data) - 1):
            with self.subTest(length=length):
                self.assert_refused(self.compute_mask(self.write("broken.glb", data[:length])), "broken.glb")

    def test_a_whole_glb_is_read(self):
        self.assert_mask(self.compute_mask(self.write("broken.glb", self.build_glb())))

    def test_a_missing_bin_is_named(self):
        os.remove(self.path("contact_box.bin"))
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "contact_box.bin")

    def test_a_short_bin_is_named(self):
        with open(self.path("contact_box.bin"), "r+b") as file:
            file.truncate(100)
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_an_accessor_beyond_its_buffer_is_refused(self):
        self.scene["accessors"][0]["count"] = 1000000
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_an_index_beyond_the_vertices_is_refused(self):
        view = self.scene["bufferViews"][2]
        with open(self.path("contact_box.bin"), "r+b") as file:
            file.seek(view["byteOffset"])
            file.write(struct.pack("<I", 4000000000))
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_a_node_that_is_its_own_child_is_refused(self):
        self.scene["nodes"][0]["children"] = [0]
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_a_path_out_of_the_project_is_refused(self):
        self.scene["buffers"][0]["uri"] = "../../../../../../etc/hostname"
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "hostname")

    def test_an_infinite_transform_is_refused(self):
        self.find_node("Box")["translation"][0] = 123.5
        self.assert_refused(self.compute_mask(self.write_scene(self.scene, ("123.5", "1e999"))), "changed.gltf")

    def test_a_transform_of_words_is_refused(self):
        self.find_node("Box")["translation"] = ["a", "b", "c"]
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_a_scene_without_camera_says_so(self):
        del self.find_node("Camera")["camera"]
        del self.scene["cameras"]
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf", "camera")

    def test_a_scene_without_light_says_so(self):
        del self.find_node("Light")["extensions"]
        del self.scene["extensions"]
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf", "light")

    def test_a_scene_without_meshes_is_all_background(self):
        for node in self.scene["nodes"]:
            node.pop("mesh", None)
        for member in ("meshes", "materials", "accessors", "bufferViews", "buffers"):
            del self.scene[member]
        self.assert_mask(self.compute_mask(self.write_scene(self.scene)))


class AbsurdLightValues(CommandLineTest):
    """Refused with an error line, the default is used and the load goes on."""

    def assert_default_used(self, scene, *words):
        result = self.compute_mask(scene)
        self.assert_mask(result)
        errors = [line for line in result.stderr.splitlines() if line.startswith("ERROR: ")]
        self.assertEqual(len(errors), 1, result.stderr)
        for word in ("changed.gltf", *words):
            self.assertIn(word, errors[0])

    def test_a_light_size_out_of_range(self):
        for value in (-3, 1e30, 10001):
            with self.subTest(value=value):
                self.get_light()["extras"]["light_size"] = value
                self.assert_default_used(self.write_scene(self.scene), "light_size", "10000")

    def test_a_light_size_that_is_infinite(self):
        self.get_light()["extras"]["light_size"] = 123.5
        self.assert_default_used(self.write_scene(self.scene, ("123.5", "1e999")), "light_size")

    def test_a_light_size_of_words(self):
        self.get_light()["extras"]["light_size"] = "large"
        self.assert_default_used(self.write_scene(self.scene), "light_size")

    def test_a_penumbra_width_of_minus_two(self):
        self.get_light()["extras"]["penumbra_outer_width"] = -2
        self.assert_default_used(self.write_scene(self.scene), "penumbra_outer_width")

    def test_a_penumbra_width_of_minus_one_is_allowed(self):
        self.get_light()["extras"]["penumbra_outer_width"] = -1
        result = self.compute_mask(self.write_scene(self.scene))
        self.assert_mask(result)
        self.assertNotIn("ERROR", result.stderr)

    def test_a_technique_that_this_build_lacks_falls_back_with_a_warning(self):
        self.get_light()["extras"]["shadow_technique"] = "gone"
        result = run("run", self.write_scene(self.scene), "--headless", *SMALL, "--capture", self.path("a.png"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("gone", result.stderr)
        self.assertIn("WARNING", result.stderr)


class BadArguments(CommandLineTest):
    def test_an_unknown_technique_is_named_with_the_known_ones(self):
        result = run("visibility", CONTACT_BOX, "--technique", "gone", "--out", self.path("mask.exr"), *SMALL)
        self.assert_refused(result, "gone", self.get_fallback())

    def test_an_unknown_light_is_named_with_the_known_ones(self):
        self.assert_refused(self.compute_mask(CONTACT_BOX, "--light", "Moon"), "Moon", "Light")

    def test_an_unknown_camera_is_named_with_the_known_ones(self):
        self.assert_refused(self.compute_mask(CONTACT_BOX, "--camera", "Side"), "Side", "Camera")

    def test_an_unknown_device_is_named(self):
        self.assert_refused(self.compute_mask(CONTACT_BOX, "--device", "no such device"), "no such device")
        self.assert_refused(self.compute_mask(CONTACT_BOX, "--device", "99"), "99")

    def test_an_output_folder_that_is_missing_is_named(self):
        target = self.path("gone/mask.exr")
        self.assert_refused(
            run("visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", target, *SMALL), "gone"
        )
        result = run("run", CONTACT_BOX, "--headless", *SMALL, "--capture", self.path("gone/a.png"))
        self.assert_refused(result, "gone")

    def test_a_size_that_is_none(self):
        for size in ("0x64", "64", "64x", "axb", "-4x4", "64x64x64", "1000000x1000000", "1e3x4", ""):
            with self.subTest(size=size):
                result = run(
                    "visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", self.path("mask.exr"),
                    "--size", size,
                )  # fmt: skip
                self.assertIn(result.returncode, (1, 2))
                self.assert_refused(result, "--size", size, code=result.returncode)

    def test_a_setting_that_is_unknown_or_out_of_range(self):
        for setting, word in (
            ("gone=1", "gone"),
            ("light_size", "light_size"),
            ("light_size=", "light_size"),
            ("light_size=-3", "10000"),
            ("light_size=nan", "light_size"),
            ("light_size=1e30", "10000"),
            ("light_size=large", "large"),
            ("shadow_enabled=perhaps", "perhaps"),
        ):
            with self.subTest(setting=setting):
                result = self.compute_mask(CONTACT_BOX, "--set", setting)
                self.assertIn(result.returncode, (1, 2))
                self.assert_refused(result, word, code=result.returncode)

    def test_a_setting_of_a_light_that_is_not_there(self):
        result = run(
            "run", CONTACT_BOX, "--headless", *SMALL, "--capture", self.path("a.png"), "--set", "light.Moon.light_size=1"
        )
        self.assertIn(result.returncode, (1, 2))
        self.assert_refused(result, "Moon", code=result.returncode)

    def test_wrong_usage_ends_with_2(self):
        for arguments in (
            ("gone",),
            ("--gone",),
            ("visibility",),
            ("visibility", CONTACT_BOX),
            ("visibility", CONTACT_BOX, "--gone"),
            ("run", CONTACT_BOX, "--headless", "--frames", "many"),
            ("run", CONTACT_BOX, "--headless", "--frames", "-1"),
            ("compare",),
            ("techniques", "--gone"),
        ):
            with self.subTest(arguments=arguments):
                self.assert_refused(run(*arguments), code=2)

    def test_comparing_what_is_no_mask(self):
        self.assert_refused(run("compare", self.path("gone.exr"), self.path("gone.exr")), "gone.exr")
        notes = self.write("notes.txt", "hello")
        self.assert_refused(run("compare", notes, notes), "notes.txt")

    def test_help_and_version_end_with_0(self):
        for arguments in (("--help",), ("--version",), ("visibility", "--help")):
            with self.subTest(arguments=arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue(result.stdout.strip())


class MissingDevices(CommandLineTest):
    def test_without_a_vulkan_device_the_next_step_is_named(self):
        nowhere = {"VK_ICD_FILENAMES": "/nonexistent", "VK_DRIVER_FILES": "/nonexistent"}
        self.get_fallback()  # asked while there is a device
        self.assert_refused(self.compute_mask(CONTACT_BOX, **nowhere), "Vulkan")

    def test_without_a_display_a_window_names_headless(self):
        nowhere = {"DISPLAY": None, "WAYLAND_DISPLAY": None}
        self.assert_refused(run("run", CONTACT_BOX, **nowhere), "--headless")

    def test_without_a_display_the_editor_says_so(self):
        result = run("edit", os.path.join(ROOT, "demo_project"), DISPLAY=None, WAYLAND_DISPLAY=None)
        self.assert_refused(result, "display")


class GoodCommands(CommandLineTest):
    def test_masks_are_compared(self):
        reference = find_technique("is_reference")
        truth, mask, times = self.path("truth.exr"), self.path("mask.exr"), self.path("time.json")
        size = ("--size", "128x128")
        samples = ("--set", "%s_samples=64" % reference)
        result = run("visibility", CONTACT_BOX, "--technique", reference, "--out", truth, *size, *samples)
        self.assert_mask(result, "truth.exr")
        result = run(
            "visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", mask, *size, "--time", times
        )
        self.assert_mask(result)
        found = load_json("compare", truth, mask)
        self.assertEqual(set(found), {"pixels", "receiver", "penumbra"})
        self.assertEqual(set(found["receiver"]), {"mae", "rmse", "p99", "bias"})
        self.assertEqual(set(found["penumbra"]), {"pixels", "mae", "rmse", "p99", "bias", "umbra_over"})
        self.assertGreater(found["penumbra"]["pixels"], 100)
        self.assertLess(found["penumbra"]["pixels"], found["pixels"])
        self.assertTrue(0.0 < found["receiver"]["mae"] < found["penumbra"]["mae"] < 0.5)
        self.assertLessEqual(abs(found["penumbra"]["bias"]), found["penumbra"]["mae"])
        same = load_json("compare", truth, truth)
        self.assertEqual(same["penumbra"]["mae"], 0)
        with open(times, encoding="utf-8") as file:
            cost = json.load(file)
        self.assertLessEqual(
            {"device", "driver", "threads", "frames", "triangles", "edges", "passes", "total", "bytes"}, set(cost)
        )
        self.assertEqual(set(cost["total"]), {"gpu_ms", "gpu_ms_p90", "wall_ms", "wall_ms_p90"})
        self.assertEqual(cost["frames"], 20)
        self.assertEqual(cost["triangles"], 24)
        self.assertTrue(cost["passes"])
        for item in cost["passes"]:
            self.assertLessEqual({"name", "gpu_ms", "wall_ms"}, set(item))
        for value in cost["total"].values():
            self.assertTrue(math.isfinite(value) and value > 0.0)

    def test_masks_of_other_sizes_are_not_compared(self):
        self.assert_mask(self.compute_mask(CONTACT_BOX))
        other = self.path("other.exr")
        run("visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", other, "--size", "48x32")
        result = run("compare", self.path("mask.exr"), other)
        self.assertEqual(result.returncode, 1)
        self.assertIn("48", result.stderr)

    def test_a_heat_map_and_a_mask_as_png(self):
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
        found = load_json("compare", self.path(masks[0]), self.path(masks[0]))
        self.assertEqual(found["penumbra"]["mae"], 0)

    def test_every_light_of_a_scene_is_found_by_its_name(self):
        for light in ("Spot", "Omni", "Sun"):
            with self.subTest(light=light):
                self.assert_mask(self.compute_mask(THREE_LIGHTS, "--light", light))

    def test_a_headless_run_captures_a_picture(self):
        path = self.path("a.png")
        result = run("run", CONTACT_BOX, "--headless", "--size", "48x32", "--frames", 2, "--capture", path, DISPLAY=None)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(read_png_size(path), (48, 32))

    def test_a_project_runs_its_start_scene(self):
        path = self.path("a.png")
        result = run("run", os.path.join(ROOT, "demo_project"), "--headless", *SMALL, "--capture", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(read_png_size(path), (32, 32))

    def test_switching_a_shadow_off_changes_the_picture(self):
        pictures = []
        for number, settings in enumerate(((), ("--set", "light.Light.shadow_enabled=false"))):
            path = self.path("%d.png" % number)
            result = run("run", CONTACT_BOX, "--headless", "--size", "64x64", "--capture", path, *settings)
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(path, "rb") as file:
                pictures.append(file.read())
        self.assertNotEqual(pictures[0], pictures[1])


class Listings(CommandLineTest):
    def test_techniques(self):
        techniques = load_json("techniques", "--json")
        keys = {"id", "name", "source", "module", "is_default", "is_fallback", "is_reference", "properties"}
        for item in techniques:
            self.assertLessEqual(keys, set(item))
            for value in item["properties"]:
                self.assertLessEqual({"name", "type", "default", "range", "unit", "tooltip"}, set(value))
                self.assertTrue(value["tooltip"], value["name"])
        for flag in ("is_default", "is_fallback", "is_reference"):
            self.assertEqual(sum(1 for item in techniques if item[flag]), 1, flag)
        self.assertEqual(len({item["id"] for item in techniques}), len(techniques))

    def test_modules(self):
        modules = load_json("modules", "--json")
        keys = {"name", "description", "source", "version", "doc", "layer", "can_disable", "is_enabled", "dependencies"}
        names = {item["name"] for item in modules}
        for item in modules:
            self.assertLessEqual(keys, set(item))
            self.assertTrue(item["description"])
            self.assertLessEqual(set(item["dependencies"]), names)
            if item["doc"]:
                self.assertTrue(os.path.isfile(os.path.join(ROOT, item["doc"])), item["doc"])

    def test_info(self):
        info = load_json("info", "--json")
        self.assertLessEqual({"version", "devices", "chosen", "cpu", "threads"}, set(info))
        for item in info["devices"]:
            self.assertLessEqual(
                {"index", "name", "driver", "type", "api_version", "memory_bytes", "is_usable", "refusal"}, set(item)
            )
        self.assertIn(info["chosen"], [item["index"] for item in info["devices"] if item["is_usable"]])

    def test_listings_for_people(self):
        for command in ("techniques", "modules", "info"):
            with self.subTest(command=command):
                result = run(command)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue(result.stdout.strip())


if __name__ == "__main__":
    unittest.main()
