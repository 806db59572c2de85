"""Every bad input gives one error line that names the object, and leaves no half-written file."""

import json
import os
import struct
import subprocess
import sys
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [FOLDER, os.path.join(os.path.dirname(FOLDER), "fuzz")]
import make_seeds  # noqa: E402
import seed_images  # noqa: E402
from command_line_case import CONTACT_BOX, GNOMON, ROOT, SMALL, TIMEOUT_S, CommandLineTest, load_json, run  # noqa: E402


class BadScenes(CommandLineTest):
    def test_a_missing_scene_is_named(self):
        self.assert_refused(self.compute_mask(self.path("gone.gltf")), "gone.gltf")

    def test_a_folder_instead_of_a_scene_is_named(self):
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

    def test_a_buffer_longer_than_its_bin_is_refused(self):
        with open(self.path("contact_box.bin"), "r+b") as file:
            file.truncate(100)
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "buffers[0].byteLength", "at most 100")

    def test_an_accessor_beyond_its_buffer_is_refused(self):
        self.scene["accessors"][0]["count"] = 1000000
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_an_index_beyond_the_vertices_is_refused(self):
        view = self.scene["bufferViews"][2]  # the indices of the ground
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

    def test_a_transform_of_strings_is_refused(self):
        self.find_node("Box")["translation"] = ["a", "b", "c"]
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf")

    def test_a_scene_without_camera_is_refused(self):
        del self.find_node("Camera")["camera"]
        del self.scene["cameras"]
        result = self.compute_mask(self.write_scene(self.scene), "--stage", "off")
        self.assert_refused(result, "changed.gltf", "camera", "--stage auto")

    def test_a_scene_without_light_is_refused(self):
        del self.find_node("Light")["extensions"]
        del self.scene["extensions"]
        result = self.compute_mask(self.write_scene(self.scene), "--stage", "off")
        self.assert_refused(result, "changed.gltf", "light", "--stage auto")

    def test_a_scene_without_meshes_is_refused(self):
        for node in self.scene["nodes"]:
            node.pop("mesh", None)
        for member in ("meshes", "materials", "accessors", "bufferViews", "buffers"):
            del self.scene[member]
        self.assert_refused(self.compute_mask(self.write_scene(self.scene)), "changed.gltf", "mesh")

    def test_a_blended_surface_is_warned_of(self):
        self.scene["materials"][0]["alphaMode"] = "BLEND"
        result = self.compute_mask(self.write_scene(self.scene))
        self.assert_mask(result)
        self.assertIn("materials[0] has alphaMode BLEND", result.stderr)

    def test_a_light_that_lights_nothing_in_view_is_reported(self):
        self.find_node("Light")["translation"] = [0, -50, 0]  # far below the scene
        self.find_node("Light").pop("rotation", None)
        result = self.compute_mask(self.write_scene(self.scene))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("lights nothing that camera", result.stderr)

    def test_a_spot_light_without_a_spot_object_has_the_default_cone(self):
        del self.get_light()["spot"]
        self.assert_mask(self.compute_mask(self.write_scene(self.scene)))


class InvalidLightValues(CommandLineTest):
    """Values of a wrong type or out of range give one error line, the default replaces them, and the scene is still loaded."""

    def assert_default_used(self, scene, *words):
        result = self.compute_mask(scene)
        self.assert_mask(result)
        errors = [line for line in result.stderr.splitlines() if line.startswith("ERROR: ")]
        self.assertEqual(len(errors), 1, result.stderr)
        for word in ("changed.gltf", *words):
            self.assertIn(word, errors[0])

    def test_the_default_replaces_a_light_size_out_of_range(self):
        for value in (-3, 1e30, 10001):
            with self.subTest(value=value):
                self.get_light()["extras"]["light_size"] = value
                self.assert_default_used(self.write_scene(self.scene), "light_size", "10000")

    def test_a_file_with_a_number_beyond_the_range_of_float_is_refused(self):
        self.get_light()["extras"]["light_size"] = 123.5
        scene = self.write_scene(self.scene, ("123.5", "1e999"))
        self.assert_refused(self.compute_mask(scene), "changed.gltf", "1e999")

    def test_the_default_replaces_a_light_size_that_is_a_string(self):
        self.get_light()["extras"]["light_size"] = "large"
        self.assert_default_used(self.write_scene(self.scene), "light_size")

    def test_the_default_replaces_a_penumbra_width_of_minus_two(self):
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


