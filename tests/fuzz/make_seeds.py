#!/usr/bin/env python3
"""Writes seeds of fuzz targets into a folder.

    make_seeds.py scenes SCENE... FOLDER   target gltf: reduced scenes
    make_seeds.py textures FOLDER          target gltf: a card with images of every kind, valid and broken
    make_seeds.py motion FOLDER            target gltf: cards that skins, morph targets and animations move
    make_seeds.py cut_mesh FOLDER          target cut_mesh: meshes, materials and masks

Each .gltf or .glb scene becomes FOLDER/<name>.gltf, with its buffer inside, and FOLDER/<name>.glb: they have
the file's whole structure, but only a few elements per accessor, so that mutations hit the structure. Images are dropped,
because the cards have them.
"""

import base64
import json
import os
import struct
import sys

import seed_images

# componentType of glTF.
BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
COMPONENT_BYTES = {BYTE: 1, UNSIGNED_BYTE: 1, SHORT: 2, UNSIGNED_SHORT: 2, UNSIGNED_INT: 4, FLOAT: 4}
INDEX_FORMATS = {UNSIGNED_BYTE: "B", UNSIGNED_SHORT: "<H", UNSIGNED_INT: "<I"}  # of struct
TYPE_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MAX_VERTEX_COUNT = 4  # of a reduced accessor
MAX_INDEX_COUNT = 6


def read_scene(path):
    """Return (JSON, bytes of each buffer)."""
    with open(path, "rb") as file:
        data = file.read()
    chunk = None
    if data[:4] == b"glTF":  # a header of 12 bytes, then the chunks JSON and BIN, each with a header of 8
        length = struct.unpack_from("<I", data, 12)[0]
        chunk = data[20 + length + 8 :]
        data = data[20 : 20 + length]
    document = json.loads(data)
    buffers = []
    for buffer in document.get("buffers", []):
        uri = buffer.get("uri")
        if uri is None:
            buffers.append(chunk)
        elif uri.startswith("data:"):
            buffers.append(base64.b64decode(uri.split(",", 1)[1]))
        else:
            with open(os.path.join(os.path.dirname(path), uri), "rb") as file:
                buffers.append(file.read())
    return document, buffers


def find_index_accessors(document):
    return {
        primitive["indices"]
        for mesh in document.get("meshes", [])
        for primitive in mesh["primitives"]
        if "indices" in primitive
    }


def shrink(document, buffers):
    """Cut every accessor to its first elements, put them into one buffer, and remove the images. Return the buffer's bytes."""
    indices = find_index_accessors(document)
    packed = bytearray()
    views = []
    for number, accessor in enumerate(document.get("accessors", [])):
        view = document["bufferViews"][accessor["bufferView"]]
        component_bytes = COMPONENT_BYTES[accessor["componentType"]]
        element_bytes = component_bytes * TYPE_COUNTS[accessor["type"]]
        stride = view.get("byteStride", element_bytes)
        first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        count = min(accessor["count"], MAX_INDEX_COUNT if number in indices else MAX_VERTEX_COUNT)
        source = buffers[view["buffer"]]
        elements = [source[first + i * stride :][:element_bytes] for i in range(count)]
        if number in indices:
            letter = INDEX_FORMATS[accessor["componentType"]]
            elements = [struct.pack(letter, struct.unpack(letter, e)[0] % MAX_VERTEX_COUNT) for e in elements]
        views.append({"buffer": 0, "byteOffset": len(packed), "byteLength": count * element_bytes})
        packed += b"".join(elements)
        packed += bytes(-len(packed) % 4)
        accessor.update({"bufferView": number, "count": count, "byteOffset": 0})
    if views:
        document["bufferViews"] = views
    document.pop("images", None)
    document.pop("textures", None)
    return bytes(packed)


