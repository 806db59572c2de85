"""Meshes and a small glTF 2.0 writer for the demo scenes. Standard library only, because the demo needs none of Python.

A mesh is checked before it is written. No triangle has two corners at one position. Unless is_manifold is False, the mesh is
an oriented 2-manifold after welding by position; if is_closed is True as well, it is closed and its faces point outward.
"""

import json
import math
import os
import struct
import zlib

UINT8 = 5121  # glTF component types
UINT32 = 5125
FLOAT = 5126
PACKING = {UINT8: "B", UINT32: "I", FLOAT: "f"}
ARRAY_BUFFER = 34962
ELEMENT_ARRAY_BUFFER = 34963


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, factor):
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    length = math.sqrt(dot(a, a))
    if length == 0.0:
        raise ValueError("a vector of length zero has no direction")
    return scale(a, 1.0 / length)


def to_float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def quaternion_about(axis, angle_rad):
    """Return x, y, z, w of a right-handed rotation about an axis of any length."""
    x, y, z = scale(normalize(axis), math.sin(0.5 * angle_rad))
    return (x, y, z, math.cos(0.5 * angle_rad))


def quaternion_from_y(direction):
    """Return the shortest rotation that takes +Y to the direction, which must not be -Y."""
    d = normalize(direction)
    x, y, z, w = d[2], 0.0, -d[0], 1.0 + d[1]
    length = math.sqrt(x * x + y * y + z * z + w * w)
    return (x / length, y / length, z / length, w / length)


