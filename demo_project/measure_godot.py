#!/usr/bin/env python3
"""Measures the add-on inside $GODOT next to Godot's own shadows, and writes the page of the Godot demo.

Godot renders demo_project/godot's study scenes with shadows of edge_count and with its own, of the qualities Soft Low and
Soft Ultra. The image with shadows, divided by the image without, is compared with a reference, traced by
`gnomon visibility --technique reference` in the same scenes, which Godot exports. Errors are root mean squares over the
penumbra's pixels (doc/glossary.md). Times are what the shadow of a moving light adds: the median frame time with it minus
the median without. The room is measured with all its lights, and its times are those of whole frames.
"""

import argparse
import array
import json
import os
import shutil
import subprocess
import sys

import godot_images
import godot_project
from godot_page import write_page

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "tests", "benchmark"))
from mask_file import Mask, load_mask  # noqa: E402

GNOMON = os.path.join(ROOT, "bin", "gnomon")
WORK = os.path.join(ROOT, "build", "godot_demo")  # inside the repository, because Debian's Godot may see nothing else
MIN_BEND = 0.002  # at an outline: second difference of near / z, relative to near / z
MODES = ("gnomon", "low", "ultra")
ROOM_SAMPLES = 1024  # max. for each of its lights: with 9216 samples the errors are the same
MIN_LIGHT_FRACTION = 0.05  # a light's penumbra counts only where it gives at least this fraction of the pixel's light


