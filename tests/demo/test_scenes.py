"""The committed demo scenes equal the output of their generator, and have the values that the study defines."""

import json
import math
import os
import struct
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENES = os.path.join(ROOT, "demo_project", "scenes")
sys.path.insert(0, SCENES)

import gltf_writer  # noqa: E402
import make_bunny  # noqa: E402
import make_scenes  # noqa: E402
import shapes  # noqa: E402

STUDY_SCENES = ("sphere", "contact_box", "torus_knot", "stacked_layers", "clutter", "terrain")


def load_scene(name):
    with open(os.path.join(SCENES, name + ".gltf"), encoding="utf-8") as file:
        return json.load(file)


def find_node(scene, name):
    return next(node for node in scene["nodes"] if node["name"] == name)


def distance_from_axis(node, point):
    """Return the distance of the point from the viewing axis, the local Z axis, of a camera's or light's node."""
    ahead = gltf_writer.rotate(node["rotation"], (0.0, 0.0, -1.0))
    offset = gltf_writer.subtract(point, node["translation"])
    return math.sqrt(sum(value * value for value in gltf_writer.cross(offset, ahead)))


class SceneFiles(unittest.TestCase):
    def test_committed_files_are_what_the_generator_writes(self):
        self.assertEqual(make_scenes.find_differences(make_scenes.build_all_files(), SCENES), [])

    def test_a_changed_byte_in_a_scene_is_found(self):
        files = make_scenes.make_contact_box_scene().build_files("contact_box")
        with tempfile.TemporaryDirectory() as folder:
            gltf_writer.save_files(files, folder)
            self.assertEqual(make_scenes.find_differences(files, folder), [])
            with open(os.path.join(folder, "contact_box.bin"), "r+b") as file:
                file.write(b"\x01")
            self.assertEqual(make_scenes.find_differences(files, folder), ["contact_box.bin"])

    def test_all_scenes_together_stay_below_8_mb(self):
        self.assertLess(sum(len(data) for data in make_scenes.build_all_files().values()), 8e6)

    def test_every_accessor_is_in_its_file_and_every_number_is_finite(self):
        for name in make_scenes.SCENES:
            with self.subTest(scene=name):
                scene = load_scene(name)
                with open(os.path.join(SCENES, scene["buffers"][0]["uri"]), "rb") as file:
                    binary = file.read()
                self.assertEqual(len(binary), scene["buffers"][0]["byteLength"])
                for accessor in scene["accessors"]:
                    view = scene["bufferViews"][accessor["bufferView"]]
                    width = 3 if accessor["type"] == "VEC3" else 1
                    self.assertEqual(view["byteLength"], accessor["count"] * width * 4)
                    self.assertEqual(view["byteOffset"] % 4, 0)
                    code = "f" if accessor["componentType"] == gltf_writer.FLOAT else "I"
                    values = struct.unpack_from("<%d%s" % (accessor["count"] * width, code), binary, view["byteOffset"])
                    self.assertTrue(all(math.isfinite(value) for value in values))
                for mesh in scene["meshes"]:
                    primitive = mesh["primitives"][0]
                    vertices = scene["accessors"][primitive["attributes"]["POSITION"]]["count"]
                    indices = scene["accessors"][primitive["indices"]]
                    view = scene["bufferViews"][indices["bufferView"]]
                    used = struct.unpack_from("<%dI" % indices["count"], binary, view["byteOffset"])
                    self.assertEqual((min(used), max(used)), (0, vertices - 1))

    def test_node_names_are_unique_and_rotations_have_length_one(self):
        for name in make_scenes.SCENES:
            with self.subTest(scene=name):
                nodes = load_scene(name)["nodes"]
                self.assertEqual(len({node["name"] for node in nodes}), len(nodes))
                for node in nodes:
                    rotation = node.get("rotation", (0, 0, 0, 1))
                    self.assertAlmostEqual(sum(value * value for value in rotation), 1.0, places=8)

    def test_the_project_lists_every_scene(self):
        with open(os.path.join(ROOT, "demo_project", "project.cfg"), encoding="utf-8") as file:
            text = file.read()
        for name in make_scenes.SCENES:
            self.assertIn('"scenes/%s.gltf"' % name, text)


