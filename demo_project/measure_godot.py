#!/usr/bin/env python3
"""Measures the add-on inside $GODOT next to Godot's own shadows, and writes the page of the Godot demo.

Godot renders demo_project/godot's study scenes with shadows of edge_count and with its own, of the qualities Soft Low and Soft
Ultra; what is compared is the image with the shadow over that without. `gnomon visibility --technique reference` traces the same
scenes, which Godot exported. Errors are root mean squares over the penumbra's pixels (doc/benchmarks.md), times are what
a moving light adds to a frame without shadows, medians.
"""

import argparse
import array
import json
import os
import shutil
import struct
import subprocess
import sys
import zlib

import godot_project
from godot_page import write_page

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "tests", "benchmark"))
from mask_file import load_mask  # noqa: E402

GNOMON = os.path.join(ROOT, "bin", "gnomon")
WORK = os.path.join(ROOT, "build", "godot_demo")  # Godot may see nothing outside of the project
MODES = ("gnomon", "low", "ultra")


def run_gnomon(arguments):
    done = subprocess.run([GNOMON] + arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit("ERROR: gnomon %s\n%s" % (" ".join(arguments), done.stderr))
    return done.stdout


def save_gray_png(path, values, width):
    """Values of 0..1 as 8 bits; below 0, no receiver, a dark violet."""
    rows = bytearray()
    for first in range(0, len(values), width):
        rows.append(0)
        for value in values[first : first + width]:
            gray = round(255 * min(value, 1.0))
            rows += bytes((gray, gray, gray)) if value >= 0.0 else b"\x30\x10\x38"
    parts = [(b"IHDR", struct.pack(">2I5B", width, len(values) // width, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(bytes(rows), 6))]
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in parts + [(b"IEND", b"")]:
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def compute_rmse(reference, values):
    """Over the reference's penumbra, where both have a receiver."""
    pixels = [pixel for pixel in reference.find_penumbra() if values[pixel] >= 0.0]
    if not pixels:
        raise SystemExit("ERROR: no pixel is in the penumbra: this is not the study scene.")
    return (sum((values[pixel] - reference.visibility[pixel]) ** 2 for pixel in pixels) / len(pixels)) ** 0.5


def measure_case(case, times, options):
    stem = os.path.join(WORK, case)
    size = "%dx%d" % (options.size, options.size)
    arguments = ["visibility", stem + ".gltf", "--technique", "reference", "--out", stem + "_reference.exr", "--size", size]
    run_gnomon(arguments + ["--png", stem + "_reference.png", "--depth-alone", "--set", "reference_samples=%d" % options.samples])
    reference = load_mask(stem + "_reference.exr")
    row = {"case": case, "rmse": {}, "added_ms": {}}
    for mode in MODES:
        values, height = godot_project.load_raw("%s_%s.f32" % (stem, mode), options.size)
        row["rmse"][mode] = compute_rmse(reference, values)
        row["added_ms"][mode] = times[mode] - times["off"]
        save_gray_png("%s_%s.png" % (stem, mode), values, options.size)
        # Where one alone has a receiver there is no error to show.
        shown = array.array("f", values)
        for pixel, receiver in enumerate(reference.receiver):
            shown[pixel] = -1.0 if receiver < 0.5 else values[pixel] if values[pixel] >= 0.0 else reference.visibility[pixel]
        godot_project.save_exr("%s_%s.exr" % (stem, mode), shown, options.size, height)
        run_gnomon(["compare", stem + "_reference.exr", "%s_%s.exr" % (stem, mode), "--heatmap", "%s_%s_error.png" % (stem, mode)])
    print("%-20s" % case, *("%s %.4f, +%.1f ms" % (mode, row["rmse"][mode], row["added_ms"][mode]) for mode in MODES), flush=True)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--out", required=True, help="where index.html and its images go")
    parser.add_argument("--size", type=int, default=800, help="of images, in pixels")
    parser.add_argument("--frames", type=int, default=20, help="that each mode is timed for")
    parser.add_argument("--samples", type=int, default=9216, help="light samples of the reference")
    parser.add_argument("--cases", default="", help="LIGHT_CASTER, separated by commas; all of them without")
    options = parser.parse_args()
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    godot_project.prepare()
    common = ["out=" + WORK, "size=%d" % options.size]
    output = godot_project.run("res://study/pictures.tscn", common, options.size)
    output += godot_project.run(
        "res://study/measure.tscn", common + ["frames=%d" % options.frames, "cases=" + options.cases], options.size
    )
    messages = godot_project.find_messages(output)
    for message in messages:
        print("Godot logged " + message)
    with open(os.path.join(WORK, "times.json"), encoding="utf-8") as file:
        times = json.load(file)
    rows = [measure_case(case, times[case], options) for case in times]
    results = {"godot": godot_project.get_version(), "size": options.size, "frames": options.frames, "rows": rows}
    with open(os.path.join(WORK, "results.json"), "w", encoding="utf-8") as file:
        json.dump(results, file, indent="\t")
    os.makedirs(options.out, exist_ok=True)
    for name in os.listdir(WORK):
        if name.endswith((".png", ".json")):
            shutil.copy(os.path.join(WORK, name), options.out)
    open(os.path.join(options.out, ".gdignore"), "w").close()  # nothing for Godot to import
    write_page(os.path.join(options.out, "index.html"), results)
    return 1 if messages or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
