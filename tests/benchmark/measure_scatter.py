#!/usr/bin/env python3
"""Measures receiver_scatter and writes the tables of doc/techniques/receiver_scatter.md.

    measure_scatter.py [--only errors|times|resolutions|shades] [--samples N]

errors: each method, and a plain blur of 48 taps, against the reference at s = 0.15, 0.50 and 0.80. times: what the filter's
passes cost. resolutions: how much the mask changes between images of 512 and 2048 pixels. shades: coloured shadows against
the reference. --samples: rays per pixel of the references (default 4096; shades take at most 1024). Always writes the tables.
"""

import argparse
import json
import math
import os
import tempfile

from driver import ROOT, write_table
from mask_file import Mask, compute_mean_error, halve, load_mask
from measure_techniques import find_reference, run

PAGE = os.path.join(ROOT, "doc", "techniques", "receiver_scatter.md")
SCENES = (("teapot_s15", 0.15), ("teapot_s50", 0.50), ("teapot_s80", 0.80))
TECHNIQUES = ("edge_count", "shadow_map")
MAP = ["shadow_map_size=2048"]
SIZE_PX = 512
TAP_COUNT = 48
GOLDEN_ANGLE_RAD = math.pi * (3.0 - math.sqrt(5.0))
# (Name in the tables, settings) of each method.
METHODS = (
    ("none", ["receiver_scatter_enabled=false"]),
    ("pixels, 48", ["receiver_scatter_method=pixels"]),
    ("pixels, 120", ["receiver_scatter_method=pixels", "receiver_scatter_samples=120"]),
    ("metres, 16", ["receiver_scatter_samples=16"]),
    ("metres, 48", []),
    ("metres, 120", ["receiver_scatter_samples=120"]),
)


def render(scene, technique, settings, out, size_px=SIZE_PX, *more):
    arguments = [word for setting in settings for word in ("--set", setting)]
    path = os.path.join(ROOT, "demo_project", "scenes", scene + ".gltf")
    run("visibility", path, "--technique", technique, "--size", "%dx%d" % (size_px, size_px), "--out", out, *arguments, *more)


def blur(mask, radius_px):
    """Blur a mask: the mean of taps spread evenly over a disc, without regard to the surfaces that they hit."""
    offsets = []
    for i in range(TAP_COUNT):
        distance, angle = radius_px * math.sqrt((i + 0.5) / TAP_COUNT), i * GOLDEN_ANGLE_RAD
        offsets.append((round(distance * math.cos(angle)), round(distance * math.sin(angle))))
    result = Mask(mask.width, mask.height)
    result.receiver = mask.receiver
    for y in range(mask.height):
        for x in range(mask.width):
            if mask.receiver[y * mask.width + x] < 0.5:
                continue
            taps = [(x + dx, y + dy) for dx, dy in offsets if 0 <= x + dx < mask.width and 0 <= y + dy < mask.height]
            total = sum(mask.visibility[v * mask.width + u] for u, v in taps)
            result.visibility[y * mask.width + x] = total / max(len(taps), 1)
    return result


def measure_errors(folder, sample_count):
    lines = ["| s | technique | method | penumbra MAE | MAE over all receivers |", "|---|---|---|---|---|"]
    reference_path, mask_path = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    for scene, scatter in SCENES:
        render(scene, find_reference(), ["reference_samples=%d" % sample_count], reference_path)
        reference = load_mask(reference_path)
        penumbra = reference.find_penumbra()
        receivers = [i for i, value in enumerate(reference.receiver) if value >= 0.5]
        for technique in TECHNIQUES:
            for name, settings in METHODS:
                render(scene, technique, settings + (MAP if technique == "shadow_map" else []), mask_path)
                mask = load_mask(mask_path)
                errors = compute_mean_error(reference, mask, penumbra), compute_mean_error(reference, mask, receivers)
                lines.append("| %g | `%s` | %s | %.4f | %.4f |" % (scatter, technique, name, *errors))
                if name == "none":
                    blurred = blur(mask, 16.0 * scatter)  # the radius of Wang, Xiao 2015: 16 s pixels
                    errors = compute_mean_error(reference, blurred, penumbra), compute_mean_error(reference, blurred, receivers)
                    lines.append("| %g | `%s` | blur, 48 taps | %.4f | %.4f |" % (scatter, technique, *errors))
    return lines