class StudyNumbers(unittest.TestCase):
    def test_light_and_camera_of_the_study_scenes(self):
        for name in STUDY_SCENES:
            with self.subTest(scene=name):
                scene = load_scene(name)
                is_terrain = name == "terrain"
                light = scene["extensions"]["KHR_lights_punctual"]["lights"][0]
                node = find_node(scene, "Light")
                self.assertEqual(node["translation"], [4.4, 3.9, 2.6] if is_terrain else [1.8, 6.0, 1.2])
                self.assertLess(distance_from_axis(node, (0.0, 0.1 if is_terrain else 0.4, 0.0)), 1e-7)
                tangent = 0.85 if is_terrain else 0.95  # of the cone's half-angle
                self.assertAlmostEqual(light["spot"]["outerConeAngle"], math.atan(tangent), places=8)
                extras = dict(light["extras"])
                self.assertEqual(extras, {"light_size": 0.4, "shadow_enabled": True})
                camera = find_node(scene, "Camera")
                self.assertEqual(camera["translation"], [-3.2, 4.6, 4.6])
                target = (-0.35, 0.55, -0.25) if name == "contact_box" else (-0.3, 0.45, -0.2)
                self.assertLess(distance_from_axis(camera, target), 1e-7)
                field_of_view = math.degrees(scene["cameras"][0]["perspective"]["yfov"])
                self.assertAlmostEqual(field_of_view, 48.9 if is_terrain else 36.87, places=6)
                self.assertEqual(scene["scenes"][0]["extras"]["scene_size"], 4)

    def test_triangle_counts(self):
        counts = {
            "sphere": {"Sphere": 5120, "Ground": 12},
            "contact_box": {"Box": 12, "Ground": 12},
            "torus_knot": {"Knot": 30000, "Ground": 12},
            "clutter": {"Leaves": 3600, "Trunk": 12, "Ground": 12},
            "terrain": {"Terrain": 45000 + 1200 + 600},  # surface, skirt and floor
            "open_sheets": {"Cloth": 1152, "Leaning sheet": 2, "Standing sheet": 2, "Ground": 12},
        }
        for name, expected in counts.items():
            scene = load_scene(name)
            found = {
                mesh["name"]: scene["accessors"][mesh["primitives"][0]["indices"]]["count"] // 3
                for mesh in scene["meshes"]
            }
            self.assertEqual(found, expected, name)

    def test_three_lights_has_one_light_of_each_type(self):
        lights = load_scene("three_lights")["extensions"]["KHR_lights_punctual"]["lights"]
        self.assertEqual(sorted(light["type"] for light in lights), ["directional", "point", "spot"])


class MeshCheck(unittest.TestCase):
    """The generator's check of meshes accepts valid meshes and refuses broken ones."""

    def test_a_closed_box_is_accepted(self):
        shapes.make_box((1.0, 2.0, 3.0)).check("box")

    def test_a_missing_face_is_refused(self):
        box = shapes.make_box((1.0, 1.0, 1.0))
        box.triangles.pop()
        with self.assertRaisesRegex(ValueError, "not closed"):
            box.check("box")

    def test_one_face_of_opposite_winding_is_refused(self):
        box = shapes.make_box((1.0, 1.0, 1.0))
        box.triangles[0] = tuple(reversed(box.triangles[0]))
        with self.assertRaisesRegex(ValueError, "one direction"):
            box.check("box")

    def test_a_box_turned_inside_out_is_refused(self):
        box = shapes.make_box((1.0, 1.0, 1.0))
        box.triangles = [tuple(reversed(triangle)) for triangle in box.triangles]
        with self.assertRaisesRegex(ValueError, "inward"):
            box.check("box")

    def test_a_triangle_without_area_is_refused(self):
        box = shapes.make_box((1.0, 1.0, 1.0))
        box.add_triangle(0, 0, 1)
        with self.assertRaisesRegex(ValueError, "no area"):
            box.check("box")

    def test_normals_agree_with_the_winding(self):
        for name, mesh in (
            ("box", shapes.make_box((1.0, 2.0, 3.0))),
            ("cylinder", shapes.make_cylinder(0.5, 0.04, 48)),
            ("icosphere", shapes.make_icosphere(2, 0.8)),
            ("knot", shapes.make_torus_knot(0.36, 0.16, 120, 16)),
            ("terrain", shapes.make_terrain(30, 3.6, -0.8, 150)),
            ("cloth", shapes.make_cloth(24, 0.75, 0.09)),
        ):
            with self.subTest(mesh=name):
                for a, b, c in mesh.triangles:
                    origin = mesh.positions[a]
                    edge_1 = gltf_writer.subtract(mesh.positions[b], origin)
                    edge_2 = gltf_writer.subtract(mesh.positions[c], origin)
                    face_normal = gltf_writer.cross(edge_1, edge_2)
                    for index in (a, b, c):
                        self.assertGreater(gltf_writer.dot(face_normal, mesh.normals[index]), 0.0)


class Bunny(unittest.TestCase):
    def test_a_mesh_is_on_the_ground_and_is_as_high_as_promised(self):
        points = [(-1.0, 5.0, 0.0), (1.0, 5.0, 0.0), (0.0, 5.0, 1.5), (0.0, 7.0, 0.5)]
        mesh = make_bunny.make_bunny(points, [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)])
        mesh.check("tetrahedron")
        heights = [position[1] for position in mesh.positions]
        self.assertEqual(min(heights), 0.0)
        self.assertAlmostEqual(max(heights), make_bunny.HEIGHT_M, places=6)


if __name__ == "__main__":
    unittest.main()
