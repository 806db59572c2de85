#!/usr/bin/env python3
"""Measures edge_count against its goals and writes the tables of doc/benchmarks.md.

    measure_edge_count.py [--rounds N] [--size WxH] [--scenes A,B] [--write]

The study's six scenes at three light sizes, with R = (r + t) / 2. Each round measures all configurations of a scene
and a size one after the other, so that both parts of a ratio come from the same minute; the tables show medians
over the rounds. Truths have 9216 samples and are traced once (the program keeps them in its cache).
Without --write the tables are printed only. Build first: scons.
"""

import argparse
import json
import os
import re
import statistics
import sys
import tempfile

import run_benchmarks
from measure_techniques import SCENES, SIZES_M, find_reference
from run_benchmarks import answer, describe_machine, format_table, publish_tables, run

GNOMON = os.path.abspath(os.environ.get("GNOMON", run_benchmarks.PROGRAM))

TRUTH_SAMPLES = 9216
LARGE_M = SIZES_M[-1]  # 30 % of the scenes' size; the others are 10 % of it or less
CROWDED_SCENES = ("clutter",)  # many casters over each other: a goal of their own
SINGLE_SCENES = ("sphere", "contact_box")  # one caster and its ground
RECEIVERS_PASS = "receivers"  # the renderer's, for whatever technique

EDGE_COUNT = ("edge_count",)
# Technique and its settings. They are timed in this order.
CONFIGURATIONS = {
    "edge_count": EDGE_COUNT,
    "coarse": ("edge_count", "edge_count_quality=64"),
    "pcss": ("pcss", "pcss_taps=64"),
    # Counts no edges: a depth map and a filter of 64 + 64 taps wherever a block of 16 x 16 pixels has an edge, the exact
    # number of solids before the light's centre elsewhere.
    "skipping": ("edge_count", "edge_count_budget=0"),
}
MAPS = {
    "small map": ("edge_count", "edge_count_map_size=256"),
    "large map": ("edge_count", "edge_count_map_size=1024"),
}

MEMORY_SIZE = "1920x1080"
SMALLEST_SIZE = "16x16"
MEMORY_LIGHT_M = 0.4
MEMORY_LIGHTS = [(scene, None) for scene in SCENES] + [("three_lights", "Omni")]
# What any technique needs beside its own: G-buffer, receivers, mask. Its map has 1 KB a view.
BASELINE = ("shadow_map", "shadow_map_size=16")
MB = 1e6

SHOWN_PASSES = 3


class Row:
    """One scene at one light size."""

    def __init__(self, scene, size_m):
        self.scene = scene
        self.size_m = size_m
        self.name = "%s, R = %g" % (scene, size_m)
        self.errors = {}  # configuration -> penumbra errors
        self.rounds = []  # of each: configuration -> pass -> ms

    def compute_ms(self, configuration):
        return statistics.median(sum(passes[configuration].values()) for passes in self.rounds)

    def compute_ratio(self, configuration, other):
        return statistics.median(sum(passes[configuration].values()) / sum(passes[other].values()) for passes in self.rounds)

    def find_costly_passes(self, configuration):
        """Names and ms of those that take longest."""
        names = {name for passes in self.rounds for name in passes[configuration]}
        times = {name: statistics.median(passes[configuration].get(name, 0.0) for passes in self.rounds) for name in names}
        return sorted(times.items(), key=lambda item: -item[1])[:SHOWN_PASSES]


def report_progress(*words):
    print(*words, file=sys.stderr, flush=True)


def draw(scene, size_m, size, configuration, out, *more):
    """One mask of a light with r = t = R."""
    technique, *settings = configuration
    settings = ("light_size=%g" % size_m, "penumbra_outer_width=-1", "penumbra_inner_width=-1", *settings)
    words = [word for setting in settings for word in ("--set", setting)]
    path = os.path.join(run_benchmarks.SCENES, scene + ".gltf")
    run([GNOMON, "visibility", path, "--technique", technique, "--size", size, "--out", out, *words, *more])


def draw_timed(scene, size_m, size, configuration, out, *more):
    """The same, and what `--time` writes."""
    times = out + ".json"
    draw(scene, size_m, size, configuration, out, "--time", times, *more)
    with open(times, encoding="utf-8") as file:
        return json.load(file)


def get_pass_times(result):
    """ms by pass, without the renderer's; the views of one light together."""
    if all(item["name"] != RECEIVERS_PASS for item in result["passes"]):
        raise SystemExit(
            "ERROR: the measured light has no pass %s. Its passes: %s. Change RECEIVERS_PASS in measure_edge_count.py."
            % (RECEIVERS_PASS, ", ".join(item["name"] for item in result["passes"]))
        )
    times = {}
    for item in result["passes"]:
        if item["name"] != RECEIVERS_PASS:
            name = re.sub(r" view \d+( attempt \d+)?$", "", item["name"])
            times[name] = times.get(name, 0.0) + item["wall_ms" if item["is_on_host"] else "gpu_ms"]
    return times


