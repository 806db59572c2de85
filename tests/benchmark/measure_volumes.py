#!/usr/bin/env python3
"""Measures shadow volumes against exact rays and writes the table of doc/benchmarks.md.

    measure_volumes.py [--write]

Errors are counted in pixels: R = 0, so that every receiver is lit or hidden. Without --write the table is printed
only. Build first: scons.
"""

import argparse
import json
import os
import sys
import tempfile

import run_benchmarks
from run_benchmarks import SCENES, describe_machine, format_table, publish_tables, run

GNOMON = os.path.abspath(os.environ.get("GNOMON", run_benchmarks.PROGRAM))
SIZE = "400x400"
POINT = ("light_size=0", "light_angular_distance=0")
TIMED = {
    "compute": ("shadow_volume", "shadow_volume_extrusion=compute"),
    "geometry shader": ("shadow_volume", "shadow_volume_extrusion=geometry_shader"),
    "z-fail": ("shadow_volume", "shadow_volume_method=z_fail"),
    "no scissor": ("shadow_volume", "shadow_volume_scissor=false"),
    "robust": ("shadow_volume", "shadow_volume_robust=always"),
    "CPU": ("shadow_volume_cpu",),
    "shadow_map 2048": ("shadow_map", "shadow_map_size=2048"),
}
COMPARED = ("compute", "shadow_map 2048")  # of the variants: the others have the same mask


def find_lights(scene):
    with open(scene, encoding="utf-8") as file:
        return [light["name"] for light in json.load(file)["extensions"]["KHR_lights_punctual"]["lights"]]


def render(scene, light, technique, settings, out, *more):
    words = [word for setting in (*POINT, *settings) for word in ("--set", setting)]
    run([GNOMON, "visibility", scene, "--light", light, "--technique", technique, "--size", SIZE, "--out", out, *words, *more])


def count_wrong(truth, mask):
    """(receivers, those that differ)"""
    result = json.loads(run([GNOMON, "compare", truth, mask]))
    return result["pixels"], round(result["receiver"]["mae"] * result["pixels"])


def measure(scene, light, folder):
    truth, mask, times = (os.path.join(folder, name) for name in ("truth.exr", "mask.exr", "time.json"))
    render(scene, light, "reference", ["reference_samples=1"], truth)
    wrong, cost = {}, {}
    for name, (technique, *settings) in TIMED.items():
        render(scene, light, technique, settings, mask, "--time", times)
        with open(times, encoding="utf-8") as file:
            cost[name] = json.load(file)["total"]["wall_ms"]
        if name in COMPARED:
            receivers, wrong[name] = count_wrong(truth, mask)
    return receivers, wrong, cost


def main():
    parser = argparse.ArgumentParser(description="Measures shadow volumes against exact rays.")
    parser.add_argument("--write", action="store_true", help="into doc/benchmarks.md")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in sorted(os.listdir(SCENES)):
            if not name.endswith(".gltf"):
                continue
            scene = os.path.join(SCENES, name)
            for light in find_lights(scene):
                receivers, wrong, cost = measure(scene, light, folder)
                label = os.path.splitext(name)[0] + ("" if light == "Light" else ", " + light)
                errors = ["%d (%.4f %%)" % (wrong[variant], 100 * wrong[variant] / receivers) for variant in COMPARED]
                rows.append((label, receivers, *errors, *("%.1f" % cost[variant] for variant in TIMED)))
                print(*rows[-1], flush=True)
    header = ("scene, light", "receivers", "wrong", "wrong, `shadow_map` 2048", *("%s, ms" % variant for variant in TIMED))
    publish_tables({"volumes": format_table(header, rows)}, describe_machine(load), options.write)
    return 0


if __name__ == "__main__":
    sys.exit(main())