def build_glb(document, packed):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text
    if packed:
        body += struct.pack("<I4s", len(packed), b"BIN\0") + packed
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def write_both(document, packed, name):
    """Write name.glb and name.gltf; both contain the buffer."""
    if packed:
        document["buffers"] = [{"byteLength": len(packed)}]
    with open(name + ".glb", "wb") as file:
        file.write(build_glb(document, packed))
    write_gltf(document, packed, name)


def write_gltf(document, packed, name):
    if packed:
        document["buffers"] = [{"byteLength": len(packed), "uri": make_data_uri("application/octet-stream", packed)}]
    with open(name + ".gltf", "w", encoding="utf-8") as file:
        json.dump(document, file, separators=(",", ":"))


def make_data_uri(media_type, data):
    return "data:%s;base64,%s" % (media_type, base64.b64encode(data).decode())


def write_scenes(paths, folder):
    for path in paths:
        document, buffers = read_scene(path)
        packed = shrink(document, buffers)
        write_both(document, packed, os.path.join(folder, os.path.splitext(os.path.basename(path))[0]))


# Values of a glTF sampler.
CLAMP, MIRROR, REPEAT = 33071, 33648, 10497
NEAREST, LINEAR = 9728, 9729
MIPMAP_FILTERS = (9984, 9985, 9986, 9987)


class Card:
    """A textured quad in front of a camera, with two sets of texture coordinates and vertex colours."""

    def __init__(self):
        self.packed = bytearray()
        self.document = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {}, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}],
            "images": [{}],
            "accessors": [],
            "bufferViews": [],
        }
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        floats = {
            "POSITION": [(x - 0.5, y - 0.5, 0) for x, y in corners],
            "TEXCOORD_0": [(2.5 * x - 1, 1 - y) for x, y in corners],
            "TEXCOORD_1": [(x / 2, y) for x, y in corners],
            "COLOR_0": [(1, x, y, 1 - x / 4) for x, y in corners],
        }
        for name, values in floats.items():
            data = b"".join(struct.pack("<%df" % len(value), *value) for value in values)
            self.primitive["attributes"][name] = self.add_accessor(data, FLOAT, "VEC%d" % len(values[0]), 4)
        self.primitive["indices"] = self.add_accessor(struct.pack("<6H", 0, 1, 2, 0, 2, 3), UNSIGNED_SHORT, "SCALAR", 6)

    @property
    def primitive(self):
        return self.document["meshes"][0]["primitives"][0]

    @property
    def material(self):
        return self.document["materials"][0]

    @property
    def base_color(self):
        return self.material["pbrMetallicRoughness"]["baseColorTexture"]

    def add_view(self, data):
        views = self.document["bufferViews"]
        views.append({"buffer": 0, "byteOffset": len(self.packed), "byteLength": len(data)})
        self.packed += data + bytes(-len(data) % 4)
        return len(views) - 1

    def add_accessor(self, data, component_type, kind, count):
        accessor = {"bufferView": self.add_view(data), "componentType": component_type, "type": kind, "count": count}
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def set_image(self, data, media_type, is_inside=True):
        """Set the image's data. is_inside: store it in a buffer view, else as a data URI."""
        self.document["images"][0] = (
            {"bufferView": self.add_view(data), "mimeType": media_type}
            if is_inside
            else {"uri": make_data_uri(media_type, data)}
        )

    def enable_alpha_mask(self, cutoff):
        self.material.update({"alphaMode": "MASK", "alphaCutoff": cutoff})


def make_masked_card():
    card = Card()
    card.set_image(seed_images.make_leaf_png(), "image/png")
    card.enable_alpha_mask(0.5)
    card.document["samplers"] = [
        {"wrapS": wrap, "wrapT": CLAMP, "magFilter": NEAREST if wrap == CLAMP else LINEAR, "minFilter": min_filter}
        for wrap in (MIRROR, CLAMP, REPEAT)
        for min_filter in (NEAREST, LINEAR, *MIPMAP_FILTERS)
    ]
    card.document["textures"][0]["sampler"] = 0
    return card


