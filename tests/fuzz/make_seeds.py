#!/usr/bin/env python3
"""Writes small forms of scenes as inputs of the glTF fuzz target.

    make_seeds.py SCENE... FOLDER

Each .gltf or .glb scene becomes FOLDER/<name>.gltf, with its buffer inside, and FOLDER/<name>.glb: all that the file
says, but no accessor of more than a few elements, so that mutations hit what matters.
"""

import base64
import json
import os
import struct
import sys

COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
INDEX_FORMATS = {5121: "B", 5123: "<H", 5125: "<I"}
TYPE_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
KEPT_VERTICES = 4
KEPT_INDICES = 6


def read_scene(path):
    """(JSON, bytes of each buffer)"""
    with open(path, "rb") as file:
        data = file.read()
    chunk = None
    if data[:4] == b"glTF":
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
    """Cuts every accessor to its first elements, in one buffer whose bytes are returned."""
    indices = find_index_accessors(document)
    packed = bytearray()
    views = []
    for number, accessor in enumerate(document.get("accessors", [])):
        view = document["bufferViews"][accessor["bufferView"]]
        component_bytes = COMPONENT_BYTES[accessor["componentType"]]
        element_bytes = component_bytes * TYPE_COUNTS[accessor["type"]]
        stride = view.get("byteStride", element_bytes)
        first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        count = min(accessor["count"], KEPT_INDICES if number in indices else KEPT_VERTICES)
        source = buffers[view["buffer"]]
        elements = [source[first + i * stride :][:element_bytes] for i in range(count)]
        if number in indices:
            letter = INDEX_FORMATS[accessor["componentType"]]
            elements = [struct.pack(letter, struct.unpack(letter, e)[0] % KEPT_VERTICES) for e in elements]
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


def main():
    if len(sys.argv) < 3:
        print("ERROR: usage: make_seeds.py SCENE... FOLDER", file=sys.stderr)
        return 2
    for path in sys.argv[1:-1]:
        name = os.path.join(sys.argv[-1], os.path.splitext(os.path.basename(path))[0])
        document, buffers = read_scene(path)
        packed = shrink(document, buffers)
        if packed:
            document["buffers"] = [{"byteLength": len(packed)}]
        with open(name + ".glb", "wb") as file:
            file.write(build_glb(document, packed))
        if packed:
            uri = "data:application/octet-stream;base64," + base64.b64encode(packed).decode()
            document["buffers"][0]["uri"] = uri
        with open(name + ".gltf", "w", encoding="utf-8") as file:
            json.dump(document, file, separators=(",", ":"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
