#!/usr/bin/env python3
"""Measures the scenes with cut-out casters, and writes the tables of doc/cut_outs.md.

    measure_cut_outs.py [--write] [--scenes A,B] [--techniques A,B] [--times | --unseen]

Errors are those of one light at a time, compared with 2304 rays per receiver, at 512 x 512 pixels, for light radii of 2, 10 and 30 % of
the scene size S; in courtyard for a sun of 2 degrees and a lamp of 0.1 m. --times: medians of five runs of 7 frames in which everything
moves, compared with the same scene with opaque cards and with pcss; all runs of a scene alternate, and each ratio is the median of the
runs' ratios. --unseen: errors with textures and seeds for which the outlines were not tuned; --scenes has no effect on them,
nor has --techniques on --times.
"""

import argparse
import json
import math
import os
import random
import shutil
import statistics
import subprocess
import sys
import tempfile

from driver import ROOT, SCENES, write_table
from driver import run_gnomon as run

sys.path.insert(0, SCENES)
from foliage_shapes import get_leaf_depth, make_mask_png  # noqa: E402
from gltf_writer import encode_png  # noqa: E402
from make_scenes import SCENE_SIZE_M  # noqa: E402

PAGE = os.path.join(ROOT, "doc", "cut_outs.md")
SIZE = "512x512"
SAMPLES = 2304
TECHNIQUES = ("edge_count", "pcss", "views", "shadow_map")
UNSEEN_TECHNIQUES = ("edge_count", "pcss")
ALL_SCENES = ("leaf", "fence", "leaves", "courtyard")
TIMED_RUNS = 5
TIMED_FRAMES = 7  # of each run
RADIUS_FRACTIONS = {"2 %": 0.02, "10 %": 0.1, "30 %": 0.3}  # light radius as a fraction of the scene size S
UNSEEN = {
    "plasma": "a card of plasma, 96 texels",
    "binary": "an oval leaf whose alpha is 0 and 1 alone",
    "leaves": "`leaves` of seed 7",
    "courtyard": "`courtyard` of seed 7, its sun",
}


def list_lights(scene):
    """Return (light, label of its size, setting of its size) for each row."""
    if scene == "courtyard":
        return [("Sun", "2 degrees", "light_angular_distance=2"), ("Lamp", "0.1 m", "light_size=0.1")]
    rows = []
    for light in ("Spot", "Omni", "Sun"):
        for name, fraction in RADIUS_FRACTIONS.items():
            setting = "light_size=%g" % (fraction * SCENE_SIZE_M)
            if light == "Sun":
                setting = "light_angular_distance=%g" % math.degrees(2.0 * math.atan(fraction))
            rows.append((light, name, setting))
    return rows


def measure_errors(path, light, setting, techniques, folder):
    reference, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    arguments = ["visibility", path, "--light", light, "--size", SIZE, "--set", setting]
    run(*arguments, "--technique", "reference", "--set", "reference_samples=%d" % SAMPLES, "--out", reference)
    cells = []
    for technique in techniques:
        run(*arguments, "--technique", technique, "--out", mask)
        error = json.loads(run("compare", reference, mask))
        wrong = error["receiver"]["wrong"] * 1e5
        cells.append("%.4f, %s" % (error["penumbra"]["mae"], "%.1f" % wrong if wrong < 10 else "%.0f" % wrong))
    return cells


def measure_time(path, light, setting, technique, folder):
    times = os.path.join(folder, "times.json")
    run("visibility", path, "--light", light, "--size", SIZE, "--set", setting, "--technique", technique, "--time", times,
        "--timed-frames", str(TIMED_FRAMES), "--out", os.path.join(folder, "timed.exr"))
    with open(times, encoding="utf-8") as file:
        return json.load(file)["total"]["gpu_ms"]


def make_opaque(scene, folder):
    """Write the scene with opaque instead of alpha-tested cards. Return its path."""
    for name in os.listdir(SCENES):
        if name.startswith(scene) and not name.endswith(".gltf"):
            shutil.copy(os.path.join(SCENES, name), folder)
    with open(os.path.join(SCENES, scene + ".gltf"), encoding="utf-8") as file:
        text = file.read()
    path = os.path.join(folder, scene + ".gltf")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace('"MASK"', '"OPAQUE"'))
    return path


def build_errors(scenes, techniques):
    lines = ["| scene | light | size | %s |" % " | ".join("`%s`" % name for name in techniques), "|---" * (3 + len(techniques)) + "|"]
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            for light, size, setting in list_lights(scene):
                cells = measure_errors(os.path.join(SCENES, scene + ".gltf"), light, setting, techniques, folder)
                lines.append("| `%s` | %s | %s | %s |" % (scene, light, size, " | ".join(cells)))
                print(lines[-1], flush=True)
    return lines


def format_times(scene, light, size, runs):
    """Return a row. runs: (edge_count, with opaque cards, pcss) in ms of each run."""
    cut, whole, pcss = (statistics.median(times) for times in zip(*runs))
    to_whole, to_pcss = (statistics.median(run[0] / run[other] for run in runs) for other in (1, 2))
    return "| `%s` | %s | %s | %.1f | %.1f | %.2f | %.1f | %.2f |" % (scene, light, size, cut, whole, to_whole, pcss, to_pcss)