def quaternion_from_axes(right, up, back):
    """Return the rotation that takes +X, +Y and +Z to three perpendicular unit vectors."""
    m = ((right[0], up[0], back[0]), (right[1], up[1], back[1]), (right[2], up[2], back[2]))
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0.0:
        s = 2.0 * math.sqrt(1.0 + trace)
        return ((m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, 0.25 * s)
    i = max(range(3), key=lambda axis: m[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2.0 * math.sqrt(1.0 + m[i][i] - m[j][j] - m[k][k])
    result = [0.0, 0.0, 0.0, (m[k][j] - m[j][k]) / s]
    result[i] = 0.25 * s
    result[j] = (m[j][i] + m[i][j]) / s
    result[k] = (m[k][i] + m[i][k]) / s
    return tuple(result)


def quaternion_look_at(eye, target):
    """Return the rotation that takes -Z to the direction of the target and keeps +Y upward, for glTF cameras and lights."""
    back = normalize(subtract(eye, target))
    right = normalize(cross((0.0, 1.0, 0.0), back))
    return quaternion_from_axes(right, cross(back, right), back)


def multiply_quaternions(a, b):
    """Return the rotation b followed by a."""
    x, y, z = add(add(scale(b, a[3]), scale(a, b[3])), cross(a, b))
    return (x, y, z, a[3] * b[3] - dot(a, b))


def invert_quaternion(a):
    """Invert a rotation; a must have unit length."""
    return (-a[0], -a[1], -a[2], a[3])


def rotate(quaternion, v):
    x, y, z, w = quaternion
    t = scale(cross((x, y, z), v), 2.0)
    return add(add(v, scale(t, w)), cross((x, y, z), t))


def encode_png(width, height, rows):
    """Return the bytes of an RGBA PNG. rows: bytes of red, green, blue and alpha, from the top."""

    def make_chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    lines = b"".join(b"\0" + bytes(row) for row in rows)
    return b"\x89PNG\r\n\x1a\n" + make_chunk(b"IHDR", header) + make_chunk(b"IDAT", zlib.compress(lines, 9)) + make_chunk(b"IEND", b"")


class Mesh:
    """Positions, normals and triangles; values are rounded to float32 when they are added. uvs: empty, or one per vertex.

    joints, weights: empty, or four per vertex, of the node's skin. targets: (name, position deltas, normal deltas), a delta per
    vertex.
    """

    def __init__(self, is_closed=True, is_manifold=True):
        self.positions = []
        self.normals = []
        self.uvs = []
        self.joints = []
        self.weights = []
        self.targets = []
        self.triangles = []
        self.is_closed = is_closed
        self.is_manifold = is_manifold

    def add_vertex(self, position, normal, uv=None):
        if uv is not None:
            self.uvs.append(tuple(to_float32(value) for value in uv))
        self.positions.append(tuple(to_float32(value) for value in position))
        self.normals.append(tuple(to_float32(value) for value in normalize(normal)))
        return len(self.positions) - 1

    def add_triangle(self, a, b, c):
        self.triangles.append((a, b, c))

    def add_quad(self, a, b, c, d):
        self.triangles += [(a, b, c), (a, c, d)]

    def add_mesh(self, other, rotation=(0.0, 0.0, 0.0, 1.0), translation=(0.0, 0.0, 0.0)):
        """Append a copy that is rotated, then translated. Joints, weights and morph targets are not copied."""
        first = len(self.positions)
        for position, normal in zip(other.positions, other.normals):
            self.add_vertex(add(rotate(rotation, position), translation), rotate(rotation, normal))
        self.uvs += other.uvs
        self.triangles += [(a + first, b + first, c + first) for a, b, c in other.triangles]

    def set_smooth_normals(self):
        """Set each vertex's normal to the mean of its faces' normals, weighted by area."""
        sums = [(0.0, 0.0, 0.0)] * len(self.positions)
        for a, b, c in self.triangles:
            origin = self.positions[a]
            area_normal = cross(subtract(self.positions[b], origin), subtract(self.positions[c], origin))
            for index in (a, b, c):
                sums[index] = add(sums[index], area_normal)
        self.normals = [tuple(to_float32(value) for value in normalize(total)) for total in sums]

    def check(self, name):
        """Raise a ValueError that names the mesh if it lacks the properties listed at the top of this file."""
        welded = {}
        ids = [welded.setdefault(position, len(welded)) for position in self.positions]
        points = list(welded)
        parent = list(range(len(points)))
        deltas = [vectors for _name, *pair in self.targets for vectors in pair]
        for values in (self.uvs, self.joints, self.weights, *deltas):
            if values and len(values) != len(self.positions):
                raise ValueError("mesh %s: %d values for %d vertices" % (name, len(values), len(self.positions)))

        def find(index):
            while parent[index] != index:
                parent[index] = parent[parent[index]]
                index = parent[index]
            return index

        directed = {}
        for triangle in self.triangles:
            a, b, c = (ids[index] for index in triangle)
            if len({a, b, c}) < 3:
                raise ValueError("mesh %s: triangle %s has no area: two of its corners coincide" % (name, triangle))
            for edge in ((a, b), (b, c), (c, a)):
                directed[edge] = directed.get(edge, 0) + 1
                parent[find(edge[0])] = find(edge[1])
        if not self.is_manifold:
            return
        for (a, b), count in directed.items():
            if count > 1:
                raise ValueError("mesh %s: edge %s-%s is run %d times in one direction" % (name, points[a], points[b], count))
            if self.is_closed and (b, a) not in directed:
                raise ValueError("mesh %s: edge %s-%s has one face only, so it is not closed" % (name, points[a], points[b]))
        if not self.is_closed:
            return
        volumes = {}
        for triangle in self.triangles:
            a, b, c = (points[ids[index]] for index in triangle)
            part = find(ids[triangle[0]])
            volumes[part] = volumes.get(part, 0.0) + dot(a, cross(b, c)) / 6.0
        if min(volumes.values()) <= 0.0:
            raise ValueError("mesh %s: a part has volume %g, so its faces look inward" % (name, min(volumes.values())))


class Document:
    """A glTF document in memory: the JSON, the binary buffer and the images."""

    def __init__(self, scene_size_m):
        self.binary = bytearray()
        self.images = {}  # file name -> bytes
        self.root = {
            "asset": {"version": "2.0", "generator": "Gnomon make_scenes.py"},
            "extensionsUsed": ["KHR_lights_punctual"],
            "scene": 0,
            "scenes": [{"name": "Scene", "nodes": [], "extras": {"scene_size": scene_size_m}}],
            "nodes": [],
            "cameras": [],
            "materials": [],
            "meshes": [],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
            "extensions": {"KHR_lights_punctual": {"lights": []}},
        }

    def _add_view(self, data, target):
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self.root["bufferViews"].append(view)
        self.binary += data
        return len(self.root["bufferViews"]) - 1

    def add_accessor(self, rows, kind, component_type=FLOAT, target=None, has_bounds=False):
        """Add an accessor, return its index. rows: a tuple per element, float32 if has_bounds. kind: SCALAR, VEC3, MAT4 ..."""
        flat = [value for row in rows for value in row]
        accessor = {
            "bufferView": self._add_view(struct.pack("<%d%s" % (len(flat), PACKING[component_type]), *flat), target),
            "componentType": component_type,
            "count": len(rows),
            "type": kind,
        }
        if has_bounds:
            accessor["min"] = [min(column) for column in zip(*rows)]
            accessor["max"] = [max(column) for column in zip(*rows)]
        self.root["accessors"].append(accessor)
        return len(self.root["accessors"]) - 1

    def _add_vectors(self, vectors, has_bounds=False, component_type=FLOAT):
        return self.add_accessor(vectors, "VEC%d" % len(vectors[0]), component_type, ARRAY_BUFFER, has_bounds)

    def add_material(self, name, color, roughness=0.7, metallic=0.0, is_double_sided=False, extras=None):
        """Add a material, return its index. color: linear RGB. extras: scatter, scatter_distance, shading_model."""
        material = {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [color[0], color[1], color[2], 1.0],
                "metallicFactor": metallic,
                "roughnessFactor": roughness,
            },
        }
        if is_double_sided:
            material["doubleSided"] = True
        if extras:
            material["extras"] = extras
        self.root["materials"].append(material)
        return len(self.root["materials"]) - 1

    def add_texture(self, file_name, png):
        """Add a texture with an image file next to the scene, return its index. It repeats, and gnomon filters it linearly."""
        self.images[file_name] = png
        for members, value in (("samplers", {}), ("images", {"uri": file_name})):
            self.root.setdefault(members, []).append(value)
        index = len(self.root["images"]) - 1
        self.root.setdefault("textures", []).append({"sampler": index, "source": index})
        return index

    def set_texture(self, material, texture, is_cut_out=False):
        """Set the base colour texture. Its alpha cuts holes if is_cut_out."""
        written = self.root["materials"][material]
        written["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
        if is_cut_out:
            written["alphaMode"] = "MASK"

    def add_glass(self, name, color, transmission, thickness_m=0.0, attenuation_color=None, attenuation_distance_m=None):
        """Add a material with KHR_materials_transmission, and KHR_materials_volume if it has a thickness; return its index."""
        index = self.add_material(name, color, roughness=0.1)
        extensions = {"KHR_materials_transmission": {"transmissionFactor": transmission}}
        if thickness_m > 0.0:
            extensions["KHR_materials_volume"] = {
                "thicknessFactor": thickness_m,
                "attenuationColor": list(attenuation_color),
                "attenuationDistance": attenuation_distance_m,
            }
        self.root["materials"][index]["extensions"] = extensions
        for extension in extensions:
            if extension not in self.root["extensionsUsed"]:
                self.root["extensionsUsed"].append(extension)
        return index

    def add_mesh(self, name, mesh, material):
        mesh.check(name)
        attributes = {"POSITION": self._add_vectors(mesh.positions, has_bounds=True), "NORMAL": self._add_vectors(mesh.normals)}
        if mesh.uvs:
            attributes["TEXCOORD_0"] = self._add_vectors(mesh.uvs)
        if mesh.joints:
            attributes["JOINTS_0"] = self._add_vectors(mesh.joints, component_type=UINT8)
            attributes["WEIGHTS_0"] = self._add_vectors(mesh.weights)
        indices = self.add_accessor([(index,) for triangle in mesh.triangles for index in triangle], "SCALAR", UINT32, ELEMENT_ARRAY_BUFFER)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        written = {"name": name, "primitives": [primitive]}
        if mesh.targets:
            primitive["targets"] = [
                {"POSITION": self._add_vectors(positions, has_bounds=True), "NORMAL": self._add_vectors(normals)}
                for _name, positions, normals in mesh.targets
            ]
            written["extras"] = {"targetNames": [target_name for target_name, *_deltas in mesh.targets]}
        self.root["meshes"].append(written)
        return len(self.root["meshes"]) - 1

    def add_node(self, name, translation=None, rotation=None, parent=None, **members):
        """Add a node, return its index. parent: a node's index, None for the scene. members: further glTF members."""
        node = {"name": name}
        if translation is not None:
            node["translation"] = list(translation)
        if rotation is not None:
            # Nine digits, so that rounding errors of sin and cos do not change the file.
            node["rotation"] = [round(value, 9) + 0.0 for value in rotation]
        node.update(members)
        self.root["nodes"].append(node)
        index = len(self.root["nodes"]) - 1
        if parent is None:
            self.root["scenes"][0]["nodes"].append(index)
        else:
            self.root["nodes"][parent].setdefault("children", []).append(index)
        return index

    def add_object(self, name, mesh, material, translation=None, rotation=None, **members):
        """Add a mesh and a node with it; return the node's index."""
        return self.add_node(name, translation, rotation, mesh=self.add_mesh(name, mesh, material), **members)

    def add_camera(self, name, eye, target, vertical_fov_rad):
        self.root["cameras"].append(
            {
                "name": name,
                "type": "perspective",
                "perspective": {"yfov": round(vertical_fov_rad, 9), "znear": 0.05, "aspectRatio": 1.0},
            }
        )
        index = len(self.root["cameras"]) - 1
        self.add_node(name, eye, quaternion_look_at(eye, target), camera=index)

    def add_light(self, name, light, eye, target, extras):
        """Add a light and its node. light: type, intensity, color, spot as in KHR_lights_punctual."""
        lights = self.root["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"name": name, **light, "extras": extras})
        extension = {"KHR_lights_punctual": {"light": len(lights) - 1}}
        rotation = None if light["type"] == "point" else quaternion_look_at(eye, target)
        self.add_node(name, eye, rotation, extensions=extension)

    def build_files(self, stem, binary_stem=None):
        """Map the names of the .gltf, the .bin and the images to their bytes; scenes of the same meshes may share the .bin."""
        binary = (binary_stem or stem) + ".bin"
        self.root["buffers"] = [{"uri": binary, "byteLength": len(self.binary)}]
        text = json.dumps(self.root, indent="\t", allow_nan=False) + "\n"
        return {stem + ".gltf": text.encode("utf-8"), binary: bytes(self.binary), **self.images}


def save_files(files, folder):
    """Write the files. Each is written under another name and renamed, so that no file is ever incomplete."""
    os.makedirs(folder, exist_ok=True)
    for name, data in sorted(files.items()):
        path = os.path.join(folder, name)
        with open(path + ".new", "wb") as file:
            file.write(data)
        os.replace(path + ".new", path)
