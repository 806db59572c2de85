"""A textured model of five meshes, and files in which many nodes share these meshes."""

import base64
import json
import math
import os
import random
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from gltf_writer import encode_png  # noqa: E402

MESH_COUNT = 5
TRIANGLE_COUNT = 16000
TEXTURE_PX = 256
IS_MASK = (False, True, False, True, False)  # by mesh: whether its alpha is a mask


def make_png(generator, size_px, is_mask):
    """Return an RGBA PNG of noise that does not compress well; the alpha of a mask has round holes."""
    rows = []
    holes = [(generator.uniform(0, size_px), generator.uniform(0, size_px), generator.uniform(3, 9)) for _ in range(24)]
    for y in range(size_px):
        row = bytearray()
        for x in range(size_px):
            alpha = 255
            if is_mask:
                depth = min(math.hypot(x - hole_x, y - hole_y) - radius for hole_x, hole_y, radius in holes)
                alpha = round(255 * min(max(0.5 + 0.5 * depth, 0.0), 1.0))
            row += bytes((generator.randrange(256), generator.randrange(256), generator.randrange(256), alpha))
        rows.append(bytes(row))
    return encode_png(size_px, size_px, rows)


def make_part(generator, columns, rows):
    """Return positions, normals, texture coordinates and indices of a bumpy torus."""
    radius, height = generator.uniform(0.35, 0.5), generator.uniform(-0.4, 0.4)
    waves = [(generator.randrange(2, 7), generator.uniform(0, math.tau), generator.uniform(0.01, 0.05)) for _ in range(3)]
    positions, normals, uvs, indices = [], [], [], []
    for row in range(rows + 1):
        for column in range(columns + 1):
            u, v = math.tau * (column % columns) / columns, math.tau * (row % rows) / rows
            tube = 0.12 + sum(depth * math.sin(count * u + phase + v) for count, phase, depth in waves) * 0.5
            x, y, z = (radius + tube * math.cos(v)) * math.cos(u), height + tube * math.sin(v), (radius + tube * math.cos(v)) * math.sin(u)
            positions.append((x, y, z))
            normals.append((math.cos(u) * math.cos(v), math.sin(v), math.sin(u) * math.cos(v)))
            uvs.append((2 * column / columns, row / rows))
    for row in range(rows):
        for column in range(columns):
            a, b = row * (columns + 1) + column, (row + 1) * (columns + 1) + column
            indices += [a, b, a + 1, a + 1, b, b + 1]
    return positions, normals, uvs, indices


def write_copies(path, copy_count, seed=1):
    """Write a .gltf with that many copies of the model above a ground, each of five nodes; all copies share the meshes.

    Every third copy is mirrored, every fifth is stretched along one axis, and one in seven is ten times as large, so that its cut-outs get
    another level of detail.
    """
    generator = random.Random(seed)
    binary = bytearray()
    root = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "textures": [],
        "images": [], "accessors": [], "bufferViews": [], "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "directional", "name": "Sun", "intensity": 3, "extras": {"light_angular_distance": 2.0}}]}},
    }  # fmt: skip

    def add_accessor(kind, code, component_type, values):
        flat = [number for value in values for number in value]
        root["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": 4 * len(flat)})
        binary.extend(struct.pack("<%d%s" % (len(flat), code), *flat))
        accessor = {"bufferView": len(root["bufferViews"]) - 1, "componentType": component_type, "count": len(values), "type": kind}
        if kind == "VEC3":
            accessor["min"], accessor["max"] = ([pick(column) for column in zip(*values)] for pick in (min, max))
        root["accessors"].append(accessor)
        return len(root["accessors"]) - 1

    def add_mesh(positions, normals, uvs, indices, material):
        attributes = {"POSITION": add_accessor("VEC3", "f", 5126, positions), "NORMAL": add_accessor("VEC3", "f", 5126, normals)}
        attributes["TEXCOORD_0"] = add_accessor("VEC2", "f", 5126, uvs)
        primitive = {"attributes": attributes, "indices": add_accessor("SCALAR", "I", 5125, [(index,) for index in indices])}
        root["meshes"].append({"primitives": [{**primitive, "material": material}]})
        return len(root["meshes"]) - 1

    def add_node(**members):
        root["scenes"][0]["nodes"].append(len(root["nodes"]))
        root["nodes"].append(members)

    columns = 80
    for is_mask in IS_MASK:
        png = make_png(generator, TEXTURE_PX, is_mask)
        root["images"].append({"uri": "data:image/png;base64," + base64.b64encode(png).decode()})
        index = len(root["images"]) - 1
        root["textures"].append({"source": index})
        material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}}
        root["materials"].append({**material, **({"alphaMode": "MASK", "doubleSided": True} if is_mask else {})})
        add_mesh(*make_part(generator, columns, TRIANGLE_COUNT // MESH_COUNT // 2 // columns), index)
    root["materials"].append({})
    corners = [(-1.0, 0.0, -1.0), (-1.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 0.0, -1.0)]
    ground = add_mesh(corners, [(0.0, 1.0, 0.0)] * 4, [(0.0, 0.0)] * 4, [0, 1, 2, 0, 2, 3], MESH_COUNT)
    side = math.ceil(math.sqrt(copy_count))
    for copy in range(copy_count):
        scale = 1.0 if copy % 7 != 6 else 10.0
        scales = [scale * (-1.0 if copy % 3 == 1 else 1.0), scale * (2.0 if copy % 5 == 4 else 1.0), scale]
        angle = generator.uniform(0, math.tau)
        position = [2.5 * (copy % side - 0.5 * (side - 1)), 0.8 * scale, 2.5 * (copy // side - 0.5 * (side - 1))]
        for mesh in range(MESH_COUNT):
            add_node(name="Copy %d.%d" % (copy, mesh), mesh=mesh, translation=position, scale=scales,
                     rotation=[0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2)])  # fmt: skip
    add_node(name="Ground", mesh=ground, scale=[2.0 * side, 1.0, 2.0 * side])
    add_node(name="Camera", camera=0, translation=[0.0, 2.2 * side, 2.4 * side], rotation=[-0.38, 0.0, 0.0, 0.925])
    add_node(name="Sun", rotation=[-0.5, 0.2, 0.1, 0.836660027], extensions={"KHR_lights_punctual": {"light": 0}})
    uri = "data:application/octet-stream;base64," + base64.b64encode(bytes(binary)).decode()
    root["buffers"] = [{"byteLength": len(binary), "uri": uri}]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(root, file)