class BadImages(CommandLineTest):
    """Such images are reported with one error line. The scene is drawn without the image, or with its readable part."""

    def compute_card_errors(self, card):
        """Compute a mask of a make_seeds.Card (a textured quad) and return the ERROR lines."""
        make_seeds.write_gltf(card.document, bytes(card.packed), self.path("changed"))
        result = self.compute_mask(self.path("changed.gltf"))
        self.assert_mask(result)
        return [line for line in result.stderr.splitlines() if line.startswith("ERROR: ")]

    def assert_reported(self, card, *words):
        errors = self.compute_card_errors(card)
        self.assertEqual(len(errors), 1, errors)
        for word in ("changed.gltf", *words):
            self.assertIn(word, errors[0])

    def test_images_that_cannot_be_read_are_reported(self):
        for name, image, words in (
            ("huge", seed_images.make_huge_png(), ("has 20000 x 20000 pixels, must have 1..16384", "Make it smaller")),
            ("cut PNG", seed_images.make_truncated_png(), ("is a PNG image that cannot be read", "Export the")),
            ("cut JPEG", seed_images.make_truncated_jpeg(), ("is a JPEG image that cannot be read", "Export the")),
            ("GIF", seed_images.make_animated_gif(), ("is a GIF image, must be PNG or JPEG", "Convert it")),
            ("WebP", seed_images.make_animated_webp(), ("is a WebP image, must be PNG or JPEG", "Convert it")),
            ("text", b"hello", ("is no image, must be PNG or JPEG", "Export the image")),
        ):
            with self.subTest(name):
                card = make_seeds.make_card_of(image, "image/png")
                self.assert_reported(card, "images[0] " + words[0], words[1], "drawn without it")

    def test_an_animated_png_is_reported(self):
        card = make_seeds.make_card_of(seed_images.make_animated_png(), "image/png")
        self.assert_reported(card, "images[0] is an animated PNG image, of which the first frame is shown")

    def test_an_image_without_source_is_named(self):
        card = make_seeds.Card()
        self.assert_reported(card, "images[0] has neither uri nor bufferView", "Export the file again")

    def test_a_sampler_out_of_range_is_named_and_a_missing_one_is_the_default(self):
        card = make_seeds.make_masked_card()
        card.document["textures"][0]["sampler"] = 99
        self.assert_reported(card, "textures[0].sampler is 99, must be 0..17; repetition with interpolation is used")
        del card.document["textures"][0]["sampler"]
        self.assertEqual(self.compute_card_errors(card), [])

    def test_missing_texture_coordinates_are_named(self):
        card = make_seeds.make_card_without_coordinates()
        self.assert_reported(card, "meshes[0].primitives[0].attributes has no TEXCOORD_1", "Unwrap the mesh")


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

    def test_a_mask_with_the_name_of_another_image_format_is_refused(self):
        target = self.path("mask.png")
        result = run("visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", target, *SMALL)
        self.assert_refused(result, target, "mask.exr", "--png")
        self.assertFalse(os.path.exists(target))

    def test_an_invalid_size_is_refused(self):
        for size in ("0x64", "64", "64x", "axb", "-4x4", "64x64x64", "1000000x1000000", "1e3x4", ""):
            with self.subTest(size=size):
                result = run(
                    "visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", self.path("mask.exr"),
                    "--size", size,
                )  # fmt: skip
                # 2 if the parser of the command line refuses it, 1 if the command does.
                self.assertIn(result.returncode, (1, 2))
                self.assert_refused(result, "--size", size, code=result.returncode)

    def test_a_setting_that_is_unknown_or_out_of_range_is_refused(self):
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

    def test_a_setting_of_a_missing_light_is_refused(self):
        result = run(
            "run", CONTACT_BOX, "--headless", *SMALL, "--capture", self.path("a.png"), "--set", "light.Moon.light_size=1"
        )
        self.assertIn(result.returncode, (1, 2))
        self.assert_refused(result, "Moon", code=result.returncode)

    def test_an_error_view_without_its_reference_names_the_next_step(self):
        show = ("run", CONTACT_BOX, "--headless", *SMALL, "--debug-view", "error")
        self.assert_refused(run(*show), "--reference")
        self.assert_refused(run(*show, "--reference", self.path("missing.exr")), "missing.exr")

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

    def test_an_unknown_command_and_an_empty_path_are_named(self):
        self.assert_refused(run("rnu"), '"rnu" is no command', "run", "visibility", code=2)
        self.assert_refused(run("run", "", "--headless"), "path is empty")

    def test_comparing_files_that_are_no_masks_is_refused(self):
        self.assert_refused(run("compare", self.path("gone.exr"), self.path("gone.exr")), "gone.exr")
        # Text, and bytes that begin almost like a PNG.
        for text in ("hello", "\x7fPNG\r\n\x1a\n" + 100 * " "):
            notes = self.write("notes.txt", text)
            self.assert_refused(run("compare", notes, notes), "notes.txt", "not an OpenEXR file")

    def test_help_and_version_end_with_0(self):
        for arguments in (("--help",), ("--version",), ("visibility", "--help")):
            with self.subTest(arguments=arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue(result.stdout.strip())


class OutputsThatAreInputs(CommandLineTest):
    """No option overwrites a file that its command reads, whatever name or link leads to it."""

    def setUp(self):
        super().setUp()
        self.model = self.write_scene(self.scene)
        self.compute_mask(self.model)
        os.link(self.path("contact_box.bin"), self.path("hard.png"))
        os.symlink(self.model, self.path("link.json"))

    def read_all(self):
        contents = {}
        for name in os.listdir(self.folder):
            with open(self.path(name), "rb") as file:
                contents[name] = file.read()
        return contents

    def assert_nothing_changes(self, option, *arguments):
        before = self.read_all()
        self.assert_refused(run(*arguments), option, has_outputs=True)
        self.assertEqual(self.read_all(), before)

    def test_a_scene_or_its_buffer_is_not_overwritten(self):
        visibility = ("visibility", self.model, "--technique", self.get_fallback(), *SMALL)
        self.assert_nothing_changes("--out", *visibility, "--out", self.model)
        self.assert_nothing_changes("--out", *visibility, "--out", self.path("./changed.gltf"))
        self.assert_nothing_changes("--png", *visibility, "--out", self.path("new.exr"), "--png", self.path("hard.png"))
        self.assert_nothing_changes("--time", *visibility, "--out", self.path("new.exr"), "--time", self.path("link.json"))
        for option in ("--capture", "--dot", "--time"):
            self.assert_nothing_changes(option, "run", self.model, "--headless", *SMALL, option, self.model)

    def test_a_compared_mask_is_not_overwritten(self):
        mask = self.path("mask.exr")
        os.link(mask, self.path("mask.png"))
        self.assert_nothing_changes("--heatmap", "compare", mask, mask, "--heatmap", self.path("mask.png"))

    def test_two_outputs_are_not_one_file(self):
        both = self.path("both")
        self.assert_nothing_changes("--png", "visibility", self.model, "--technique", self.get_fallback(), *SMALL, "--out", both, "--png", both)

    def test_images_of_another_format_are_refused(self):
        for name in ("a.PNG", "a.bmp"):
            visibility = ("visibility", self.model, "--technique", self.get_fallback(), *SMALL)
            self.assert_nothing_changes("--out", *visibility, "--out", self.path(name))
        for name in ("a.jpg", "a.JPEG", "a.exr"):
            self.assert_nothing_changes("--capture", "run", self.model, "--headless", *SMALL, "--capture", self.path(name))

    def test_a_full_device_is_an_error(self):
        for arguments in (("techniques",), ("techniques", "--json"), ("info",), ("modules",), ("compare", self.path("mask.exr"), self.path("mask.exr"))):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([GNOMON, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=TIMEOUT_S, check=False)
            self.assertEqual(done.returncode, 1, arguments)
            self.assertIn("cannot be written", done.stderr)


class MissingDevices(CommandLineTest):
    def test_without_a_vulkan_device_the_next_step_is_named(self):
        nowhere = {"VK_ICD_FILENAMES": "/nonexistent", "VK_DRIVER_FILES": "/nonexistent"}
        self.get_fallback()  # queried while there is a device
        self.assert_refused(self.compute_mask(CONTACT_BOX, **nowhere), "Vulkan")

    def test_without_a_display_the_error_of_a_window_suggests_headless(self):
        nowhere = {"DISPLAY": None, "WAYLAND_DISPLAY": None}
        self.assert_refused(run("run", CONTACT_BOX, **nowhere), "--headless")

    def test_without_a_display_the_editor_is_refused(self):
        result = run("edit", os.path.join(ROOT, "demo_project"), DISPLAY=None, WAYLAND_DISPLAY=None)
        if "editor" in [item["name"] for item in load_json("modules", "--json")]:
            self.assert_refused(result, "display")
        else:
            self.assert_refused(result, code=2)


if __name__ == "__main__":
    unittest.main()
