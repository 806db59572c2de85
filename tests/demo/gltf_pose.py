"""Computes nodes and vertices of a glTF file at a time of its animation, in double precision, with the standard library only.

Follows the glTF 2.0 specification: section 3.7.3 (skins), 3.7.2.2 (morph targets) and appendix C (interpolation). Expects
valid files.
"""

import math
import struct

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
FORMATS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
REST = {"translation": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0, 1.0), "scale": (1.0, 1.0, 1.0)}


def read_accessor(gltf, binary, index):
    """Return one tuple per element."""
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    size, code = COMPONENTS[accessor["type"]], FORMATS[accessor["componentType"]]
    flat = struct.unpack_from("<%d%s" % (size * accessor["count"], code), binary, view["byteOffset"] + accessor.get("byteOffset", 0))
    return [flat[first : first + size] for first in range(0, len(flat), size)]


def find_named(items, name):
    """Return the index of the only item with the name."""
    (index,) = (index for index, item in enumerate(items) if item.get("name") == name)
    return index


def multiply(a, b):
    """Multiply two column-major 4 x 4 matrices."""
    return tuple(sum(a[4 * k + row] * b[4 * column + k] for k in range(4)) for column in range(4) for row in range(4))


def transform(matrix, point):
    x, y, z = point
    return tuple(matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row] for row in range(3))


def compose(translation, rotation, scale):
    x, y, z, w = rotation
    columns = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
        (2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)),
        (2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)),
    )
    rotated_axes = tuple(value * factor for column, factor in zip(columns, scale) for value in (*column, 0.0))
    return rotated_axes + (*translation, 1.0)


def interpolate_rotations(a, b, fraction):
    """Interpolate quaternions along the shorter arc (appendix C.4)."""
    cosine = sum(p * q for p, q in zip(a, b))
    sign = -1.0 if cosine < 0.0 else 1.0
    angle = math.acos(min(abs(cosine), 1.0))
    if angle < 1e-9:  # below, sin(angle) is a divisor
        return a
    first, second = math.sin((1.0 - fraction) * angle), sign * math.sin(fraction * angle)
    return tuple((first * p + second * q) / math.sin(angle) for p, q in zip(a, b))


def normalize(values):
    length = math.sqrt(sum(value * value for value in values))
    return tuple(value / length for value in values)


def interpolate(times, rows, interpolation, is_rotation, time):
    """Return the value at `time` (s), which is the first or last key's outside of `times`.

    rows: the value of each key, or for CUBICSPLINE its in-tangent, value and out-tangent.
    """
    is_cubic = interpolation == "CUBICSPLINE"
    values = rows[1::3] if is_cubic else rows
    if time <= times[0]:
        return values[0]
    if time >= times[-1]:
        return values[-1]
    index = max(i for i, key in enumerate(times) if key <= time)
    width = times[index + 1] - times[index]
    fraction = (time - times[index]) / width
    before, after = values[index], values[index + 1]
    if interpolation == "STEP":
        return before
    if is_cubic:
        t2, t3 = fraction * fraction, fraction**3
        factors = (2.0 * t3 - 3.0 * t2 + 1.0, width * (t3 - 2.0 * t2 + fraction), 3.0 * t2 - 2.0 * t3, width * (t3 - t2))
        parts = zip(before, rows[3 * index + 2], after, rows[3 * index + 3])
        row = tuple(sum(factor * value for factor, value in zip(factors, part)) for part in parts)
        return normalize(row) if is_rotation else row
    if is_rotation:
        return interpolate_rotations(before, after, fraction)
    return tuple((1.0 - fraction) * p + fraction * q for p, q in zip(before, after))


class Poser:
    """A glTF file and one of its animations. Without an animation everything is in the rest pose."""

    def __init__(self, gltf, binary, animation=None):
        self.gltf = gltf
        self.binary = binary
        self.channels = []
        self.cache = {}
        if animation is not None:
            written = gltf["animations"][find_named(gltf["animations"], animation)]
            for channel in written["channels"]:
                sampler = written["samplers"][channel["sampler"]]
                target, times = channel["target"], [time for (time,) in self.read(sampler["input"])]
                rows = self.read(sampler["output"])
                if target["path"] == "weights":
                    rows_per_key = 3 if sampler.get("interpolation") == "CUBICSPLINE" else 1
                    target_count = len(rows) // len(times) // rows_per_key
                    firsts = range(0, len(rows), target_count)
                    rows = [tuple(value for (value,) in rows[first : first + target_count]) for first in firsts]
                self.channels.append((target["node"], target["path"], times, rows, sampler.get("interpolation", "LINEAR")))

    def read(self, accessor):
        if accessor not in self.cache:
            self.cache[accessor] = read_accessor(self.gltf, self.binary, accessor)
        return self.cache[accessor]

    def get_duration(self):
        return max(times[-1] for _node, _path, times, _rows, _interpolation in self.channels)

    def compute_values(self, time):
        """Map (node, path) to the value that the animation sets."""
        return {
            (node, path): interpolate(times, rows, interpolation, path == "rotation", time)
            for node, path, times, rows, interpolation in self.channels
        }

    def compute_matrices(self, values):
        """Return node index -> world matrix."""
        matrices = {}

        def visit(index, parent_matrix):
            node = self.gltf["nodes"][index]
            if "matrix" in node:
                local = tuple(node["matrix"])
            else:
                local = compose(*(values.get((index, path), node.get(path, rest)) for path, rest in REST.items()))
            matrices[index] = multiply(parent_matrix, local)
            for child in node.get("children", ()):
                visit(child, matrices[index])

        for root in self.gltf["scenes"][self.gltf.get("scene", 0)]["nodes"]:
            visit(root, IDENTITY)
        return matrices

    def compute_points(self, node_index, time):
        """Return the world positions of the vertices of a node's first primitive."""
        values = self.compute_values(time)
        matrices = self.compute_matrices(values)
        node = self.gltf["nodes"][node_index]
        mesh = self.gltf["meshes"][node["mesh"]]
        primitive = mesh["primitives"][0]
        points = self.read(primitive["attributes"]["POSITION"])
        targets = primitive.get("targets", ())
        weights = values.get((node_index, "weights"), node.get("weights", mesh.get("weights", (0.0,) * len(targets))))
        for weight, target in zip(weights, targets):
            deltas = self.read(target["POSITION"])
            points = [tuple(p + weight * d for p, d in zip(point, delta)) for point, delta in zip(points, deltas)]
        if "skin" not in node:
            return [transform(matrices[node_index], point) for point in points]
        skin = self.gltf["skins"][node["skin"]]
        joint_matrices = [multiply(matrices[joint], bind) for joint, bind in zip(skin["joints"], self.read(skin["inverseBindMatrices"]))]
        result = []
        attributes = primitive["attributes"]
        for point, joints, joint_weights in zip(points, self.read(attributes["JOINTS_0"]), self.read(attributes["WEIGHTS_0"])):
            moved = [(fraction, transform(joint_matrices[joint], point)) for joint, fraction in zip(joints, joint_weights) if fraction > 0.0]
            result.append(tuple(sum(fraction * position[axis] for fraction, position in moved) for axis in range(3)))
        return result