def measure_times(folder):
    names = ("scatter pixels", "scatter", "scatter average")
    lines = ["| s | method | `%s` ms | `%s` ms | `%s` ms | rest of the light ms |" % names, "|---|---|---|---|---|---|"]
    for scene, scatter in SCENES:
        for name, settings in METHODS:
            path = os.path.join(folder, "time.json")
            render(scene, TECHNIQUES[0], settings, os.path.join(folder, "mask.exr"), SIZE_PX, "--time", path)
            with open(path, encoding="utf-8") as file:
                passes = {item["name"]: item["gpu_ms"] for item in json.load(file)["passes"]}
            own = [passes.get(item, 0.0) for item in names]
            lines.append("| %g | %s | %.1f | %.1f | %.1f | %.1f |" % (scatter, name, *own, sum(passes.values()) - sum(own)))
    return lines


def is_soft(fine, x, y):
    """Return whether all 16 pixels of the fine mask that cover pixel (x, y) of the coarse mask are in penumbra."""
    indices = [(4 * y + j) * fine.width + 4 * x + i for j in range(4) for i in range(4)]
    return all(0.002 < fine.visibility[index] < 0.998 for index in indices)


def measure_resolutions(folder):
    lines = ["| s | method | mean change, all receivers | mean change, soft pixels | p99 of the change, soft pixels |", "|---|---|---|---|---|"]
    for scene, scatter in SCENES:
        for name, settings in (METHODS[1], METHODS[4]):  # 48 samples, in pixels and in metres
            masks = []
            for size_px in (SIZE_PX, 4 * SIZE_PX):
                path = os.path.join(folder, "mask.exr")
                render(scene, TECHNIQUES[0], settings, path, size_px)
                masks.append(load_mask(path))
            coarse, fine = masks[0], halve(halve(masks[1]))
            both = [i for i, value in enumerate(fine.receiver) if value >= 0.5 and coarse.receiver[i] >= 0.5]
            # Exclude hard edges on opaque surfaces, whose fine pixels are 0 or 1: the filter does not change them.
            soft = [i for i in both if is_soft(masks[1], i % SIZE_PX, i // SIZE_PX)]
            changes = sorted(abs(coarse.visibility[i] - fine.visibility[i]) for i in soft)
            lines.append(
                "| %g | %s | %.2f %% | %.2f %% | %.2f %% |"
                % (
                    scatter,
                    name,
                    100.0 * compute_mean_error(fine, coarse, both),
                    100.0 * compute_mean_error(fine, coarse, soft),
                    100.0 * changes[int(0.99 * len(changes))],
                )
            )
    return lines


def measure_shades(folder, sample_count):
    lines = ["| R in m | technique | penumbra MAE | MAE over all receivers |", "|---|---|---|---|"]
    reference, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    for size_m in (0.0, 0.08, 0.4):
        light = ["light_size=%g" % size_m]
        render("stained_glass", find_reference(), light + ["reference_samples=%d" % min(sample_count, 1024)], reference, 256)
        for technique in ("edge_count", "pcss", "shadow_map", "penumbra_fins"):
            render("stained_glass", technique, light, mask, 256)
            error = json.loads(run("compare", reference, mask))
            values = (size_m, technique, error["penumbra"]["mae"], error["receiver"]["mae"])
            lines.append("| %g | `%s` | %.4f | %.4f |" % values)
    return lines


def main():
    parser = argparse.ArgumentParser(description="Measures shadows on translucent receivers.")
    parser.add_argument("--only", choices=("errors", "times", "resolutions", "shades"))
    parser.add_argument("--samples", type=int, default=4096)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measures = {
            "errors": lambda: measure_errors(folder, arguments.samples),
            "times": lambda: measure_times(folder),
            "resolutions": lambda: measure_resolutions(folder),
            "shades": lambda: measure_shades(folder, arguments.samples),
        }
        for name in (arguments.only,) if arguments.only else measures:
            write_table(name, measures[name](), PAGE)
            print("wrote table %s" % name, flush=True)


if __name__ == "__main__":
    main()
