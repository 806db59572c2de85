"""Generated scenes of cut-out casters depend only on their seed, and the alpha of their textures follows the shapes' formulas."""

import os
import random
import struct
import sys
import unittest
import zlib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project", "scenes"))

import foliage_shapes  # noqa: E402
import make_foliage_scenes  # noqa: E402


def decode_png(png):
    """Return (size, rows of red, green, blue, alpha) of what encode_png writes."""
    chunks = {}
    at = 8  # after the signature
    while at < len(png):
        length = struct.unpack(">I", png[at : at + 4])[0]
        kind, data = png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + data) == struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0]
        chunks[kind] = data
        at += 12 + length
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    lines = zlib.decompress(chunks[b"IDAT"])
    # Each line begins with a byte for its filter.
    rows = [lines[y * (4 * width + 1) + 1 : (y + 1) * (4 * width + 1)] for y in range(height)]
    return (width, height), rows


class FoliageScenes(unittest.TestCase):
    def test_the_same_seed_gives_the_same_bytes_and_another_does_not(self):
        for name in make_foliage_scenes.SCENES:
            with self.subTest(name):
                files = make_foliage_scenes.build_scene_files(name, seed=3, count=20)
                self.assertEqual(files, make_foliage_scenes.build_scene_files(name, seed=3, count=20))
                if name in ("leaves", "courtyard"):  # the meshes of the others are not random
                    others = make_foliage_scenes.build_scene_files(name, seed=4, count=20)
                    self.assertNotEqual(files[name + ".bin"], others[name + ".bin"])

    def test_a_scene_has_its_images_next_to_it_and_casters_that_are_cut_out(self):
        for name in make_foliage_scenes.SCENES:
            with self.subTest(name):
                document = make_foliage_scenes.build_scene(name, seed=1, count=20)
                files = document.build_files(name)
                self.assertEqual({image["uri"] for image in document.root["images"]}, {file for file in files if file.endswith(".png")})
                cut_out = [material for material in document.root["materials"] if material.get("alphaMode") == "MASK"]
                self.assertTrue(cut_out)
                self.assertTrue(all("baseColorTexture" in material["pbrMetallicRoughness"] for material in cut_out))
                indices = [document.root["materials"].index(material) for material in cut_out]
                primitives = [mesh["primitives"][0] for mesh in document.root["meshes"]]
                cards = [primitive for primitive in primitives if primitive["material"] in indices]
                self.assertTrue(all("TEXCOORD_0" in card["attributes"] for card in cards))

    def test_alpha_is_a_ramp_of_the_depth_inside_the_shape(self):
        for png, depth in (
            (foliage_shapes.make_chain_png(), foliage_shapes.get_chain_depth),
            (foliage_shapes.make_leaf_png("oval", (0.4, 0.6, 0.2)), lambda u, v: foliage_shapes.get_leaf_depth("oval", u - 0.5, 0.5 - v)),
            (foliage_shapes.make_leaf_png("star", (0.4, 0.6, 0.2)), lambda u, v: foliage_shapes.get_leaf_depth("star", u - 0.5, 0.5 - v)),
        ):
            (width, height), rows = decode_png(png)
            for y in range(height):
                for x in range(width):
                    expected = 0.5 + 0.5 * depth((x + 0.5) / width, (y + 0.5) / height) * width
                    # Rounding to 8 bits changes it by up to 0.002.
                    self.assertAlmostEqual(rows[y][4 * x + 3] / 255.0, min(max(expected, 0.0), 1.0), delta=0.003)

    def test_a_wall_is_opaque(self):
        _size, rows = decode_png(foliage_shapes.make_stone_png(random.Random(1), 32))
        self.assertTrue(all(row[3::4] == b"\xff" * 32 for row in rows))

    def test_leaves_have_as_many_cards_as_requested(self):
        center = (0.0, 1.0, 0.0)
        mesh = foliage_shapes.make_leaves(random.Random(2), 50, half_size_m=0.1, center=center, radius_m=0.7)
        self.assertEqual(len(mesh.triangles), 100)
        self.assertEqual(len(mesh.uvs), 200)


if __name__ == "__main__":
    unittest.main()
