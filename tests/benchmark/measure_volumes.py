#!/usr/bin/env python3
"""Measures shadow volumes against exact rays and writes their tables of doc/benchmarks.md.

    measure_volumes.py [--only TABLE]... [--write]

Errors are counted in pixels: R = 0, so that every receiver is lit or hidden. Without --write the tables are
only printed. Times of culling are medians of three alternating runs. Build first: scons.
"""

import argparse
import json
import os
import re
import statistics
import sys
import tempfile

import driver
import volume_scenes
from driver import SCENES, describe_machine, format_table, publish_tables, run

GNOMON = os.path.abspath(os.environ.get("GNOMON", driver.PROGRAM))
SIZE = "400x400"
POINT = ("light_size=0", "light_angular_distance=0")
CULLING_ROUNDS = 3  # a run of the program may be 1.7 times as long as the next one
TIMED = {
    "auto": ("shadow_volume",),
    "compute": ("shadow_volume", "technique.shadow_volume.extrusion=compute"),
    "geometry shader": ("shadow_volume", "technique.shadow_volume.extrusion=geometry_shader"),
    "z-fail": ("shadow_volume", "technique.shadow_volume.method=z_fail"),
    "no scissor": ("shadow_volume", "technique.shadow_volume.scissor=false"),
    "robust": ("shadow_volume", "technique.shadow_volume.robust=always"),
    "CPU": ("shadow_volume_cpu",),
    "shadow_map 2048": ("shadow_map", "shadow_map_size=2048"),
}
COMPARED = ("auto", "shadow_map 2048")  # variants whose errors are counted: the other shadow volumes have the same mask


