#!/usr/bin/env python3
"""Measures edge_count on a bumpy sphere of very many triangles against pcss with 64 taps, from close to far.

    measure_dense.py [--program PROGRAM] [--triangles N] [--frames N] [--size WxH]

The sphere has a radius of 1 m and is on a ground plane. Prints a table of the light's passes, with everything moving.
"""

import argparse
import array
import json
import math
import os
import tempfile

from driver import PROGRAM, format_table, run

# Name, the camera's position and target in m.
VIEWS = (
    ("the mesh fills the view", (0.75, 0.72, 0.75), (0.5, 0.3, 0.5)),
    ("from 4 m", (0.0, 1.5, 4.0), (0.0, -0.2, 0.0)),
    ("from 60 m", (30.0, 27.0, 44.0), (0.0, -0.2, 0.0)),
)
SUN_DIRECTION = (-0.5, -0.7, -0.2)
LIGHTS = (
    {"name": "Sun", "type": "directional", "intensity": 3.0, "extras": {"light_angular_distance": 3.0}},
    {"name": "Lamp", "type": "point", "intensity": 200.0, "extras": {"light_size": 0.2}},
)
LAMP_POSITION = (2.5, 3.0, 1.0)
TECHNIQUES = {"edge_count": (), "pcss": ("pcss_taps=64",)}


def find_radius(polar, azimuth):
    """The radius in m: 1, with bumps of up to 5 cm."""
    wide = 0.04 * math.sin(9.0 * azimuth) * math.sin(7.0 * polar)
    return 1.0 + wide + 0.01 * math.sin(61.0 * azimuth + 1.0) * math.sin(53.0 * polar)


def make_sphere(triangle_count):
    """Return positions and indices of a closed sphere of rings about +Y."""
    rings = max(int(math.sqrt(triangle_count / 4.0)), 3)
    columns = 2 * rings
    positions, indices = array.array("f", (0.0, find_radius(0.0, 0.0), 0.0)), array.array("I")
    for ring in range(1, rings):
        polar = math.pi * ring / rings
        for column in range(columns):
            azimuth = 2.0 * math.pi * column / columns
            radius = find_radius(polar, azimuth)
            across = radius * math.sin(polar)
            positions.extend((across * math.cos(azimuth), radius * math.cos(polar), -across * math.sin(azimuth)))
    positions.extend((0.0, -find_radius(math.pi, 0.0), 0.0))

    def find_vertex(ring, column):
        if ring in (0, rings):  # a pole
            return 0 if ring == 0 else 1 + (rings - 1) * columns
        return 1 + (ring - 1) * columns + column % columns

    for ring in range(rings):
        for column in range(columns):
            a, b = find_vertex(ring, column), find_vertex(ring + 1, column)
            c, d = find_vertex(ring + 1, column + 1), find_vertex(ring, column + 1)
            if ring < rings - 1:
                indices.extend((a, b, c))
            if ring > 0:
                indices.extend((a, c, d))
    return positions, indices


def find_rotation(direction):
    """Return x, y, z, w of the rotation that takes -Z to the direction without a roll."""
    length = math.sqrt(sum(value * value for value in direction))
    x, y, z = (-value / length for value in direction)
    yaw, pitch = 0.5 * math.atan2(x, z), -0.5 * math.asin(y)
    (cos_yaw, sin_yaw), (cos_pitch, sin_pitch) = ((math.cos(half), math.sin(half)) for half in (yaw, pitch))
    return (cos_yaw * sin_pitch, sin_yaw * cos_pitch, -sin_yaw * sin_pitch, cos_yaw * cos_pitch)


def save_scene(folder, triangle_count):
    """Save the scene and return its path. The ground is 40 m wide and touches no bump."""
    ground = array.array("f", (-20, -1.06, -20, -20, -1.06, 20, 20, -1.06, 20, 20, -1.06, -20))
    ground_indices = array.array("I", (0, 1, 2, 0, 2, 3))
    data, views, accessors = b"", [], []
    for values in (*make_sphere(triangle_count), ground, ground_indices):
        kind = "VEC3" if values.typecode == "f" else "SCALAR"
        accessor = {"bufferView": len(views), "componentType": 5126 if kind == "VEC3" else 5125, "type": kind}
        accessor["count"] = len(values) // (3 if kind == "VEC3" else 1)
        if kind == "VEC3":
            accessor["min"], accessor["max"] = ([limit(values[axis::3]) for axis in range(3)] for limit in (min, max))
        accessors.append(accessor)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(values)})
        data += values.tobytes()
    nodes = [{"name": "Sphere", "mesh": 0}, {"name": "Ground", "mesh": 1}]
    for index, light in enumerate(LIGHTS):
        is_sun = light["type"] == "directional"
        pose = {"rotation": find_rotation(SUN_DIRECTION)} if is_sun else {"translation": LAMP_POSITION}
        nodes.append({"name": light["name"], "extensions": {"KHR_lights_punctual": {"light": index}}, **pose})
    for name, position, target in VIEWS:
        direction = [to - at for to, at in zip(target, position)]
        nodes.append({"name": name, "camera": 0, "translation": position, "rotation": find_rotation(direction)})
    scene = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"], "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}],
        "extensions": {"KHR_lights_punctual": {"lights": LIGHTS}},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1}]} for i in range(2)],
        "accessors": accessors, "bufferViews": views, "buffers": [{"uri": "dense.bin", "byteLength": len(data)}],
    }  # fmt: skip
    with open(os.path.join(folder, "dense.bin"), "wb") as file:
        file.write(data)
    path = os.path.join(folder, "dense.gltf")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    return path


def measure(options, path, folder, camera, light, technique):
    """Return the light's passes in ms, and the names and times of its two longest passes."""
    times = os.path.join(folder, "times.json")
    settings = [word for setting in TECHNIQUES[technique] for word in ("--set", setting)]
    run([options.program, "visibility", path, "--technique", technique, "--camera", camera, "--light", light,
         "--size", options.size, "--out", os.path.join(folder, "mask.exr"), "--time", times,
         "--timed-frames", str(options.frames), *settings])  # fmt: skip
    with open(times, encoding="utf-8") as file:
        result = json.load(file)
    longest = sorted(result["passes"], key=lambda item: -item["gpu_ms"])[:2]
    return result["total"]["gpu_ms"], ", ".join("%s %.0f" % (item["name"], item["gpu_ms"]) for item in longest)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--triangles", type=int, default=2_000_000)
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--size", default="512x512")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        path = save_scene(folder, options.triangles)
        for camera, _, _ in VIEWS:
            for light in LIGHTS:
                own, longest = measure(options, path, folder, camera, light["name"], "edge_count")
                pcss, _ = measure(options, path, folder, camera, light["name"], "pcss")
                rows.append((camera, light["name"], "%.0f" % own, "%.0f" % pcss, "%.2f" % (own / pcss), longest))
    print("\n".join(format_table(("view", "light", "`edge_count` ms", "`pcss` ms", "ratio", "longest passes"), rows)))


if __name__ == "__main__":
    main()
