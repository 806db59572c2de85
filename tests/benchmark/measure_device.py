#!/usr/bin/env python3
"""Times the techniques of TECHNIQUES on this machine's device at screen resolutions, and compares their masks with the reference.

    measure_device.py [--write] [--out FILE.json] [--device NAME] [--scenes A,B] [--sizes 1920x1080,3840x2160]
    measure_device.py --from FILE.json --write   writes the tables of an earlier run's --out, measures nothing

Scenes are those of demo_project/scenes with their first light, at its own size. Times are sums of the passes' GPU times, as medians of 20
frames in which everything moves. Errors are those of 512 x 512 masks. --write puts the tables into doc/benchmarks.md between
`<!-- begin device NAME -->` and its end marker, where NAME is the device's name. A new device gets a new section.
"""

import argparse
import json
import os
import re
import sys
import tempfile

from driver import PAGE, SCENES
from driver import run_gnomon as run

DEVICE_SCENES = ("sphere", "contact_box", "torus_knot", "stacked_layers", "clutter", "terrain", "kitbash", "courtyard")
TECHNIQUES = ("edge_count", "pcss", "penumbra_fins", "outer_fins", "shadow_volume", "jittered_pcf", "shadow_map", "views")
ERROR_SIZE = "512x512"


def measure(options, scene, size, technique, folder):
    """Return the JSON that `visibility --time` writes. options: arguments that select the device."""
    times = os.path.join(folder, "times.json")
    run("visibility", os.path.join(SCENES, scene + ".gltf"), "--technique", technique, "--size", size, "--time", times,
        "--out", os.path.join(folder, "timed.exr"), *options)
    with open(times, encoding="utf-8") as file:
        return json.load(file)


def measure_error(options, scene, technique, folder):
    reference, mask = os.path.join(folder, scene + "_reference.exr"), os.path.join(folder, "mask.exr")
    mask_arguments = ["visibility", os.path.join(SCENES, scene + ".gltf"), "--size", ERROR_SIZE, *options]
    if not os.path.exists(reference):
        run(*mask_arguments, "--technique", "reference", "--out", reference)
    run(*mask_arguments, "--technique", technique, "--out", mask)
    return json.loads(run("compare", reference, mask))["penumbra"]["mae"]


def build_tables(results):
    lines = []
    for size, rows in results["times"].items():
        lines += ["%s, ms of GPU time a light:" % size.replace("x", " x "), "", "| scene | %s |" % " | ".join("`%s`" % name for name in TECHNIQUES)]
        lines.append("|---" * (len(TECHNIQUES) + 1) + "|")
        for scene, cells in rows.items():
            lines.append("| `%s` | %s |" % (scene, " | ".join("%.2f" % cells[name] for name in TECHNIQUES)))
        lines.append("")
    lines += ["Penumbra MAE at 512 x 512:", "", "| scene | %s |" % " | ".join("`%s`" % name for name in TECHNIQUES)]
    lines.append("|---" * (len(TECHNIQUES) + 1) + "|")
    for scene, cells in results["errors"].items():
        lines.append("| `%s` | %s |" % (scene, " | ".join("%.4f" % cells[name] for name in TECHNIQUES)))
    return lines + ["", "%s, %s." % (results["device"], results["driver"])]


def write(results):
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    begin, end = "<!-- begin device %s -->\n" % results["device"], "<!-- end device -->"
    body = begin + "\n".join(build_tables(results)) + "\n" + end
    pattern = re.compile(re.escape(begin) + r".*?" + re.escape(end), re.DOTALL)
    if pattern.search(text):
        text = pattern.sub(lambda _match: body, text)
    else:
        marker = "<!-- devices -->\n"
        text = text.replace(marker, "%s\n### %s\n\n%s\n" % (marker, results["device"], body))
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    parser = argparse.ArgumentParser(description="Times these techniques on a device: %s." % ", ".join(TECHNIQUES))
    parser.add_argument("--write", action="store_true", help="write the tables into doc/benchmarks.md")
    parser.add_argument("--from", dest="source", metavar="FILE", help="JSON of an earlier run, instead of measuring")
    parser.add_argument("--out", metavar="FILE", help="write the results as JSON")
    parser.add_argument("--device", metavar="NAME")
    parser.add_argument("--scenes", default=",".join(DEVICE_SCENES))
    parser.add_argument("--sizes", default="1920x1080,3840x2160")
    arguments = parser.parse_args()
    options = ["--device", arguments.device] if arguments.device else []
    results = {"times": {}, "passes": {}, "errors": {}}
    if arguments.source:
        with open(arguments.source, encoding="utf-8") as file:
            results = json.load(file)
    with tempfile.TemporaryDirectory() as folder:
        for _warm_up in range(0 if arguments.source else 4): # a GPU at rest runs at a lower clock
            measure(options, arguments.scenes.split(",")[0], arguments.sizes.split(",")[-1], "views", folder)
        for size in arguments.sizes.split(",") if not arguments.source else ():
            for scene in arguments.scenes.split(","):
                for technique in TECHNIQUES:
                    cost = measure(options, scene, size, technique, folder)
                    results["device"], results["driver"] = cost["device"], cost["driver"]
                    results["times"].setdefault(size, {}).setdefault(scene, {})[technique] = cost["total"]["gpu_ms"]
                    results["passes"].setdefault(size, {}).setdefault(scene, {})[technique] = {
                        item["name"]: item["gpu_ms"] for item in cost["passes"]}
                print(size, scene, {name: round(ms, 2) for name, ms in results["times"][size][scene].items()}, flush=True)
        for scene in arguments.scenes.split(",") if not arguments.source else ():
            results["errors"][scene] = {name: measure_error(options, scene, name, folder) for name in TECHNIQUES}
            print(scene, {name: round(mae, 4) for name, mae in results["errors"][scene].items()}, flush=True)
    if arguments.out:
        with open(arguments.out, "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)
    if arguments.write:
        write(results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
