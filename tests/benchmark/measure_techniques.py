#!/usr/bin/env python3
"""Measures errors and times of techniques and writes them into the tables of doc/techniques/*.md.

A table of errors is between `<!-- begin errors ID [property=value ...] -->` and `<!-- end errors -->`: penumbra errors of
technique ID in the six study scenes at three light sizes. `begin times` and `end times` enclose a table of times: the totals
of `visibility --time` at R = 0.4 m. References are traced once (the program caches them).

    measure_techniques.py [--only ID]... [--errors | --times]
"""

import argparse
import json
import os
import re
import sys
import tempfile

from driver import ROOT
from driver import run_gnomon as run

PAGES = os.path.join(ROOT, "doc", "techniques")
SCENES = ("sphere", "contact_box", "torus_knot", "stacked_layers", "clutter", "terrain")
SIZES_M = (0.08, 0.4, 1.2)
TIMED_SIZE_M = 0.4
MASK_SIZE = "256x256"
TABLE = re.compile(r"(<!-- begin (errors|times) (\w+)((?: \w+=\S+)*) -->\n).*?(<!-- end \2 -->)", re.DOTALL)


def find_reference():
    return next(item["id"] for item in json.loads(run("techniques", "--json")) if item["is_reference"])


def render(scene, technique, settings, out, *more):
    arguments = [word for setting in settings for word in ("--set", setting)]
    path = os.path.join(ROOT, "demo_project", "scenes", scene + ".gltf")
    run("visibility", path, "--technique", technique, "--size", MASK_SIZE, "--out", out, *arguments, *more)


def format_number(value):
    return "0" if abs(value) < 0.0005 else "%.3f" % value


def build_errors(technique, settings, reference, folder):
    lines = ["| scene | R in m | MAE | RMSE | p99 | bias | `umbra_over` |", "|---|---|---|---|---|---|---|"]
    reference_path, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    for scene in SCENES:
        for size in SIZES_M:
            light = ["light_size=%g" % size]
            render(scene, reference, light, reference_path)
            render(scene, technique, light + settings, mask)
            error = json.loads(run("compare", reference_path, mask))["penumbra"]
            names = ("mae", "rmse", "p99", "bias", "umbra_over")
            lines.append("| %s | %g | %s |" % (scene, size, " | ".join(format_number(error[name]) for name in names)))
            print(technique, *settings, lines[-1], flush=True)
    return lines


def build_times(technique, settings, folder):
    lines = ["| scene | `gpu_ms` | p90 | `wall_ms` | p90 |", "|---|---|---|---|---|"]
    mask, times = os.path.join(folder, "mask.exr"), os.path.join(folder, "time.json")
    for scene in SCENES:
        render(scene, technique, ["light_size=%g" % TIMED_SIZE_M] + settings, mask, "--time", times)
        with open(times, encoding="utf-8") as file:
            cost = json.load(file)
        names = ("gpu_ms", "gpu_ms_p90", "wall_ms", "wall_ms_p90")
        lines.append("| %s | %s |" % (scene, " | ".join("%.1f" % cost["total"][name] for name in names)))
        print(technique, *settings, lines[-1], flush=True)
    load = os.getloadavg()[0]
    machine = "%d threads, %s, %s; load of the machine %.1f." % (cost["threads"], cost["device"], cost["driver"], load)
    return lines + ["", machine]


def main():
    parser = argparse.ArgumentParser(description="Measures techniques for their pages.")
    parser.add_argument("--only", action="append", default=[], metavar="ID", help="this technique's page only")
    parser.add_argument("--errors", action="store_true", help="the tables of errors only")
    parser.add_argument("--times", action="store_true", help="the tables of times only")
    options = parser.parse_args()
    reference = find_reference()
    for name in sorted(os.listdir(PAGES)):
        if options.only and os.path.splitext(name)[0] not in options.only:
            continue
        path = os.path.join(PAGES, name)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with tempfile.TemporaryDirectory() as folder:

            def fill(match):
                begin, kind, technique, settings, end = match.groups()
                if (kind == "errors" and options.times) or (kind == "times" and options.errors):
                    return match.group(0)
                if kind == "errors":
                    lines = build_errors(technique, settings.split(), reference, folder)
                else:
                    lines = build_times(technique, settings.split(), folder)
                return begin + "\n".join(lines) + "\n" + end

            changed = TABLE.sub(fill, text)
        if changed != text:
            with open(path, "w", encoding="utf-8") as file:
                file.write(changed)
            print("Wrote %s" % os.path.relpath(path, ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
