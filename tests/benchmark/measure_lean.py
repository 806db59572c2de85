#!/usr/bin/env python3
"""Measures the rules that skip unneeded work, and writes the tables of doc/benchmarks.md.

    measure_lean.py [--only lean|lean_lights] [--size N] [--repeats N] [--write]

lean: renders a scene made for each rule with the rules on and off, and lists passes, draws, bytes and milliseconds of a whole
frame. The frame plan must mention the rule if and only if the rules are on. lean_lights: 4 lights that light the view, alone
and together with 252 that do not. Each time is the median of --repeats (default 5) medians of 20 frames after 5 warm-up frames.
"""

import argparse
import json
import os
import statistics
import tempfile

import lean_scenes
from driver import PROGRAM, describe_machine, format_table, run, write_table

HIDDEN_COUNT = 252
MAX_EXTRA_COST = 0.10  # allowed extra time for lights out of view, as a fraction of the time of those in view


class Rule:
    def __init__(self, name, scene, line, technique=None, settings=(), is_still=False):
        self.name = name
        self.scene = scene  # function that writes the scene into a folder and returns its path
        self.line = line  # text of the frame plan while the rule applies
        self.technique = technique  # None: that of the scene's lights, edge_count
        self.settings = settings
        self.is_still = is_still  # whether nothing moves between frames


RULES = (
    Rule("lights that light nothing in view", lambda folder: lean_scenes.make_lights(12, folder), "light: skipped, the camera sees no"),
    Rule("light views without casters", lean_scenes.make_tower, "skipped, no casters", "shadow_map"),
    Rule("light views without receivers", lean_scenes.make_room, "skipped, the camera sees no receiver in it", "shadow_map"),
    Rule("third layer behind an empty second", lean_scenes.make_quads, "layer 3 only if layer 2", "penumbra_fins",
         ("technique.penumbra_fins.peeling=passes",)),
    Rule("fins and layers, r = t = 0", lean_scenes.make_balls, "fins: skipped, r and t are 0", "penumbra_fins",
         ("penumbra_outer_width=0", "penumbra_inner_width=0")),
    Rule("layers, t = 0", lean_scenes.make_balls, "layers 2 and 3: skipped, t is 0", "penumbra_fins", ("penumbra_inner_width=0",)),
    Rule("scatter without translucent surfaces", lean_scenes.make_balls, "scatter: skipped"),
    Rule("filter where blocks have few edges", lean_scenes.make_balls, "edges: skipped, all casters together", "edge_count",
         ("edge_count_budget=65536",)),
    Rule("caps where z-pass is safe", lean_scenes.make_knots, "casters: skipped, z-pass is safe", "shadow_volume"),
    Rule("maps at rest", lean_scenes.make_knots, "skipped, cached: neither the light nor a caster moved", "shadow_map", is_still=True),
    Rule("depth layers and fins at rest", lean_scenes.make_knots, "skipped, cached: neither the light nor a caster moved",
         "penumbra_fins", is_still=True),
    Rule("edges and layers at rest", lean_scenes.make_knots, "skipped, cached: neither the light nor a caster moved", "edge_count",
         is_still=True),
    Rule("silhouette edges at rest", lean_scenes.make_knots, "find edges, casters: 10: skipped, cached", "shadow_volume",
         ("technique.shadow_volume.extrusion=compute",), is_still=True),
)  # fmt: skip


def measure(scene, folder, size_px, technique=None, settings=(), arguments=()):
    """Return the frame plan and the JSON of --time."""
    times = os.path.join(folder, "time.json")
    command = [PROGRAM, "run", scene, "--headless", "--size", "%dx%d" % (size_px, size_px), "--plan", "--antialiasing", "1"]
    # The plan of a later frame shows what is cached, that of the first frame what is drawn.
    command += ["--time", times, "--frames", "4" if "--still" in arguments else "1", *arguments]
    if technique:
        command += ["--technique", technique]
    for setting in settings:
        command += ["--set", setting if setting.startswith("technique.") else "light.Light." + setting]
    plan = run(command)
    with open(times, encoding="utf-8") as file:
        return plan, json.load(file)


def count_commands(result):
    return "%d + %d" % (result["draws"], result["dispatches"])


def measure_rules(options):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for rule in RULES:
            scene = rule.scene(folder)
            still = ["--still"] if rule.is_still else []
            times = {True: [], False: []}
            results = {}
            for _ in range(options.repeats):
                for is_on in (True, False):
                    arguments = still + ([] if is_on else ["--skip-nothing"])
                    plan, results[is_on] = measure(scene, folder, options.size, rule.technique, rule.settings, arguments)
                    times[is_on].append(results[is_on]["call_ms"])
                    if (rule.line in plan) != is_on:
                        raise SystemExit(
                            "ERROR: rule \"%s\": the plan %s \"%s\":\n%s" % (rule.name, "lacks" if is_on else "has", rule.line, plan)
                        )
            with_rule, without = (statistics.median(times[is_on]) for is_on in (True, False))
            on, off = results[True], results[False]
            rows.append(
                (rule.name, "`%s`" % (rule.technique or "edge_count"), "%d / %d" % (on["pass_count"], off["pass_count"]),
                 "%s / %s" % (count_commands(on), count_commands(off)),
                 "%.1f / %.1f" % (on["bytes"] / 1e6, off["bytes"] / 1e6),
                 "%.1f / %.1f" % (with_rule, without), "%.2f" % (with_rule / without))  # fmt: skip
            )
            print(*rows[-1], flush=True)
    header = ("what is skipped", "technique", "passes, with the rules / without", "draws + dispatches", "MB", "ms", "ratio of ms")
    return format_table(header, rows)


def measure_lights(options):
    # Only with the rules: without them 256 lights take seconds per frame. The other table compares both for 12 hidden ones.
    cases = [("4 in view", 0), ("4 in view of %d" % (4 + HIDDEN_COUNT), HIDDEN_COUNT)]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        samples = {name: [] for name, _ in cases}
        results = {}
        for _ in range(options.repeats):
            for name, hidden_count in cases:
                scene = lean_scenes.make_lights(hidden_count, folder)
                _, results[name] = measure(scene, folder, options.size, "shadow_map", ())
                samples[name].append(results[name]["call_ms"])
        base_ms = statistics.median(samples[cases[0][0]])
        for index, (name, _) in enumerate(cases):
            result, ms = results[name], statistics.median(samples[name])
            met = "yes" if ms <= (1 + MAX_EXTRA_COST) * base_ms else "no"
            rows.append((name, result["pass_count"], count_commands(result), "%.1f" % (result["bytes"] / 1e6),
                         "%.1f" % ms, "%.2f" % (ms / base_ms), met if index == 1 else ""))  # fmt: skip
            print(*rows[-1], flush=True)
    header = ("lights", "passes", "draws + dispatches", "MB", "ms", "times those in view alone", "at most 1.10")
    return format_table(header, rows)


PARTS = {"lean": measure_rules, "lean_lights": measure_lights}


def main():
    parser = argparse.ArgumentParser(description="Measures what is skipped when it is not needed.")
    parser.add_argument("--only", choices=PARTS, help="measure only this table")
    parser.add_argument("--size", type=int, default=512, help="width and height of the image in pixels")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--write", action="store_true", help="write the tables into doc/benchmarks.md")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    for name in (options.only,) if options.only else PARTS:
        lines = PARTS[name](options) + ["", describe_machine(load)]
        print("\n%s\n%s" % (name, "\n".join(lines)), flush=True)
        if options.write:
            write_table(name, lines)


if __name__ == "__main__":
    main()
