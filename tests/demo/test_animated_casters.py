"""Animated casters of courtyard: the figure is a closed mesh with a valid skin and walk, and the flag waves except at its edge on the pole."""

import json
import math
import os
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project", "scenes"))
sys.path.insert(0, os.path.join(ROOT, "tests", "demo"))

import flag_shapes  # noqa: E402
import gltf_animation  # noqa: E402
import gltf_pose  # noqa: E402
import gltf_writer  # noqa: E402
import make_foliage_scenes  # noqa: E402

ANIMATION = "Walk"
LOOP_S = 6.0  # five cycles
CYCLE_S = 1.2  # two steps
MAX_BYTES = 700000  # of courtyard.bin
GROUND_TOLERANCE_M = 0.01  # the figure is 5.5 mm below the ground at most
MAX_SLIDE_M = 0.005  # a flat foot slides by 0.9 mm at most


def load_courtyard():
    files = make_foliage_scenes.build_scene_files("courtyard")
    return json.loads(files["courtyard.gltf"]), files["courtyard.bin"]


class Courtyard(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gltf, cls.binary = load_courtyard()
        cls.walk = gltf_pose.Poser(cls.gltf, cls.binary, ANIMATION)
        cls.rest = gltf_pose.Poser(cls.gltf, cls.binary)
        cls.skin = cls.gltf["skins"][0]
        cls.joint_names = [cls.gltf["nodes"][joint]["name"] for joint in cls.skin["joints"]]

    def find_node(self, name):
        return gltf_pose.find_named(self.gltf["nodes"], name)

    def get_primitive(self, name):
        return self.gltf["meshes"][self.gltf["nodes"][self.find_node(name)]["mesh"]]["primitives"][0]

    def read(self, name, attribute):
        return self.rest.read(self.get_primitive(name)["attributes"][attribute])

    def read_triangles(self, name):
        flat = [index for (index,) in self.rest.read(self.get_primitive(name)["indices"])]
        return list(zip(flat[::3], flat[1::3], flat[2::3]))

    def find_sole(self, side):
        """Return the vertices of a sole: those on the ground, at rest, that only the foot's joint moves."""
        foot = self.joint_names.index("Foot " + side)
        found = []
        for index, (point, joints, weights) in enumerate(zip(*(self.read("Figure", name) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0")))):
            if point[1] < 0.005 and sum(weight for joint, weight in zip(joints, weights) if joint == foot) > 0.99:
                found.append(index)
        return found


class Figure(Courtyard):
    def test_it_is_closed_and_shares_its_vertices(self):
        edges = {}
        for triangle in self.read_triangles("Figure"):
            for start, end in zip(triangle, triangle[1:] + triangle[:1]):
                edges[start, end] = edges.get((start, end), 0) + 1
        self.assertEqual(set(edges.values()), {1})
        self.assertTrue(all((end, start) in edges for start, end in edges))
        self.assertEqual(len(set(self.read("Figure", "POSITION"))), len(self.read("Figure", "POSITION")))
        self.assertTrue(2000 <= len(edges) // 3 <= 4000, len(edges) // 3)  # triangles

    def test_it_is_as_high_as_a_person_and_its_soles_are_on_the_ground(self):
        heights = [point[1] for point in self.read("Figure", "POSITION")]
        self.assertAlmostEqual(min(heights), 0.0, delta=0.001)
        self.assertTrue(1.2 <= max(heights) <= 1.75, max(heights))

    def test_each_vertex_follows_up_to_four_of_20_joints_with_weights_of_sum_1(self):
        self.assertEqual(len(self.skin["joints"]), 20)
        self.assertEqual(len(set(self.skin["joints"])), 20)
        self.assertEqual(self.gltf["nodes"][self.skin["skeleton"]]["name"], "Root")
        for joints, weights in zip(self.read("Figure", "JOINTS_0"), self.read("Figure", "WEIGHTS_0")):
            self.assertLess(max(joints), 20)
            self.assertGreaterEqual(min(weights), 0.0)
            self.assertEqual(sum(weights), 1.0)
            used = [joint for joint, weight in zip(joints, weights) if weight > 0.0]
            self.assertEqual(len(set(used)), len(used))
            self.assertTrue(all(joint == 0 for joint, weight in zip(joints, weights) if weight == 0.0))

    def test_at_rest_the_skin_gives_the_mesh_of_its_node(self):
        node = self.find_node("Figure")
        self.assertIn(node, self.gltf["scenes"][0]["nodes"])
        self.assertEqual(set(self.gltf["nodes"][node]), {"name", "mesh", "skin"})
        for point, posed in zip(self.read("Figure", "POSITION"), self.rest.compute_points(node, 0.0)):
            self.assertLess(math.dist(point, posed), 1e-6)

    def test_no_triangle_collapses_or_is_stretched_while_it_walks(self):
        triangles = self.read_triangles("Figure")
        rest = self.read("Figure", "POSITION")
        lengths = {(a, b): math.dist(rest[a], rest[b]) for triangle in triangles for a, b in zip(triangle, triangle[1:])}
        for index in range(8):
            points = self.walk.compute_points(self.find_node("Figure"), CYCLE_S * index / 8)
            ratios = sorted(math.dist(points[a], points[b]) / length for (a, b), length in lengths.items())
            self.assertGreater(ratios[len(ratios) // 100], 0.6)  # all but one in a hundred
            self.assertLess(ratios[-1], 2.5)


class Walk(Courtyard):
    def test_the_loop_closes(self):
        self.assertAlmostEqual(self.walk.get_duration(), LOOP_S, places=6)
        for name in ("Figure", "Flag"):
            with self.subTest(name):
                node = self.find_node(name)
                first, last = (self.walk.compute_points(node, time) for time in (0.0, self.walk.get_duration()))
                self.assertLess(max(map(math.dist, first, last)), 1e-6)

    def test_it_moves_as_smoothly_through_the_loop_s_end_as_elsewhere(self):
        """One cycle later each vertex moves in the same way, farther along the circular path."""
        step_s = 0.01
        node = self.find_node("Figure")
        bends = []  # of each vertex, in metres: how much its motion changes between two steps
        for times in ((LOOP_S - step_s, 0.0, step_s), (CYCLE_S - step_s, CYCLE_S, CYCLE_S + step_s)):
            before, at, after = (self.walk.compute_points(node, time) for time in times)
            bends.append([math.dist(gltf_writer.subtract(b, a), gltf_writer.subtract(c, b)) for a, b, c in zip(before, at, after)])
        for at_end, elsewhere in zip(*bends):
            self.assertAlmostEqual(at_end, elsewhere, delta=2e-5)

    def test_the_feet_stay_on_the_ground(self):
        for index in range(16):
            time = LOOP_S * index / 16
            with self.subTest(time=time):
                lowest = min(point[1] for point in self.walk.compute_points(self.find_node("Figure"), time))
                self.assertAlmostEqual(lowest, 0.0, delta=GROUND_TOLERANCE_M)

    def test_a_flat_foot_does_not_slide(self):
        for side, offset in (("L", 0.0), ("R", 0.5)):  # the middle of the foot's stance, in cycles
            sole = self.find_sole(side)
            self.assertGreater(len(sole), 5)
            # A sole is flat from 0.21 cycles before the middle of its stance to 0.06 cycles after
            # it (TOES_UP_DEG in figure_walk.py).
            for cycle in (1, 3):
                times = [CYCLE_S * (cycle + offset - 0.2 + 0.025 * index) for index in range(11)]
                poses = [self.walk.compute_points(self.find_node("Figure"), time) for time in times]
                for pose in poses[1:]:
                    self.assertLess(max(math.dist(pose[index], poses[0][index]) for index in sole), MAX_SLIDE_M)

    def test_knees_bend_forward_and_arms_swing_against_the_legs(self):
        root, products = self.find_node("Root"), []
        for index in range(16):
            matrices = self.walk.compute_matrices(self.walk.compute_values(CYCLE_S * index / 16))

            def get_ahead_m(name, matrices=matrices):
                """Return how many metres ahead of the root a joint is."""
                matrix = matrices[self.find_node(name)]
                return sum((matrix[12 + axis] - matrices[root][12 + axis]) * matrices[root][8 + axis] for axis in range(3))

            for side in "LR":
                hip, knee, foot = (get_ahead_m("%s %s" % (name, side)) for name in ("Upper leg", "Lower leg", "Foot"))
                self.assertGreater(knee, 0.5 * (hip + foot) - 0.005)  # with a tolerance of 5 mm
                # Bent elbows hold the hands about 0.1 m ahead of the shoulders on average.
                swing_m = get_ahead_m("Hand " + side) - get_ahead_m("Upper arm " + side) - 0.1
                products.append((foot - hip) * swing_m)
        self.assertLess(sum(products), 0.0)

    def test_keys_are_finite_and_rotations_are_of_unit_length(self):
        paths = {}
        for node, path, times, rows, interpolation in self.walk.channels:
            paths.setdefault((path, interpolation), []).append(node)
            self.assertEqual(times[0], 0.0)
            self.assertTrue(all(math.isfinite(value) for row in rows for value in row))
            if path == "rotation":
                self.assertTrue(all(abs(math.hypot(*row) - 1.0) < 1e-6 for row in rows))
                # Neighbouring keys are not of opposite sign.
                self.assertTrue(all(sum(map(lambda p, q: p * q, a, b)) > 0.0 for a, b in zip(rows, rows[1:])))
        rotating = paths["rotation", "LINEAR"] + paths["rotation", "STEP"]
        self.assertEqual(sorted(rotating), sorted(self.skin["joints"]))
        self.assertEqual(paths["translation", "CUBICSPLINE"], [self.find_node("Hips")])
        self.assertEqual(paths["translation", "LINEAR"], [self.find_node("Root")])
        self.assertEqual(paths["weights", "LINEAR"], [self.find_node("Flag")])

    def test_tangents_of_the_hips_follow_their_path(self):
        _node, _path, times, rows, _interpolation = next(channel for channel in self.walk.channels if channel[4] == "CUBICSPLINE")
        values = rows[1::3]
        for index in range(1, len(times) - 1):
            self.assertEqual(rows[3 * index], rows[3 * index + 2])
            for axis in (0, 1):
                slope = (values[index + 1][axis] - values[index - 1][axis]) / (times[index + 1] - times[index - 1])
                tangent = rows[3 * index][axis]
                self.assertGreaterEqual(slope * tangent, -1e-6)
                self.assertLess(abs(tangent - slope), 0.6 * abs(tangent) + 1e-5)

    def test_the_file_is_small(self):
        self.assertLess(len(self.binary), MAX_BYTES)


class Flag(Courtyard):
    def test_deltas_are_finite_and_the_edge_at_the_pole_stays(self):
        targets = self.get_primitive("Flag")["targets"]
        self.assertEqual(len(targets), 3)
        points = self.read("Flag", "POSITION")
        at_pole = [index for index, point in enumerate(points) if point[0] == 0.0]
        self.assertEqual(len(at_pole), flag_shapes.ROWS + 1)
        for target in targets:
            self.assertEqual(set(target), {"POSITION", "NORMAL"})
            for rows in (self.rest.read(accessor) for accessor in target.values()):
                self.assertEqual(len(rows), len(points))
                self.assertTrue(all(math.isfinite(value) for row in rows for value in row))
            deltas = self.rest.read(target["POSITION"])
            self.assertTrue(all(deltas[index] == (0.0, 0.0, 0.0) for index in at_pole))
            self.assertGreater(max(math.hypot(*delta) for delta in deltas), 0.05)

    def test_a_target_s_normals_are_those_of_its_surface(self):
        primitive = self.get_primitive("Flag")
        triangles = self.read_triangles("Flag")
        for target in primitive["targets"]:
            points = [gltf_writer.add(a, b) for a, b in zip(self.read("Flag", "POSITION"), self.rest.read(target["POSITION"]))]
            normals = [gltf_writer.add(a, b) for a, b in zip(self.read("Flag", "NORMAL"), self.rest.read(target["NORMAL"]))]
            for a, b, c in triangles:
                face = gltf_writer.cross(gltf_writer.subtract(points[b], points[a]), gltf_writer.subtract(points[c], points[a]))
                for index in (a, b, c):
                    self.assertAlmostEqual(math.hypot(*normals[index]), 1.0, places=5)
                    self.assertGreater(gltf_writer.dot(gltf_writer.normalize(face), normals[index]), 0.9)

    def test_it_is_an_open_double_sided_mesh(self):
        material = self.gltf["materials"][self.get_primitive("Flag")["material"]]
        self.assertTrue(material["doubleSided"])
        self.assertEqual(len(self.read_triangles("Flag")), 2 * flag_shapes.COLUMNS * flag_shapes.ROWS)


class Checks(unittest.TestCase):
    """Tests of the writer of animations and of gltf_pose, on which the tests above depend."""

    def test_a_channel_with_too_few_values_or_times_that_fall_is_refused(self):
        document = gltf_writer.Document(1.0)
        for times, values, interpolation, text in (
            ((0.0, 1.0), [(0.0,) * 3], "LINEAR", "1 values at 2 times"),
            ((0.0, 1.0), [(0.0,) * 3] * 2, "CUBICSPLINE", "2 values at 2 times"),
            ((1.0, 0.0), [(0.0,) * 3] * 2, "STEP", "do not rise"),
        ):
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                channel = gltf_animation.Channel(0, "translation", times, values, interpolation)
                gltf_animation.add_animation(document, "broken", [channel])

    def test_interpolation_is_that_of_the_specification(self):
        # Half of a rotation by 180 degrees about the y axis.
        half = math.sqrt(0.5)
        rotations = [(0.0, 0.0, 0.0, 1.0), (0.0, -1.0, 0.0, 0.0)]
        turned = gltf_pose.interpolate([0.0, 2.0], rotations, "LINEAR", is_rotation=True, time=1.0)
        self.assertAlmostEqual(abs(turned[1]), half)
        self.assertAlmostEqual(abs(turned[3]), half)
        rows = [(0.0,), (1.0,), (2.0,), (2.0,), (5.0,), (0.0,)]  # the line 1 + 2 t has the tangent 2 everywhere
        value = gltf_pose.interpolate([0.0, 2.0], rows, "CUBICSPLINE", is_rotation=False, time=0.5)
        self.assertAlmostEqual(value[0], 2.0)
        rows = [(3.0,), (4.0,)]
        value = gltf_pose.interpolate([0.0, 2.0], rows, "STEP", is_rotation=False, time=1.9)
        self.assertEqual(value, (3.0,))
        value = gltf_pose.interpolate([0.0, 2.0], rows, "LINEAR", is_rotation=False, time=1.0)
        self.assertEqual(value, (3.5,))


if __name__ == "__main__":
    unittest.main()
