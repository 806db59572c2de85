#!/usr/bin/env python3
"""Measures deformed casters in the scene `courtyard` and writes the tables of doc/animation.md.

    measure_animation.py [--write] [--errors | --times] [--techniques A,B]

Errors: at eight times of the walk, compared with 2304 rays per receiver, at 512 x 512 pixels, from the fixed camera that looks at the figure,
for the sun and the lamp. Times: milliseconds of the mask's passes for a mesh of 69,800 triangles that a skin of 20 joints deforms, compared with
the same mesh moved by its node. They are medians of 20 frames in which everything moves.
"""

import argparse
import json
import math
import os
import shutil
import struct
import tempfile

from driver import ROOT, SCENES, write_table
from driver import run_gnomon as run
from mask_file import load_mask

PAGE = os.path.join(ROOT, "doc", "animation.md")
SIZE = "512x512"
SAMPLES = 2304
WRONG_ERROR = 0.2  # a receiver with a larger error counts as wrong
TIMES_S = [0.3 + 0.75 * index for index in range(8)]
LIGHTS = {"Sun": "light_angular_distance=2", "Lamp": "light_size=0.1"}
CAMERA = "Walk camera"
MOVING = ("Figure", "Flag")
TECHNIQUES = ("edge_count", "pcss", "views", "jittered_pcf", "penumbra_fins", "outer_fins", "shadow_volume", "planar", "shadow_map")
TIMED = ("edge_count", "pcss", "penumbra_fins", "shadow_volume")
RINGS, SIDES = 350, 100  # 69,800 triangles
UNSIGNED_BYTE, UNSIGNED_INT, FLOAT = 5121, 5125, 5126  # glTF component types


def make_still_scene(folder):
    """Write the scene without the moving meshes and the animation. Return its path."""
    with open(os.path.join(SCENES, "courtyard.gltf"), encoding="utf-8") as file:
        document = json.load(file)
    for node in document["nodes"]:
        if node.get("name") in MOVING:
            for key in ("mesh", "skin", "weights"):
                node.pop(key, None)
    for element in document["buffers"] + document["images"]:
        if "uri" in element:
            shutil.copy(os.path.join(SCENES, element["uri"]), folder)
    document.pop("animations")
    path = os.path.join(folder, "still.gltf")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path