def run_gnomon(arguments):
    done = subprocess.run([GNOMON] + arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit("ERROR: gnomon %s\n%s" % (" ".join(arguments), done.stderr))
    return done.stdout


def trace_reference(scene, light, stem, size_px, samples, camera=""):
    """Return the traced mask of one light of an exported scene; writes STEM.exr and STEM.png. size_px: (width, height)."""
    arguments = ["visibility", scene, "--technique", "reference", "--light", light, "--out", stem + ".exr", "--png", stem + ".png"]
    arguments += ["--size", "%dx%d" % size_px, "--depth-alone", "--set", "reference_samples=%d" % samples]
    run_gnomon(arguments + (["--camera", camera] if camera else []))
    return load_mask(stem + ".exr")


def compute_rmse(reference, values, pixels):
    """Return the root mean square error over those of the pixels where the values have a receiver (are not -1).

    Exits if there is none.
    """
    pixels = [pixel for pixel in pixels if values[pixel] >= 0.0]
    if not pixels:
        raise SystemExit("ERROR: no receiver is in a penumbra. Check the light's size and the camera.")
    return (sum((values[pixel] - reference.visibility[pixel]) ** 2 for pixel in pixels) / len(pixels)) ** 0.5


def show_error(name, reference, values, mode, options):
    """Write WORK/NAME_MODE_error.png; needs WORK/NAME_reference.exr."""
    stem = os.path.join(WORK, name)
    # Where only one of the two has a receiver, no error is shown.
    shown = array.array("f", values)
    for pixel, receiver in enumerate(reference.receiver):
        shown[pixel] = -1.0 if receiver < 0.5 else values[pixel] if values[pixel] >= 0.0 else reference.visibility[pixel]
    godot_images.save_exr("%s_%s.exr" % (stem, mode), shown, options.size, len(shown) // options.size)
    run_gnomon(["compare", stem + "_reference.exr", "%s_%s.exr" % (stem, mode), "--heatmap", "%s_%s_error.png" % (stem, mode)])


def measure_case(case, described, options):
    """Return a row of results for the page. described: the case's entry in cases.json."""
    stem = os.path.join(WORK, case)
    size_px = (options.size, options.size)
    reference = trace_reference(stem + ".gltf", described["light"], stem + "_reference", size_px, options.samples)
    penumbra = set(reference.find_penumbra()) - find_outlines(stem + ".gltf", options)
    times = described["times"]
    row = {"case": case, "rmse": {}, "added_ms": {}}
    for mode in MODES:
        values, _height = godot_images.load_rows("%s_%s.f32" % (stem, mode), options.size)
        row["rmse"][mode] = compute_rmse(reference, values, penumbra)
        row["added_ms"][mode] = times[mode] - times["off"]
        godot_images.save_gray_png("%s_%s.png" % (stem, mode), values, options.size)
        show_error(case, reference, values, mode, options)
    print("%-20s" % case, *("%s %.4f, +%.1f ms" % (mode, row["rmse"][mode], row["added_ms"][mode]) for mode in MODES), flush=True)
    return row


def find_outlines(scene, options):
    """Return the pixels where a surface of the scene ends or bends, and two rasterizers may see different surfaces."""
    folder = os.path.join(WORK, "surfaces")
    os.makedirs(folder, exist_ok=True)
    # Only the depth is used; any technique would do.
    arguments = ["visibility", scene, "--technique", "pcss", "--out", os.path.join(WORK, "surfaces.exr")]
    run_gnomon(arguments + ["--size", "%dx%d" % (options.size, options.size), "--surfaces", folder])
    depth, _height = godot_images.load_rows(os.path.join(folder, "depth.f32"), options.size)  # near / z, linear on planes
    outlines = set()
    for step in (1, options.size):
        for i in range(step, len(depth) - step):
            if abs(depth[i - step] + depth[i + step] - 2 * depth[i]) > MIN_BEND * depth[i]:
                outlines.add(i)
    return outlines


def load_room_image(what, options):
    values, _height = godot_images.load_rows(os.path.join(WORK, "room_%s.f32" % what), 3 * options.size)
    return values


def add_room_light(light, dark, off, image, options):
    """Add the image of one light, times its traced visibility, to image; return (penumbra pixels, receivers).

    dark: RGB without lights. off: luminance with all lights, without shadows.
    """
    alone = load_room_image("only_" + light, options)
    stem = os.path.join(WORK, "room")
    size_px = (options.size, options.size)
    mask = trace_reference(stem + ".gltf", light, stem + "_reference_" + light, size_px, min(options.samples, ROOM_SAMPLES))
    for pixel, visibility in enumerate(mask.visibility):
        for channel in range(3 * pixel, 3 * pixel + 3):
            image[channel] += visibility * (alone[channel] - dark[channel])
    alone, dark = godot_images.get_luminance(alone), godot_images.get_luminance(dark)
    return [i for i in mask.find_penumbra() if alone[i] - dark[i] >= MIN_LIGHT_FRACTION * off[i]], mask.receiver


def divide_luminance(rgb, off):
    """Return each pixel's luminance as a fraction of the unshadowed image's; 1 where that is black."""
    return array.array("f", (a / b if b > 0.0 else 1.0 for a, b in zip(godot_images.get_luminance(rgb), off)))


def measure_room(options):
    """Measure the room. Its reference is the sum of images with one light each, times the visible fraction of that light."""
    with open(os.path.join(WORK, "room.json"), encoding="utf-8") as file:
        room = json.load(file)
    dark = load_room_image("dark", options)
    off = godot_images.get_luminance(load_room_image("off", options))
    image = array.array("f", dark)
    penumbra = set()
    receivers = array.array("f", bytes(4 * len(off)))
    for light in room["lights"]:
        of_light, lit = add_room_light(light, dark, off, image, options)
        penumbra.update(of_light)
        receivers = array.array("f", map(max, receivers, lit))
    penumbra -= find_outlines(os.path.join(WORK, "room.gltf"), options)
    reference = Mask(options.size, len(off) // options.size)
    reference.receiver = receivers
    reference.visibility = divide_luminance(image, off)
    stem = os.path.join(WORK, "room_")
    shown = array.array("f", (v if r >= 0.5 else -1.0 for v, r in zip(reference.visibility, receivers)))
    godot_images.save_exr(stem + "reference.exr", shown, options.size, reference.height)
    godot_images.save_color_png(stem + "reference.png", image, options.size)
    room["rmse"] = {}
    for mode in MODES:
        rgb = load_room_image(mode, options)
        values = divide_luminance(rgb, off)
        room["rmse"][mode] = compute_rmse(reference, values, penumbra)
        godot_images.save_color_png(stem + mode + ".png", rgb, options.size)
        show_error("room", reference, values, mode, options)
        print("room, %d lights: %s %.4f" % (len(room["lights"]), mode, room["rmse"][mode]), flush=True)
    for count, times in room["times"].items():
        print("room, frame with %s lights:" % count, ", ".join("%s %.1f ms" % pair for pair in times.items()), flush=True)
    return room


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--out", required=True, help="where index.html and its images go")
    parser.add_argument("--size", type=int, default=800, help="width and height of images, in pixels")
    parser.add_argument("--frames", type=int, default=20, help="frames over which each mode is timed")
    parser.add_argument("--samples", type=int, default=9216, help="light samples of the reference")
    parser.add_argument("--cases", default="", help="LIGHT_CASTER, separated by commas (default: all)")
    parser.add_argument("--scenes", default="", help="more glTF files, inside the repository, separated by commas")
    options = parser.parse_args()
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    godot_project.prepare()
    common = ["out=" + WORK, "size=%d" % options.size]
    output = godot_project.run("res://study/screenshots.tscn", common, options.size)
    output += godot_project.run(
        "res://study/measure.tscn", common + ["frames=%d" % options.frames, "cases=" + options.cases, "scenes=" + options.scenes], options.size
    )
    output += godot_project.run("res://study/measure_room.tscn", common + ["frames=%d" % options.frames], options.size)
    messages = godot_project.find_messages(output)
    for message in messages:
        print("Godot logged " + message)
    with open(os.path.join(WORK, "cases.json"), encoding="utf-8") as file:
        rows = [measure_case(case, described, options) for case, described in json.load(file).items()]
    results = {"godot": godot_project.get_version(), "size": options.size, "frames": options.frames, "rows": rows}
    results["room"] = measure_room(options)
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