def make_blended_card():
    """A blended card with a texture transform, the second set of coordinates, and each kind of texture."""
    card = Card()
    card.set_image(seed_images.make_leaf_png(), "image/png", is_inside=False)
    transform = {"offset": [0.25, -1], "rotation": 0.7, "scale": [2, -1.5], "texCoord": 1}
    card.base_color.update({"texCoord": 1, "extensions": {"KHR_texture_transform": transform}})
    card.material.update({
        "alphaMode": "BLEND",
        "normalTexture": {"index": 0, "scale": 0.5},
        "occlusionTexture": {"index": 0, "texCoord": 1, "strength": 0.5},
        "emissiveTexture": {"index": 0},
        "emissiveFactor": [1, 0.5, 0],
        "doubleSided": True,
    })
    card.document["extensionsUsed"] = ["KHR_texture_transform"]
    return card


def make_transparent_card():
    card = Card()
    card.set_image(seed_images.make_jpeg(), "image/jpeg", is_inside=False)
    card.enable_alpha_mask(0.25)
    card.material["extensions"] = {
        "KHR_materials_transmission": {"transmissionFactor": 0.5},
        "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationDistance": 1, "attenuationColor": [1, 0.5, 0]},
    }
    return card


def make_card_of(image, media_type):
    card = Card()
    card.set_image(image, media_type)
    card.enable_alpha_mask(0.5)
    return card


def make_wrong_reference_card():
    """A card that refers to a sampler, an image and a texture that do not exist."""
    card = make_masked_card()
    card.document["textures"][0]["sampler"] = 99
    card.document["textures"].append({"source": 7})
    card.material["emissiveTexture"] = {"index": 1}
    card.material["occlusionTexture"] = {"index": 5}
    return card


def make_card_without_coordinates():
    """A card whose texture uses a set of coordinates that its mesh lacks, and no sampler."""
    card = make_masked_card()
    card.base_color["texCoord"] = 1
    del card.primitive["attributes"]["TEXCOORD_1"]
    del card.document["textures"][0]["sampler"]
    return card


def make_card_without_image():
    """A card whose image has neither uri nor bufferView, and whose second texture has no source."""
    card = Card()
    card.document["textures"].append({})
    card.material["emissiveTexture"] = {"index": 1}
    return card


def write_textures(folder):
    cards = {
        "card_mask": make_masked_card(),
        "card_blend": make_blended_card(),
        "card_transmission": make_transparent_card(),
        "card_jpeg_grey": make_card_of(seed_images.make_jpeg(1), "image/jpeg"),
        "card_wrong_references": make_wrong_reference_card(),
        "card_without_coordinates": make_card_without_coordinates(),
        "card_without_image": make_card_without_image(),
        "card_png_huge": make_card_of(seed_images.make_huge_png(), "image/png"),
        "card_png_truncated": make_card_of(seed_images.make_truncated_png(), "image/png"),
        "card_png_animated": make_card_of(seed_images.make_animated_png(), "image/png"),
        "card_jpeg_truncated": make_card_of(seed_images.make_truncated_jpeg(), "image/jpeg"),
        "card_gif_animated": make_card_of(seed_images.make_animated_gif(), "image/gif"),
        "card_webp_animated": make_card_of(seed_images.make_animated_webp(), "image/webp"),
    }
    for name, card in cards.items():
        path = os.path.join(folder, name)
        if name in ("card_mask", "card_blend"):
            write_both(card.document, bytes(card.packed), path)
        else:
            write_gltf(card.document, bytes(card.packed), path)