def compare(row, truth, mask):
    errors = json.loads(run([GNOMON, "compare", truth, mask]))["penumbra"]
    if errors["pixels"] == 0:
        raise SystemExit("ERROR: %s: no pixel is in the penumbra. Use a larger --size." % row.name)
    return errors


def measure_errors(rows, size):
    """All errors: they are the same each time, so that once is enough. Nothing is timed here."""
    reference = find_reference()
    exact = (reference, "%s_samples=%d" % (reference, TRUTH_SAMPLES))
    with tempfile.TemporaryDirectory() as folder:
        truth, mask = os.path.join(folder, "truth.exr"), os.path.join(folder, "mask.exr")
        for index, row in enumerate(rows):
            report_progress("errors, %d of %d: %s" % (index + 1, len(rows), row.name))
            draw(row.scene, row.size_m, size, exact, truth)
            for name, configuration in {**CONFIGURATIONS, **MAPS}.items():
                draw(row.scene, row.size_m, size, configuration, mask)
                row.errors[name] = compare(row, truth, mask)


def measure_times(rows, size, round_count):
    with tempfile.TemporaryDirectory() as folder:
        mask = os.path.join(folder, "mask.exr")
        for index in range(round_count):
            for row in rows:
                passes = {
                    name: get_pass_times(draw_timed(row.scene, row.size_m, size, configuration, mask))
                    for name, configuration in CONFIGURATIONS.items()
                }
                row.rounds.append(passes)
                totals = ", ".join("%s %.1f ms" % (name, sum(times.values())) for name, times in passes.items())
                report_progress("round %d of %d: %s: %s" % (index + 1, round_count, row.name, totals))


def measure_memory(scenes):
    """MB of each light, beside what any technique needs."""
    memory = {}
    with tempfile.TemporaryDirectory() as folder:
        mask = os.path.join(folder, "mask.exr")

        def measure_bytes(scene, light, size):
            more = ["--light", light] if light else []
            used = [
                draw_timed(scene, MEMORY_LIGHT_M, size, configuration, mask, *more)["bytes"]
                for configuration in (EDGE_COUNT, BASELINE)
            ]
            return used[0] - used[1]

        for scene, light in MEMORY_LIGHTS:
            if scene in SCENES and scene not in scenes:
                continue
            # `bytes` holds once what is kept, and twice what lives within a frame: of the frame that reads the mask back
            # and of those that are timed. Only the latter grows with the picture, so that the mean has each once.
            name = "%s, %s" % (scene, light) if light else scene
            memory[name] = statistics.fmean(measure_bytes(scene, light, size) for size in (SMALLEST_SIZE, MEMORY_SIZE)) / MB
            report_progress("memory of %s: %.1f MB" % (name, memory[name]))
    return memory


def judge(what, goal, values, combine, form="%.4f"):
    """A row of the goals. values: by name, so that the worst can be named; none when --scenes leaves out all of them.
    goal: "<= number", perhaps with a unit."""
    if not values:
        return (what, goal, "not measured", "")
    value = combine(values.values())
    measured = form % value
    if combine is max and min(values.values()) < value:
        measured += " (%s)" % max(values, key=values.get)
    return (what, goal, measured, answer(value <= float(goal.split()[1])))


def build_error_goals(rows):
    mae = {row.name: row.errors["edge_count"]["mae"] for row in rows}
    p99 = {row.name: row.errors["edge_count"]["p99"] for row in rows}
    umbra_over = {row.name: round(row.errors["edge_count"]["umbra_over"], 4) for row in rows}
    single = {row.name: mae[row.name] for row in rows if row.scene in SINGLE_SCENES}
    small, large = (statistics.fmean(row.errors[name]["mae"] for row in rows) for name in MAPS)
    change = 100 * (small - large) / large
    return [
        judge("penumbra MAE, mean", "<= 0.003", mae, statistics.fmean),
        judge("penumbra MAE, worst", "<= 0.02", mae, max),
        judge("penumbra p99, mean", "<= 0.02", p99, statistics.fmean),
        judge("`umbra_over`, worst", "<= 0", umbra_over, max),
        judge("penumbra MAE, worst of %s" % " and ".join(SINGLE_SCENES), "<= 0.001", single, max),
        ("mean MAE, maps of 256 against 1024", "< 5 %", "%+.1f %%" % change, answer(abs(change) < 5)),
    ]


