#!/usr/bin/env python3
"""Measures depth peeling and fins as Sun et al. 2010 do, and writes the tables of doc/benchmarks.md.

    measure_fins.py [--rounds N] [--write]

The paper (Sun, Lü, Liu, Wu 2010) gives its times as ratios: of three depth layers to one shadow map, and of a frame with
all fins to a frame with outer fins only. Each round measures all variants of a triangle count one after the other, so that
the machine's load affects both times of a ratio alike. The tables show medians over the rounds.
Without --write the tables are only printed. Build first: scons.
"""

import argparse
import json
import math
import os
import statistics
import sys
import tempfile

import driver
from driver import SCENES, format_yes_no, describe_machine, format_table, publish_tables, run

sys.path.insert(0, SCENES)
from gltf_writer import save_files  # noqa: E402
from make_scenes import AMBER, GROUND_HALF, add_ground, make_document  # noqa: E402
from shapes import make_box, make_torus_knot  # noqa: E402

GNOMON = os.path.abspath(os.environ.get("GNOMON", driver.PROGRAM))

# Triangles -> the paper's ratio: three depth layers / one shadow map, and frame with all fins / with outer fins only.
PAPER_PEELING = {2000: 1.92, 7700: 2.12, 30000: 2.19, 69000: 2.86, 97000: 2.72}
PAPER_FRAME = {30000: 1.45, 7700: 1.38, 46000: 1.46}

SIZE_PX = 800  # width and height of the image and of the maps, as in the paper
WIDTHS_M = (0.1, 0.1)  # outer and inner penumbra width, r and t
LIGHT = ("light_size=0.4", "penumbra_outer_width=%g" % WIDTHS_M[0], "penumbra_inner_width=%g" % WIDTHS_M[1])
SEGMENTS_PER_SIDE = 500 / 30  # of the study's knot: segments along it per segment around it

# Fins are made after the layers and independently of them, so two variants suffice to time two methods of each.
VARIANTS = {
    "outer": ("outer_fins",),
    "peels": ("penumbra_fins", "technique.penumbra_fins.peeling=passes", "technique.penumbra_fins.method=compute"),
    "one pass": ("penumbra_fins", "technique.penumbra_fins.peeling=one_pass", "technique.penumbra_fins.method=geometry_shader"),
    "auto": ("penumbra_fins", "technique.penumbra_fins.peeling=auto", "technique.penumbra_fins.method=auto"),
}
FRAME_VARIANTS = ("outer", "auto")

SHADOW_MAP = ("layer 1 view 0",)
PEELS = ("layer 1 view 0", "layer 2 view 0", "layer 3 view 0")
ONE_PASS = ("clear layers view 0", "layers view 0", "copy layers view 0")
GEOMETRY_SHADER = ("fins view 0",)
COMPUTE = ("clear edge counts", "find edges", "list edges", "fins view 0")


def make_knot(triangle_count):
    """The study's knot on its ground, with segments of the study's proportions and about triangle_count triangles in total."""
    quad_count = (triangle_count - len(make_box(GROUND_HALF).triangles)) / 2
    around_count = round(math.sqrt(quad_count / SEGMENTS_PER_SIDE))
    along_count = round(quad_count / around_count)
    document = make_document()
    add_ground(document)
    material = document.add_material("Amber", AMBER, roughness=0.4)
    document.add_object("Knot", make_torus_knot(0.36, 0.16, along_count, around_count), material, (0.0, 1.4, 0.0))
    return document


