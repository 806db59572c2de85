#!/usr/bin/env python3
"""Measures loading, building and shadow maps, and writes the tables of doc/benchmarks.md.

    run_benchmarks.py [PART]... [--build] [--jobs N] [--write]
    run_benchmarks.py --all [--write]      every table of that page: all parts, and the scripts in TABLE_SCRIPTS (hours)

Parts: load shadow_map static, and with --build also clean_build technique_build; default: all of
these. Without --write the tables are only printed. Build first: scons && scons benchmarks.
Times depend on the machine and its load, so this script never fails because of a time.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from driver import PROGRAM, ROOT, SCENES, format_yes_no, describe_machine, format_table, run, write_table

LOAD_PROGRAM = os.path.join(ROOT, "bin", "gnomon_benchmark")
PARTS = ("load", "shadow_map", "static")
BUILD_PARTS = ("clean_build", "technique_build")
TIMED_SCENES = ("torus_knot", "terrain")
# The other scripts that write tables into doc/benchmarks.md.
TABLE_SCRIPTS = (
    "measure_edge_count",
    "measure_fins",
    "measure_volumes",
    "measure_lean",
    "measure_report",
    "measure_editor",
    "measure_device",
)
TOUCHED_FILE = "modules/shadow_map/shadow_map.cpp"
REPEATS = 3  # of `visibility --time`, each the median of 20 frames


def copy_tree(target):
    for name in run(["git", "ls-files", "-z"]).split("\0"):
        source = os.path.join(ROOT, name)
        if name and os.path.isfile(source):
            os.makedirs(os.path.dirname(os.path.join(target, name)), exist_ok=True)
            shutil.copy2(source, os.path.join(target, name))


def measure_load():
    """Measure loading the bunny and building its adjacency."""
    if not os.path.isfile(LOAD_PROGRAM):
        raise SystemExit("ERROR: %s is missing. Run `scons benchmarks`." % LOAD_PROGRAM)
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "bunny.gltf")
        run([sys.executable, os.path.join(SCENES, "make_bunny.py"), scene])
        result = json.loads(run([LOAD_PROGRAM, scene]))
    return format_table(
        ("bunny and ground", "median of %d runs" % result["runs"], "goal", "met"),
        [
            ("triangles, edges", "%d, %d" % (result["triangles"], result["edges"]), "", ""),
            ("load the file", "%.3f s" % result["load_s"], "", ""),
            ("build the adjacency", "%.3f s" % result["topology_s"], "", ""),
            ("both", "%.3f s" % result["total_s"], "< 0.5 s", format_yes_no(result["total_s"] < 0.5)),
        ],
    )


def measure_passes(scene, technique):
    """Return pass name -> median wall time in ms over REPEATS measurements. The name "" is the total."""
    samples = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(REPEATS):
            times = os.path.join(folder, "time.json")
            run([PROGRAM, "visibility", os.path.join(SCENES, scene + ".gltf"), "--technique", technique, "--size", "512x512",
                 "--out", os.path.join(folder, "mask.exr"), "--time", times])  # fmt: skip
            with open(times, encoding="utf-8") as file:
                result = json.load(file)
            for item in result["passes"]:
                samples.setdefault(item["name"], []).append(item["wall_ms"])
            samples.setdefault("", []).append(result["total"]["wall_ms"])
    return {name: statistics.median(values) for name, values in samples.items()}


def measure_shadow_map():
    """Measure what a hard shadow map costs beyond drawing its depth: 512 x 512 pixels, a map of 1024 x 1024 texels."""
    rows = []
    for scene in TIMED_SCENES:
        passes = measure_passes(scene, "shadow_map")
        depth = sum(value for name, value in passes.items() if name.startswith("depth view"))
        compare = passes.get("resolve", 0.0)
        receivers = passes.get("receivers", 0.0)  # a pass of the shadow system, the same for every technique
        total = passes[""]
        rest = max(0.0, total - depth - compare - receivers)
        rows.append(
            (scene, "%.1f" % depth, "%.1f" % compare, "%.1f" % receivers, "%.1f" % rest, "%.1f" % total,
             "%.2f" % (total / depth), format_yes_no(rest <= 0.1 * depth))  # fmt: skip
        )
    header = ("scene", "depth pass ms", "compare ms", "receivers ms", "rest ms", "total ms", "total / depth", "rest <= 10 % of depth")
    return format_table(header, rows)


def measure_static():
    """Count the depth passes that the second frame of a static scene still draws."""
    rows = []
    for scene in TIMED_SCENES:
        with tempfile.TemporaryDirectory() as folder:
            output = run([PROGRAM, "visibility", os.path.join(SCENES, scene + ".gltf"), "--technique", "shadow_map", "--size", "256x256",
                          "--frames", "2", "--plan", "--out", os.path.join(folder, "mask.exr")])  # fmt: skip
        cached = re.findall(r"(?m)^.*light view \d+.*cached.*$", output)
        drawn = re.findall(r"(?m)^.*depth view.*$", output)
        rows.append((scene, len(drawn), len(cached), format_yes_no(not drawn and bool(cached))))
    return format_table(("scene", "depth passes in frame 2", "views cached", "nothing is redrawn"), rows)


def measure_clean_build(jobs):
    """Measure the build of bin/gnomon and bin/gnomon_tests from a fresh checkout."""
    with tempfile.TemporaryDirectory() as folder:
        copy_tree(folder)
        start = time.monotonic()
        run(["scons", "-Q", "-j%d" % jobs, "compiledb=no"], folder)
        seconds = time.monotonic() - start
    text = "%d min %02d s" % (seconds // 60, seconds % 60)
    return format_table(("clean build, %d jobs" % jobs, "goal on 2 cores", "met"), [(text, "<= 6 min", format_yes_no(seconds <= 360))])


def measure_technique_build(jobs):
    """Measure the rebuild of both programs after a change in a technique's .cpp."""
    with tempfile.TemporaryDirectory() as folder:
        copy_tree(folder)
        for name in ("build/release", "bin"):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(folder, name))
        build = ["scons", "-Q", "-j%d" % jobs, "compiledb=no"]
        run(build, folder)  # builds what the copy still lacks
        with open(os.path.join(folder, TOUCHED_FILE), "a", encoding="utf-8") as file:
            file.write("\n// touched\n")
        start = time.monotonic()
        run(build, folder)
        seconds = time.monotonic() - start
    return format_table(
        ("rebuild after a change in %s" % TOUCHED_FILE, "goal", "met"), [("%.1f s" % seconds, "< 20 s", format_yes_no(seconds < 20))]
    )