def build_time_goals(rows):
    ratios = {row.name: row.compute_ratio("edge_count", "pcss") for row in rows}
    skipping = {row.name: row.compute_ratio("edge_count", "skipping") for row in rows}

    def select(is_large, is_crowded):
        return {
            row.name: ratios[row.name]
            for row in rows
            if (row.size_m == LARGE_M) == is_large and (row.scene in CROWDED_SCENES) == is_crowded
        }

    crowded = " and ".join(CROWDED_SCENES)
    return [
        judge("time over `pcss`, geometric mean", "<= 0.7", ratios, statistics.geometric_mean, "%.2f"),
        judge("the same, R <= 10 %% of S, worst without %s" % crowded, "<= 1.0", select(False, False), max, "%.2f"),
        judge("the same, R <= 10 %% of S, worst of %s" % crowded, "<= 1.3", select(False, True), max, "%.2f"),
        judge("the same, R = 30 %% of S, worst without %s" % crowded, "<= 2", select(True, False), max, "%.2f"),
        judge("the same, R = 30 %% of S, worst of %s" % crowded, "<= 3", select(True, True), max, "%.2f"),
        judge("time over `pcss` that skips, geometric mean", "<= 1.0", skipping, statistics.geometric_mean, "%.2f"),
    ]


def build_goals(rows, memory):
    memory_goal = judge("memory of a light at %s, worst" % MEMORY_SIZE.replace("x", " x "), "<= 64 MB", memory, max, "%.1f MB")
    return format_table(("what", "goal", "measured", "met"), build_error_goals(rows) + build_time_goals(rows) + [memory_goal])


def build_rows(rows):
    lines = []
    for row in rows:
        errors = row.errors["edge_count"]
        lines.append(
            (
                row.scene,
                "%g" % row.size_m,
                *("%.4f" % errors[name] for name in ("mae", "p99", "umbra_over")),
                "%.4f" % row.errors["pcss"]["mae"],
                "%.1f" % row.compute_ms("edge_count"),
                "%.2f" % row.compute_ratio("edge_count", "pcss"),
                "%.2f" % row.compute_ratio("edge_count", "skipping"),
                ", ".join("%s %.1f" % cost for cost in row.find_costly_passes("edge_count")),
            )
        )
    header = ("scene", "R in m", "MAE", "p99", "`umbra_over`", "MAE of `pcss`", "ms", "over `pcss`", "over `pcss` that skips")
    return format_table((*header, "longest passes, ms"), lines)


def describe_coarse(rows):
    mae, p99 = (statistics.fmean(row.errors["coarse"][name] for row in rows) for name in ("mae", "p99"))
    ratio = statistics.geometric_mean(row.compute_ratio("coarse", "pcss") for row in rows)
    return "With `%s`: mean MAE %.4f, mean p99 %.4f, time over `pcss` %.2f (geometric mean)." % (
        CONFIGURATIONS["coarse"][1], mae, p99, ratio)  # fmt: skip


def describe_memory(memory):
    lights = ", ".join("%s %.1f" % item for item in memory.items())
    return "Memory of a light at %s, MB: %s." % (MEMORY_SIZE.replace("x", " x "), lights)


def main():
    parser = argparse.ArgumentParser(description="Measures edge_count against its goals; see doc/benchmarks.md.")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="of all configurations in turn (default: 3)")
    parser.add_argument("--size", default="512x512", metavar="WxH", help="of the pictures (default: 512x512)")
    parser.add_argument("--scenes", default=",".join(SCENES), metavar="A,B", help="these scenes only")
    parser.add_argument("--write", action="store_true", help="into doc/benchmarks.md")
    arguments = parser.parse_args()
    if arguments.rounds < 1:
        parser.error("--rounds is %d, must be 1 or more" % arguments.rounds)
    if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", arguments.size):
        parser.error("--size is %s, must be like 512x512" % arguments.size)
    scenes = arguments.scenes.split(",")
    if any(scene not in SCENES for scene in scenes):
        parser.error("--scenes is %s, must be of: %s" % (arguments.scenes, ",".join(SCENES)))
    if arguments.write and set(scenes) != set(SCENES):
        parser.error("--write needs all scenes, since the goals are means over them. Leave --scenes out")
    if not os.path.isfile(GNOMON):
        raise SystemExit("ERROR: %s is missing. Run scons." % GNOMON)
    run_benchmarks.PROGRAM = GNOMON  # the one that describe_machine() asks
    load = os.getloadavg()[0]
    rows = [Row(scene, size_m) for scene in SCENES if scene in scenes for size_m in SIZES_M]
    measure_errors(rows, arguments.size)
    measure_times(rows, arguments.size, arguments.rounds)
    memory = measure_memory(scenes)
    measured = "%s Pictures of %s, rounds: %d." % (describe_machine(load), arguments.size.replace("x", " x "), arguments.rounds)
    tables = {
        "edge_count_goals": build_goals(rows, memory),
        "edge_count_rows": build_rows(rows) + ["", describe_coarse(rows), describe_memory(memory)],
    }
    publish_tables(tables, measured, arguments.write)
    return 0


if __name__ == "__main__":
    sys.exit(main())