def build_times(scenes):
    lines = ["| scene | light | size | `edge_count` ms | opaque cards | ratio | `pcss` ms | ratio |", "|---" * 8 + "|"]
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            opaque = make_opaque(scene, folder)
            path = os.path.join(SCENES, scene + ".gltf")
            compared = [(path, "edge_count"), (opaque, "edge_count"), (path, "pcss")]
            lights = list_lights(scene)
            runs_by_light = [[] for _ in lights]
            for run in range(TIMED_RUNS):
                for (light, _, setting), runs in zip(lights, runs_by_light):
                    if run > 0 and scene == "leaves" and light != "Spot":
                        continue  # a run takes up to some minutes
                    runs.append([measure_time(file, light, setting, technique, folder) for file, technique in compared])
            for (light, size, _), runs in zip(lights, runs_by_light):
                lines.append(format_times(scene, light, size, runs))
                print(lines[-1], flush=True)
            if scene == "courtyard":
                sums = [[sum(times) for times in zip(*runs)] for runs in zip(*runs_by_light)]
                lines.append(format_times(scene, "both", "", sums))
                print(lines[-1], flush=True)
    return lines


def make_plasma(generator, size_px):
    """Return a PNG whose alpha is a sum of waves in random directions, so that its outlines have every curvature."""
    waves = [(generator.uniform(2, 24), generator.uniform(0, math.tau), generator.uniform(0, math.tau)) for _ in range(12)]

    def get_alpha(x, y):
        total = sum(math.cos(rate * (x * math.cos(angle) + y * math.sin(angle)) + phase) / rate for rate, angle, phase in waves)
        return 0.5 + 1.5 * total

    rows = []
    for y in range(size_px):
        row = bytearray()
        for x in range(size_px):
            alpha = get_alpha(math.tau * x / size_px, math.tau * y / size_px)
            row += bytes((90, 140, 60, round(255 * min(max(alpha, 0.0), 1.0))))
        rows.append(bytes(row))
    return encode_png(size_px, size_px, rows)


def make_unseen(name, folder):
    """Write a scene of UNSEEN. Return (path, light, setting)."""
    if name in ("leaves", "courtyard"):
        script = os.path.join(SCENES, "make_foliage_scenes.py")
        subprocess.run([sys.executable, script, "--scenes", name, "--seed", "7", "--out", folder], check=True, stdout=subprocess.DEVNULL)
    else:
        for suffix in (".gltf", ".bin"):
            shutil.copy(os.path.join(SCENES, "leaf" + suffix), folder)
        png = make_plasma(random.Random(5), 96)
        if name == "binary":  # the factor of 100 makes the edge so steep that hardly any alpha is between 0 and 1
            png = make_mask_png(128, lambda u, v: 100.0 * get_leaf_depth("oval", u - 0.5, 0.5 - v), lambda _u, _v: (0.4, 0.6, 0.2))
        with open(os.path.join(folder, "leaf_card.png"), "wb") as file:
            file.write(png)
    light = ("Sun", "light_angular_distance=2") if name == "courtyard" else ("Spot", "light_size=0.4")
    return (os.path.join(folder, (name if name in ("leaves", "courtyard") else "leaf") + ".gltf"), *light)


def build_unseen(techniques):
    lines = ["| scene | %s |" % " | ".join("`%s`" % name for name in techniques), "|---" * (1 + len(techniques)) + "|"]
    for name, title in UNSEEN.items():
        with tempfile.TemporaryDirectory() as folder:
            cells = measure_errors(*make_unseen(name, folder), techniques, folder)
            lines.append("| %s | %s |" % (title, " | ".join(cells)))
            print(lines[-1], flush=True)
    return lines


def main():
    parser = argparse.ArgumentParser(description="Measures cut-out casters.")
    parser.add_argument("--write", action="store_true", help="write the table into doc/cut_outs.md")
    parser.add_argument("--scenes", default=",".join(ALL_SCENES), help="without --write; default: %(default)s")
    parser.add_argument("--techniques", help="without --write; default: those of the table")
    parser.add_argument("--times", action="store_true", help="times instead of errors")
    parser.add_argument("--unseen", action="store_true", help="errors in scenes for which the outlines were not tuned")
    options = parser.parse_args()
    default = ",".join(UNSEEN_TECHNIQUES if options.unseen else TECHNIQUES)
    scenes, techniques = options.scenes.split(","), (options.techniques or default).split(",")
    if options.write and (tuple(scenes) != ALL_SCENES or ",".join(techniques) != default):
        parser.error("--write replaces the whole table: omit --scenes and --techniques")
    table = "times" if options.times else "unseen" if options.unseen else "errors"
    if options.times:
        lines = build_times(scenes)
    else:
        lines = build_unseen(techniques) if options.unseen else build_errors(scenes, techniques)
    if options.write:
        write_table(table, lines, PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