def load_scene(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def find_lights(scene):
    return [light["name"] for light in scene["extensions"]["KHR_lights_punctual"]["lights"]]


def has_fractions(scene):
    """Return whether light spreads in or passes through a material, so that a hard shadow is more than 0 and 1."""
    return any(
        "scatter" in material.get("extras", {}) or "KHR_materials_transmission" in material.get("extensions", {})
        for material in scene.get("materials", ())
    )


def render(scene, light, technique, settings, out, *more):
    arguments = [word for setting in (*POINT, *settings) for word in ("--set", setting)]
    run([GNOMON, "visibility", scene, "--light", light, "--technique", technique, "--size", SIZE, "--out", out, *arguments, *more])


def count_wrong(reference, mask):
    """Return (number of receivers, number of receivers that differ). Each error is 0 or 1, as R = 0."""
    result = json.loads(run([GNOMON, "compare", reference, mask]))
    return result["pixels"], round(result["receiver"]["mae"] * result["pixels"])


def measure(scene, light, folder):
    reference, mask, times = (os.path.join(folder, name) for name in ("reference.exr", "mask.exr", "time.json"))
    render(scene, light, "reference", ["reference_samples=1"], reference)
    wrong, cost = {}, {}
    for name, (technique, *settings) in TIMED.items():
        render(scene, light, technique, settings, mask, "--time", times)
        with open(times, encoding="utf-8") as file:
            cost[name] = json.load(file)["total"]["wall_ms"]
        if name in COMPARED:
            receivers, wrong[name] = count_wrong(reference, mask)
    return receivers, wrong, cost


def measure_errors(folder):
    rows = []
    for name in sorted(os.listdir(SCENES)):
        if not name.endswith(".gltf"):
            continue
        path = os.path.join(SCENES, name)
        scene = load_scene(path)
        if has_fractions(scene):
            continue
        for light in find_lights(scene):
            receivers, wrong, cost = measure(path, light, folder)
            label = os.path.splitext(name)[0] + ("" if light == "Light" else ", " + light)
            errors = ["%d (%.4f %%)" % (wrong[variant], 100 * wrong[variant] / receivers) for variant in COMPARED]
            rows.append((label, receivers, *errors, *("%.1f" % cost[variant] for variant in TIMED)))
            print(*rows[-1], flush=True)
    header = ("scene, light", "receivers", "wrong", "wrong, `shadow_map` 2048", *("%s, ms" % variant for variant in TIMED))
    return format_table(header, rows)


def measure_time(scene, light, folder, settings, *more, technique="shadow_volume"):
    """Return the wall time of the light's passes in ms."""
    mask, times = (os.path.join(folder, name) for name in ("mask.exr", "time.json"))
    render(scene, light, technique, settings, mask, "--time", times, *more)
    with open(times, encoding="utf-8") as file:
        return json.load(file)["total"]["wall_ms"]


def count_hidden(scene, folder):
    """Return how many casters are hidden from the light by others, according to the second frame's plan."""
    arguments = [word for setting in POINT for word in ("--set", setting)]
    plan = run([GNOMON, "visibility", scene, "--technique", "shadow_volume", "--size", SIZE, "--frames", "2", "--plan",
                "--out", os.path.join(folder, "mask.exr"), *arguments])  # fmt: skip
    found = re.search(r"volumes of (\d+) casters: skipped, others hide them", plan)
    return int(found.group(1)) if found else 0


def measure_culling_once(scene, folder):
    """Return times in ms without culling, with it, with it if nothing moves, and of `shadow_map`."""
    return (
        measure_time(scene, "Sun", folder, ["technique.shadow_volume.culling=off"]),
        measure_time(scene, "Sun", folder, []),
        measure_time(scene, "Sun", folder, [], "--still"),
        measure_time(scene, "Sun", folder, ["shadow_map_size=2048"], technique="shadow_map"),
    )


def measure_culling(folder):
    rows = []
    for count, has_walls in ((1000, True), (5000, True), (20000, True), (1000, False), (5000, False)):
        scene = volume_scenes.make_yard(count, has_walls, folder)
        hidden = count_hidden(scene, folder)
        rounds = [measure_culling_once(scene, folder) for _round in range(CULLING_ROUNDS)]
        off, moving, still, shadow_map = (statistics.median(times) for times in zip(*rounds))
        ratios = ["%.0f (%.2f)" % (ms, ms / off) for ms in (moving, still)]
        rows.append((count, "yes" if has_walls else "no", hidden, "%.0f" % off, *ratios, "%.0f" % shadow_map))
        print(*rows[-1], flush=True)
    header = ("casters", "walls", "hidden", "off, ms", "everything moves, ms (ratio)", "nothing moves, ms (ratio)",
              "`shadow_map` 2048, ms")  # fmt: skip
    return format_table(header, rows)


def measure_triangles(folder):
    extrusions = ("compute", "geometry_shader")
    rows = []
    for count in volume_scenes.KNOT_SEGMENTS:
        scene = volume_scenes.make_knot(count, folder)
        times = [measure_time(scene, "Light", folder, ["technique.shadow_volume.extrusion=" + extrusion]) for extrusion in extrusions]
        times.append(measure_time(scene, "Light", folder, ["technique.shadow_volume.method=z_fail"]))
        times.append(measure_time(scene, "Light", folder, ["technique.shadow_volume.robust=always"]))
        times.append(measure_time(scene, "Light", folder, [], technique="shadow_volume_cpu"))
        times.append(measure_time(scene, "Light", folder, ["shadow_map_size=2048"], technique="shadow_map"))
        rows.append((count, *("%.1f" % ms for ms in times)))
        print(*rows[-1], flush=True)
    header = ("triangles", "compute, ms", "geometry shader, ms", "z-fail, ms", "robust, ms", "CPU, ms", "`shadow_map` 2048, ms")
    return format_table(header, rows)


PARTS = {"volumes": measure_errors, "volume_culling": measure_culling, "volume_triangles": measure_triangles}


def main():
    parser = argparse.ArgumentParser(description="Measures shadow volumes against exact rays.")
    parser.add_argument("--only", action="append", choices=PARTS, help="measure only this table; may be repeated")
    parser.add_argument("--write", action="store_true", help="write the tables into doc/benchmarks.md")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        tables = {part: PARTS[part](folder) for part in options.only or PARTS}
    publish_tables(tables, describe_machine(load), options.write)
    return 0


if __name__ == "__main__":
    sys.exit(main())
