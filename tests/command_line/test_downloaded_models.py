"""Models as they are downloaded, without camera, light and ground, are shown, masked and measured in one command each."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import ROOT, SCENES, CommandLineTest, find_technique, list_matrix_only, read_png_size, run  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "tests", "benchmark"))
sys.path.insert(0, SCENES)
from mask_file import load_mask  # noqa: E402
from package_files import MeshUnavailable, find_package_file  # noqa: E402

PACKAGE = "assimp-testmodels"
LINE = "Staged: a camera, a spot light and a ground were added. The file stays as it is."
SIZE_PX = 96
SIZE = ("--size", "%dx%d" % (SIZE_PX, SIZE_PX))
MIN_FRACTION = 0.01  # of the receivers: at least so many must be lit, and so many hidden


def find_file(ending):
    """Return the path of the package's file with this ending. If it is missing, skip the test."""
    try:
        return find_package_file(PACKAGE, ending)
    except MeshUnavailable as error:
        raise unittest.SkipTest(str(error)) from error


def find_hidden(mask):
    """Return the indices of the receiver pixels that see less than half of the light."""
    pixels = enumerate(zip(mask.visibility, mask.receiver))
    return {index for index, (value, receiver) in pixels if receiver >= 0.5 and value < 0.5}


class DownloadedModels(CommandLineTest):
    def convert(self, ending, name):
        source = find_file(ending)
        if shutil.which("assimp") is None:
            self.skipTest("the command assimp is missing. Install package assimp-utils")
        command = ["assimp", "export", source, self.path(name)]
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True, timeout=60)
        return self.path(name)

    def read_model(self, path):
        with open(path, encoding="utf-8") as file:
            return json.load(file)

    def copy_nodes(self, scene, names):
        """Write a demo scene that is reduced to these nodes, without cameras and lights. Return its path."""
        model = self.read_model(os.path.join(SCENES, scene))
        for key in ("cameras", "extensions", "extensionsUsed"):
            model.pop(key, None)
        for node in model["nodes"]:
            node.pop("camera", None)
            node.pop("extensions", None)
        model["scenes"][0]["nodes"] = [index for index, node in enumerate(model["nodes"]) if node["name"] in names]
        for part in model["buffers"] + model.get("images", []):
            shutil.copy(os.path.join(SCENES, part["uri"]), self.folder)
        return self.write(scene, json.dumps(model))

    def hash_files(self):
        hashes = {}
        for name in os.listdir(self.folder):
            if os.path.isfile(self.path(name)):
                with open(self.path(name), "rb") as file:
                    hashes[name] = hashlib.sha256(file.read()).hexdigest()
        return hashes

    def check_model(self, path, *words):
        """Run the three commands on a model. words: one text for each ERROR or WARNING line; there must be no other such line."""
        out = self.path("out")
        os.mkdir(out)
        before = self.hash_files()
        image, mask_path = os.path.join(out, "image.png"), os.path.join(out, "mask.exr")
        # With --precision 100 the report times as few frames as it can.
        commands = (
            ("run", path, "--headless", "--capture", image, *SIZE),
            ("visibility", path, "--technique", find_technique("is_default"), "--out", mask_path, *SIZE),
            ("report", path, "--techniques", self.get_fallback(), "--sizes", "0.1", "--samples", "16",
             *list_matrix_only(), "--precision", "100", "--size", "32x32", "--out", os.path.join(out, "report")),
        )  # fmt: skip
        for command in commands:
            with self.subTest(command=command[0]):
                result = run(*command)
                self.assertEqual(result.returncode, 0, result.stderr)
                lines = result.stderr.splitlines()
                self.assertEqual(lines.count(LINE), 1, result.stderr)
                reported = [line for line in lines if line.startswith(("ERROR", "WARNING"))]
                self.assertEqual(len(reported), len(words), reported)
                for word in words:
                    self.assertTrue(any(word in line for line in reported), reported)
        self.assertEqual(read_png_size(image), (SIZE_PX, SIZE_PX))
        self.check_mask(load_mask(mask_path))
        self.assertTrue(self.read_model(os.path.join(out, "report", "report.json"))["cells"])
        self.assertEqual(self.hash_files(), before)

    def check_mask(self, mask):
        receivers = [value for value, receiver in zip(mask.visibility, mask.receiver) if receiver >= 0.5]
        # The ground and the model fill much of the image.
        self.assertGreater(len(receivers), 0.3 * SIZE_PX * SIZE_PX)
        self.assertGreater(sum(value > 0.99 for value in receivers), MIN_FRACTION * len(receivers))
        self.assertGreater(sum(value < 0.01 for value in receivers), MIN_FRACTION * len(receivers))
        self.check_sides(mask)

    def check_sides(self, mask):
        """Assert that the shadow is within the image: it does not reach the lower half of the left or right column."""
        for column in (0, mask.width - 1):
            for row in range(mask.height // 2, mask.height):
                pixel = row * mask.width + column
                self.assertTrue(mask.receiver[pixel] < 0.5 or mask.visibility[pixel] > 0.99, (column, row))

    def test_a_textured_box_is_shown(self):
        source = os.path.dirname(find_file("/glTF2/BoxTextured-glTF/BoxTextured.gltf"))
        for name in ("BoxTextured.gltf", "BoxTextured0.bin", "CesiumLogoFlat.png"):
            shutil.copy(os.path.join(source, name), self.folder)
        self.check_model(self.path("BoxTextured.gltf"))
        # The shadow is also within an image that is higher than wide.
        mask = self.path("narrow.exr")
        result = run(
            "visibility", self.path("BoxTextured.gltf"), "--technique", self.get_fallback(), "--out", mask, "--size", "48x96"
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.check_sides(load_mask(mask))

    def test_a_spider_whose_textures_have_windows_paths_is_shown(self):
        path = self.convert("/OBJ/spider.obj", "spider.gltf")
        model = self.read_model(path)
        self.assertGreater(len(model["nodes"]), 10)
        for image in model["images"]:
            self.assertTrue(image["uri"].startswith(".\\"), image)
            shutil.copy(find_file("/OBJ/" + image["uri"][2:]), self.folder)
        self.check_model(path)

    def test_a_skinned_leg_is_shown(self):
        self.check_model(self.convert("/FBX/huesitos.fbx", "leg.glb"))

    def test_a_scan_without_normals_hundreds_of_kilometres_away_is_shown(self):
        path = self.convert("/PLY/Wuson.ply", "bull.gltf")
        model = self.read_model(path)
        for mesh in model["meshes"]:
            for primitive in mesh["primitives"]:
                primitive["attributes"].pop("NORMAL", None)
        for index in model["scenes"][0]["nodes"]:
            node = model["nodes"][index]
            node.pop("matrix", None)
            node.update({"scale": [1500.0] * 3, "translation": [250000.0, -12000.0, 900000.0]})
        self.check_model(self.write("bull.gltf", json.dumps(model)))

    def test_a_cut_out_leaf_casts_a_smaller_shadow_than_its_card(self):
        path = self.copy_nodes("leaf.gltf", ("Leaf",))
        self.check_model(path)
        model = self.read_model(path)
        for material in model["materials"]:
            material.pop("alphaMode", None)
        card = self.write("card.gltf", json.dumps(model))
        result = run(
            "visibility", card, "--technique", find_technique("is_default"), "--out", self.path("card.exr"), *SIZE
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        hidden = find_hidden(load_mask(self.path("card.exr")))
        lit = hidden - find_hidden(load_mask(os.path.join(self.path("out"), "mask.exr")))
        self.assertGreater(len(lit), 0.3 * len(hidden))

    def test_points_alone_are_refused(self):
        source = os.path.dirname(find_file("/Mesh_PrimitiveMode/Mesh_PrimitiveMode_00.gltf"))
        for ending in (".gltf", ".bin"):
            shutil.copy(os.path.join(source, "Mesh_PrimitiveMode_00" + ending), self.folder)
        result = run("run", self.path("Mesh_PrimitiveMode_00.gltf"), "--headless")
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no triangles", result.stderr)


if __name__ == "__main__":
    unittest.main()