def add_skin(card, joint_sets):
    """Add a skin of two joints that both move each vertex. joint_sets: sets of four joints and weights per vertex."""
    corners = 4
    for number in range(joint_sets):
        joints = struct.pack("<16B", *(0, 1, 0, 1) * corners)
        weights = struct.pack("<16f", *(0.5, 0.25, 0.25, 0) * corners)
        card.primitive["attributes"]["JOINTS_%d" % number] = card.add_accessor(joints, UNSIGNED_BYTE, "VEC4", corners)
        card.primitive["attributes"]["WEIGHTS_%d" % number] = card.add_accessor(weights, FLOAT, "VEC4", corners)
    identity = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    inverse_binds = card.add_accessor(struct.pack("<32f", *identity * 2), FLOAT, "MAT4", 2)
    card.document["nodes"] += [{"children": [3]}, {"translation": [0, 0.5, 0]}]  # 2 and 3: the joints
    card.document["scenes"][0]["nodes"].append(2)
    card.document["skins"] = [{"joints": [2, 3], "skeleton": 2, "inverseBindMatrices": inverse_binds}]
    card.document["nodes"][0]["skin"] = 0


def add_targets(card):
    deltas = card.add_accessor(struct.pack("<12f", *(0, 0, 0.5) * 4), FLOAT, "VEC3", 4)
    card.primitive["targets"] = [{"POSITION": deltas, "NORMAL": deltas, "TANGENT": deltas}, {"POSITION": deltas}]
    card.document["meshes"][0]["weights"] = [0.5, 0]


def add_animation(card, interpolation):
    """Animate translation and rotation of node 1, the scale of the last node, and the weights of the mesh's node."""
    times = card.add_accessor(struct.pack("<2f", 0, 1), FLOAT, "SCALAR", 2)
    values_per_key = 3 if interpolation == "CUBICSPLINE" else 1
    samplers, channels = [], []
    last = len(card.document["nodes"]) - 1
    # path: (node, type of the accessor, floats per value)
    targets = {"translation": (1, "VEC3", 3), "rotation": (1, "VEC4", 4), "scale": (last, "VEC3", 3), "weights": (0, "SCALAR", 2)}
    for path, (node, kind, width) in targets.items():
        values = [0.5 + 0.25 * index for index in range(2 * values_per_key * width)]
        count = len(values) // (1 if kind == "SCALAR" else width)
        output = card.add_accessor(struct.pack("<%df" % len(values), *values), FLOAT, kind, count)
        samplers.append({"input": times, "output": output, "interpolation": interpolation})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
    card.document["animations"] = [{"name": "Move", "samplers": samplers, "channels": channels}]


def make_moved_card(joint_sets, has_targets, interpolation):
    card = make_masked_card()
    if joint_sets:
        add_skin(card, joint_sets)
    if has_targets:
        add_targets(card)
    add_animation(card, interpolation)
    return card


def write_motion(folder):
    cards = {
        "motion_skin": make_moved_card(joint_sets=1, has_targets=False, interpolation="LINEAR"),
        "motion_skin_of_eight": make_moved_card(joint_sets=2, has_targets=True, interpolation="CUBICSPLINE"),
        "motion_targets": make_moved_card(joint_sets=0, has_targets=True, interpolation="STEP"),
        "motion_weights_without_targets": make_moved_card(joint_sets=0, has_targets=False, interpolation="LINEAR"),
    }
    pointer = make_moved_card(joint_sets=1, has_targets=True, interpolation="LINEAR")
    pointer.document["animations"][0]["channels"][0]["target"] = {
        "path": "pointer",
        "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}},
    }
    cards["motion_pointer"] = pointer
    for name, card in cards.items():
        write_gltf(card.document, bytes(card.packed), os.path.join(folder, name))


IDENTITY = (1, 0, 0, 1, 0, 0)
WRAPS = {"clamp": 0, "repeat": 1, "mirror": 2}  # TextureWrap of modules/scene/texture.h
MIN_EDGE_COUNT = 4  # as in cut_mesh_fuzz.cpp