def measure(scene, technique, *settings):
    """Return the JSON of `visibility --time`, with `passes` replaced by pass name -> wall time in ms."""
    settings = (*LIGHT, "%s_map_size=%d" % (technique, SIZE_PX), *settings)
    arguments = [word for setting in settings for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as folder:
        mask, times = os.path.join(folder, "mask.exr"), os.path.join(folder, "time.json")
        size = "%dx%d" % (SIZE_PX, SIZE_PX)
        run([GNOMON, "visibility", scene, "--technique", technique, "--size", size, "--out", mask, "--time", times, *arguments])
        with open(times, encoding="utf-8") as file:
            result = json.load(file)
    result["passes"] = {item["name"]: item["wall_ms"] for item in result["passes"]}
    return result


def measure_rounds(round_count):
    """Return the paper's triangle count -> list of rounds, each a dictionary variant -> result of measure()."""
    rounds = {count: [] for count in sorted({*PAPER_PEELING, *PAPER_FRAME})}
    with tempfile.TemporaryDirectory() as folder:
        for count in rounds:
            save_files(make_knot(count).build_files("knot_%d" % count), folder)
        for index in range(round_count):
            for count, results in rounds.items():
                print("round %d of %d: %d triangles" % (index + 1, round_count, count), flush=True)
                scene = os.path.join(folder, "knot_%d.gltf" % count)
                variants = VARIANTS if count in PAPER_PEELING else FRAME_VARIANTS
                results.append({name: measure(scene, *VARIANTS[name]) for name in variants})
    return rounds


def find_layer_passes(result):
    """Return the passes that found the layers. A device that lacks the requested method uses the other one."""
    return ONE_PASS if "layers view 0" in result["passes"] else PEELS


def find_fin_passes(result):
    return COMPUTE if "list edges" in result["passes"] else GEOMETRY_SHADER


def sum_passes(result, names):
    missing = [name for name in names if name not in result["passes"]]
    if missing:
        raise SystemExit(
            "ERROR: the measured frame has no pass %s. Its passes: %s. Change the names in measure_fins.py."
            % (", ".join(missing), ", ".join(result["passes"]))
        )
    return sum(result["passes"][name] for name in names)


def compute_median(rounds, get_ms):
    return statistics.median(get_ms(results) for results in rounds)


def compute_passes(rounds, variant, names):
    """Return medians over the rounds: ms of these passes, and their ratio to the shadow map's pass of the same round."""

    def get_ms(results):
        return sum_passes(results[variant], names)

    def get_ratio(results):
        return get_ms(results) / sum_passes(results["outer"], SHADOW_MAP)

    return compute_median(rounds, get_ms), compute_median(rounds, get_ratio)


def describe_time(value):
    """Format (ms, ratio) as table cells. None: the device does not support the variant."""
    return ("not here", "") if value is None else ("%.2f" % value[0], "%.2f" % value[1])


def build_peeling(all_rounds):
    rows = []
    for count, paper in PAPER_PEELING.items():
        rounds = all_rounds[count]
        first = rounds[0]
        map_ms, _ = compute_passes(rounds, "outer", SHADOW_MAP)
        peels = compute_passes(rounds, "peels", PEELS)
        one_pass = None
        if find_layer_passes(first["one pass"]) == ONE_PASS:
            one_pass = compute_passes(rounds, "one pass", ONE_PASS)
        chosen = find_layer_passes(first["auto"])
        best = min(value[1] for value in (peels, one_pass) if value)
        rows.append(
            (
                first["outer"]["triangles"],
                "%.2f" % map_ms,
                *describe_time(peels),
                *describe_time(one_pass),
                "one pass" if chosen == ONE_PASS else "three peels",
                "%.2f" % compute_passes(rounds, "auto", chosen)[1],
                "%.2f" % paper,
                format_yes_no(best < paper),
            )
        )
    header = ("triangles", "shadow map ms", "three peels ms", "ratio", "one pass ms", "ratio", "`auto` takes", "ratio", "paper")
    return format_table((*header, "best is below the paper"), rows)


def build_methods(all_rounds):
    rows = []
    for count in PAPER_PEELING:
        rounds = all_rounds[count]
        first = rounds[0]
        map_ms, _ = compute_passes(rounds, "outer", SHADOW_MAP)
        compute = compute_passes(rounds, "peels", COMPUTE)
        geometry = None
        if find_fin_passes(first["one pass"]) == GEOMETRY_SHADER:
            geometry = compute_passes(rounds, "one pass", GEOMETRY_SHADER)
        is_compute_faster = geometry is None or compute[1] < geometry[1]
        rows.append(
            (
                first["outer"]["triangles"],
                "%.2f" % map_ms,
                *describe_time(geometry),
                *describe_time(compute),
                "compute" if is_compute_faster else "geometry shader",
                "compute" if find_fin_passes(first["auto"]) == COMPUTE else "geometry shader",
            )
        )
    header = ("triangles", "shadow map ms", "geometry shader ms", "ratio", "compute ms", "ratio", "faster", "`auto` takes")
    return format_table(header, rows)


def build_frames(all_rounds):
    rows = []
    for count, paper in PAPER_FRAME.items():
        rounds = all_rounds[count]
        times = [compute_median(rounds, lambda results: results[name]["frame"]["wall_ms"]) for name in FRAME_VARIANTS]
        ratios = [
            compute_median(rounds, lambda results: results["auto"][part]["wall_ms"] / results["outer"][part]["wall_ms"])
            for part in ("frame", "total")
        ]
        cells = ["%.2f" % value for value in (*times, *ratios, paper)]
        rows.append((rounds[0]["outer"]["triangles"], *cells, format_yes_no(ratios[0] < paper)))
    header = ("triangles", "outer fins ms", "penumbra fins ms", "ratio of frames", "ratio of the light's passes", "paper")
    return format_table((*header, "frame is below the paper"), rows)


def main():
    parser = argparse.ArgumentParser(description="Measures depth peeling and fins against the paper; see doc/benchmarks.md.")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="rounds of all variants (default: 3)")
    parser.add_argument("--write", action="store_true", help="write the tables into doc/benchmarks.md")
    arguments = parser.parse_args()
    if arguments.rounds < 1:
        parser.error("--rounds is %d, must be 1 or more" % arguments.rounds)
    if not os.path.isfile(GNOMON):
        raise SystemExit("ERROR: %s is missing. Run scons." % GNOMON)
    driver.PROGRAM = GNOMON  # the one that describe_machine() runs
    load = os.getloadavg()[0]
    rounds = measure_rounds(arguments.rounds)
    machine = "%s Rounds: %d." % (describe_machine(load), arguments.rounds)
    tables = {
        "fins_peeling": build_peeling(rounds) + ["", "The fins, over the same shadow map:", ""] + build_methods(rounds),
        "fins_frame": build_frames(rounds),
    }
    publish_tables(tables, machine, arguments.write)
    return 0


if __name__ == "__main__":
    sys.exit(main())