def main():
    parser = argparse.ArgumentParser(description="Measures loading, building and the shadow map; see doc/benchmarks.md.")
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS + BUILD_PARTS))
    parser.add_argument("--build", action="store_true", help="also the parts that build (minutes)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--all", action="store_true", help="every table of doc/benchmarks.md (hours)")
    parser.add_argument("--write", action="store_true", help="write the tables into doc/benchmarks.md")
    arguments = parser.parse_args()
    unknown = [part for part in arguments.parts if part not in PARTS + BUILD_PARTS]
    if unknown:
        parser.error("unknown part %s, must be one of: %s" % (", ".join(unknown), ", ".join(PARTS + BUILD_PARTS)))
    if not os.path.isfile(PROGRAM):
        raise SystemExit("ERROR: %s is missing. Run scons." % PROGRAM)
    measures = {
        "load": measure_load,
        "shadow_map": measure_shadow_map,
        "static": measure_static,
        "clean_build": lambda: measure_clean_build(arguments.jobs),
        "technique_build": lambda: measure_technique_build(arguments.jobs),
    }
    for part in arguments.parts or PARTS + (BUILD_PARTS if arguments.build or arguments.all else ()):
        load = os.getloadavg()[0]
        lines = measures[part]() + ["", describe_machine(load)]
        print("\n%s\n%s" % (part, "\n".join(lines)), flush=True)
        if arguments.write:
            write_table(part, lines)
    for name in TABLE_SCRIPTS if arguments.all else ():
        script = os.path.join(ROOT, "tests", "benchmark", name + ".py")
        print("\n== %s" % name, flush=True)
        subprocess.run([sys.executable, script, *(["--write"] if arguments.write else [])], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