def build_cut(uvs, positions=None, alphas=None, size=(8, 8), texels=None, wraps=("repeat", "repeat"), nearest=False,
        blend=False, cutoff=0.5, alpha=1.0, transform=IDENTITY, edges=(1024, 16384)):  # fmt: skip
    """Return an input of cut_mesh_fuzz.cpp. The corners of its triangles are the vertices in their order.

    alphas: of the vertices. texels: alphas of the image; by default they grow with the distance from texel (3, 4).
    alpha: of the material. edges: the budget of a tile and of the mesh.
    """
    count = len(uvs) // 3 * 3
    positions = positions or [(float(i % 3 == 1), float(i % 3 == 2), float(i // 3)) for i in range(count)]
    texels = texels or [min(255, 31 * abs(x - 3) + 31 * abs(y - 4)) for y in range(size[1]) for x in range(size[0])]
    data = bytes([blend, WRAPS[wraps[0]], WRAPS[wraps[1]], nearest, 0])  # 0: the first set of coordinates
    data += struct.pack("<8f", cutoff, alpha, *transform)
    data += bytes([(most // MIN_EDGE_COUNT).bit_length() - 1 for most in edges])
    data += bytes([1, alphas is not None, count - 1, count // 3 - 1])  # 1: with texture coordinates
    for index in range(count):
        data += struct.pack("<5f", *positions[index], *uvs[index])
        data += struct.pack("<f", alphas[index]) if alphas else b""
    return data + bytes(range(count)) + bytes(size) + bytes(texels)


def write_cuts(folder):
    nan, infinity = float("nan"), float("inf")
    triangle = [(0, 0), (1, 0), (0, 1)]
    noise = [(37 * i * i + 11 * i) % 256 for i in range(24 * 24)]
    cuts = {
        "plain": build_cut(triangle),
        "nearest": build_cut(
            [(0, 0), (2, 0), (2, 2), (0, 0), (2, 2), (0, 2)], nearest=True, wraps=("repeat", "mirror")
        ),
        "clamped": build_cut([(-1, -2), (3, 0), (0, 4)], wraps=("clamp", "clamp")),
        "one_axis_clamped": build_cut([(-1.5, -2), (3, 0.5), (0, 4)], wraps=("mirror", "clamp")),
        "turned": build_cut(triangle, transform=(0.8, 0.3, -0.2, 1.1, 0.1, 0.4), blend=True),
        "vertex_alphas": build_cut(2 * triangle, alphas=[1, 0.5, 0.9, 0.7, nan, 1]),
        "noise": build_cut([(0, 0), (40, 0), (0, 40)], size=(24, 24), texels=noise, edges=(64, 1024)),
        "many_tiles": build_cut([(0, 0), (1000, 0), (0, 900)], edges=(64, 4096)),
        "sliver": build_cut([(0, 0), (500, 500), (500, 500.001)], edges=(64, 1024)),
        "not_finite": build_cut([(0, 0), (nan, 0), (0, 1), (0, 0), (infinity, 0), (0, 1)]),
        "far": build_cut([(1e20, 0), (3e38, 1), (0, -3e38)], positions=[(3e38, 0, 0), (0, -3e38, 1e-45), (0, 0, 1)]),
        "no_area": build_cut([(0.1, 0.1), (0.1, 0.1), (0.1, 0.1)]),
        "one_texel": build_cut(triangle, size=(1, 1), texels=[128], cutoff=0.501, alpha=0.999),
        "without_image": build_cut(triangle, size=(0, 0), texels=[], alphas=[1, 0, 1]),
    }
    for name, data in cuts.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(data)


def main():
    arguments = sys.argv[1:]
    if len(arguments) > 2 and arguments[0] == "scenes":
        write_scenes(arguments[1:-1], arguments[-1])
    elif len(arguments) == 2 and arguments[0] == "textures":
        write_textures(arguments[1])
    elif len(arguments) == 2 and arguments[0] == "motion":
        write_motion(arguments[1])
    elif len(arguments) == 2 and arguments[0] == "cut_mesh":
        write_cuts(arguments[1])
    else:
        print("ERROR: usage: make_seeds.py scenes SCENE... FOLDER, or textures, motion or cut_mesh FOLDER", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