def load_depths(folder):
    with open(os.path.join(folder, "depth.f32"), "rb") as file:
        data = file.read()
    return struct.unpack("<%df" % (len(data) // 4), data)


def find_moving_pixels(still, arguments, folder):
    """Return the pixels that show the figure or the flag: those whose depth changes when both are removed."""
    depths = []
    for scene in ([os.path.join(SCENES, "courtyard.gltf"), *arguments], [still]):
        run("visibility", *scene, "--camera", CAMERA, "--light", "Sun", "--size", SIZE, "--technique", "shadow_map",
            "--surfaces", folder, "--out", os.path.join(folder, "mask.exr"))
        depths.append(load_depths(folder))
    return [index for index, (one, other) in enumerate(zip(*depths)) if one != other]


def measure_errors(techniques):
    """Return the lines of a table. For each light and technique it has the maxima over the eight times of the penumbra MAE, of
    wrong receivers per 100,000, and of wrong receivers per 100,000 on the moving meshes."""
    maxima = {}
    with tempfile.TemporaryDirectory() as folder:
        still = make_still_scene(folder)
        reference, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
        for time_s in TIMES_S:
            at = ["--at", "%g" % time_s]
            moving = find_moving_pixels(still, at, folder)
            for light, setting in LIGHTS.items():
                arguments = ["visibility", os.path.join(SCENES, "courtyard.gltf"), *at, "--camera", CAMERA, "--light", light,
                         "--size", SIZE, "--set", setting]
                run(*arguments, "--technique", "reference", "--set", "reference_samples=%d" % SAMPLES, "--out", reference)
                reference_mask = load_mask(reference)
                receivers = [index for index in moving if reference_mask.receiver[index] >= 0.5]
                for technique in techniques:
                    run(*arguments, "--technique", technique, "--out", mask)
                    error = json.loads(run("compare", reference, mask))
                    found = load_mask(mask)
                    wrong = sum(abs(found.visibility[i] - reference_mask.visibility[i]) > WRONG_ERROR for i in receivers)
                    row = (error["penumbra"]["mae"], error["receiver"]["wrong"] * 1e5, wrong / len(receivers) * 1e5)
                    before = maxima.get((light, technique), (0, 0, 0))
                    maxima[light, technique] = tuple(map(max, before, row))
                    print("%.2f s, %s, %s: MAE %.4f, wrong per 100,000 %.1f, of the %d moving receivers %.1f" % (
                        time_s, light, technique, row[0], row[1], len(receivers), row[2]), flush=True)
    lines = ["| technique | %s |" % " | ".join(LIGHTS), "|---" * (1 + len(LIGHTS)) + "|"]
    for technique in techniques:
        cells = ["%.4f, %.0f, %.0f" % maxima[light, technique] for light in LIGHTS]
        lines.append("| `%s` | %s |" % (technique, " | ".join(cells)))
    return lines


class Document:
    """A glTF document under construction, with a single buffer."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "bufferViews": [],
                     "accessors": []}
        self.bytes = bytearray()

    def add(self, code, kind, type_name, values, width):
        """Append an accessor and return its index. code: struct format, kind: glTF component type, width: numbers per element."""
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes),
                                         "byteLength": len(values) * struct.calcsize(code)})
        self.bytes += struct.pack("<%d%s" % (len(values), code), *values)
        self.bytes += bytes(-len(self.bytes) % 4)
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": kind, "type": type_name,
                    "count": len(values) // width}
        if type_name in ("VEC3", "SCALAR") and code == "f":
            columns = [values[axis::width] for axis in range(width)]
            accessor.update(min=[min(column) for column in columns], max=[max(column) for column in columns])
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def save(self, path):
        with open(path + ".bin", "wb") as file:
            file.write(self.bytes)
        self.json["buffers"] = [{"uri": os.path.basename(path) + ".bin", "byteLength": len(self.bytes)}]
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.json, file)


def make_tube(path, is_skinned):
    """Write a tube of 69,800 triangles that is rotated by its node, or by the root joint of a skin of 20 joints.
    The program adds a light, a camera and a ground, which the file lacks."""
    document = Document()
    joint_count = 20
    points, normals, joints, weights = [], [], [], []
    for ring in range(RINGS):
        height = 2.0 * ring / (RINGS - 1)
        position = height / 2.0 * (joint_count - 1)
        first = min(int(position), joint_count - 2)
        for side in range(SIDES):
            angle = math.tau * side / SIDES
            radius = 0.15 + 0.03 * math.sin(9.0 * height) * math.cos(3.0 * angle)
            points += [radius * math.cos(angle), height, radius * math.sin(angle)]
            normals += [math.cos(angle), 0.0, math.sin(angle)]
            joints += [first, first + 1, 0, 0]
            weights += [1.0 - (position - first), position - first, 0.0, 0.0]
    indices = []
    for ring in range(RINGS - 1):
        for side in range(SIDES):
            a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
            indices += [a, a + SIDES, b, b, a + SIDES, b + SIDES]
    attributes = {"POSITION": document.add("f", FLOAT, "VEC3", points, 3), "NORMAL": document.add("f", FLOAT, "VEC3", normals, 3)}
    if is_skinned:
        attributes["JOINTS_0"] = document.add("B", UNSIGNED_BYTE, "VEC4", joints, 4)
        attributes["WEIGHTS_0"] = document.add("f", FLOAT, "VEC4", weights, 4)
    primitive = {"attributes": attributes, "indices": document.add("I", UNSIGNED_INT, "SCALAR", indices, 1)}
    document.json["meshes"] = [{"name": "tube", "primitives": [primitive]}]
    nodes = document.json["nodes"]
    nodes.append({"name": "Tube", "mesh": 0, **({"skin": 0} if is_skinned else {})})
    step = 2.0 / (joint_count - 1)
    for joint in range(joint_count):
        nodes.append({"name": "Joint %d" % joint, "translation": [0, step if joint else 0, 0],
                      **({"children": [joint + 2]} if joint + 1 < joint_count else {})})
    inverse_binds = []
    for joint in range(joint_count):
        inverse_binds += [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -step * joint, 0, 1]
    if is_skinned:
        document.json["skins"] = [{"joints": list(range(1, joint_count + 1)),
                                   "inverseBindMatrices": document.add("f", FLOAT, "MAT4", inverse_binds, 16)}]
    moved = 1 if is_skinned else 0  # the root joint or the mesh's node: both give the same shape at the same position
    angle = 0.3
    times = document.add("f", FLOAT, "SCALAR", [0.0, 1.0], 1)
    rotations = document.add("f", FLOAT, "VEC4", [0, 0, 0, 1, math.sin(angle / 2), 0, 0, math.cos(angle / 2)], 4)
    document.json["animations"] = [{
        "samplers": [{"input": times, "output": rotations}],
        "channels": [{"sampler": 0, "target": {"node": moved, "path": "rotation"}}]}]
    document.json["scenes"][0]["nodes"] = [0, 1]
    document.save(path)


def measure_time(path, technique, folder):
    """Return the light's GPU time, and how much of it the pass `deform` takes, in ms."""
    times = os.path.join(folder, "times.json")
    run("visibility", path, "--at", "0.7", "--size", SIZE, "--technique", technique, "--time", times, "--out",
        os.path.join(folder, "timed.exr"))
    with open(times, encoding="utf-8") as file:
        document = json.load(file)
    deform = sum(item["gpu_ms"] for item in document["passes"] if item["name"] == "deform")
    return document["total"]["gpu_ms"], deform


def measure_times():
    lines = ["| technique | moved by its node, ms | by a skin, ms | ratio | of which `deform` |", "|---" * 5 + "|"]
    with tempfile.TemporaryDirectory() as folder:
        paths = {}
        for is_skinned in (False, True):
            paths[is_skinned] = os.path.join(folder, "skin.gltf" if is_skinned else "rigid.gltf")
            make_tube(paths[is_skinned], is_skinned)
        for technique in TIMED:
            rigid, _ = measure_time(paths[False], technique, folder)
            skinned, deform = measure_time(paths[True], technique, folder)
            lines.append("| `%s` | %.1f | %.1f | %.2f | %.1f |" % (technique, rigid, skinned, skinned / rigid, deform))
            print(lines[-1], flush=True)
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="writes the tables into doc/animation.md")
    parser.add_argument("--errors", action="store_true", help="only the table of errors")
    parser.add_argument("--times", action="store_true", help="only the table of times")
    parser.add_argument("--techniques", default=",".join(TECHNIQUES))
    options = parser.parse_args()
    if not options.times:
        lines = measure_errors(options.techniques.split(","))
        print("\n".join(lines))
        if options.write:
            write_table("errors", lines, PAGE)
    if not options.errors:
        lines = measure_times()
        if options.write:
            write_table("times", lines, PAGE)


if __name__ == "__main__":
    main()
