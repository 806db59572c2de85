#!/usr/bin/env python3
"""Searches for the best r, t and beta of the penumbra fins for each demo scene, light and size in STUDY and OTHERS.

    search_fins.py [--scenes A,B] [--jobs N] [--write]

It minimises the MAE over penumbra pixels. Starting from the better of r = t = R and r = t = R/4 it scales the widths one at a
time by decreasing factors, and also tries 0. Then it tries fixed values of beta, and then scales the widths once more. The table also shows the errors of
r = t = R and of the derived widths, and the means over the study's six scenes. --write puts it into doc/techniques/penumbra_fins.md.
References are traced once (the program caches them).
"""

import argparse
import json
import math
import os
import statistics
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

from measure_techniques import MASK_SIZE, PAGES, ROOT, SCENES, SIZES_M, find_reference, format_number, render, run
from driver import format_table

TECHNIQUE = "penumbra_fins"
PAGE = os.path.join(PAGES, TECHNIQUE + ".md")
BEGIN, END = "<!-- begin fins_search -->", "<!-- end fins_search -->"
PROPERTIES = ("penumbra_outer_width", "penumbra_inner_width", "penumbra_fins_beta")  # the order of values in a point
OUTER, INNER, BETA = range(3)
DERIVED = -1.0
START_FRACTION = 1 / 4  # of R
MIN_FRACTION = 1 / 32  # of R: the width that is tried after 0
FACTORS = (2.0, 1.4, 1.2)
BETAS_M = (0.05, 0.1, 0.2, 0.4, 0.8, 1.6)
MAX_EVALUATIONS = 40  # per target
RESERVED_EVALUATIONS = 6  # of these, reserved for the widths after beta
SCENE_SIZE_M = 4  # of the demo scenes: a sun's R in metres is the tangent of half its angle times this
SUN_ANGLES_DEG = (1.0, 6.0, 20.0)
MIN_GAIN = 0.0002  # decrease of the MAE that makes a point better: a tenth of the reference's noise
ERRORS = ("mae", "bias", "umbra_over")


class Target:
    """One light of one scene at one size."""

    def __init__(self, scene, light, size):
        self.scene = scene
        self.light = light  # None: the scene's only light
        is_sun = light == "Sun"
        self.setting = ("light_angular_distance=%g" if is_sun else "light_size=%g") % size
        self.width_m = SCENE_SIZE_M * math.tan(math.radians(size / 2)) if is_sun else size  # R
        self.name = scene if light is None else "%s, %s" % (scene, light)
        self.size = "%g" % size + (" degrees" if is_sun else "")

    def render(self, technique, settings, out):
        light = ["--light", self.light] if self.light else []
        render(self.scene, technique, [self.setting] + settings, out, *light)


STUDY = [Target(scene, None, size_m) for scene in SCENES for size_m in SIZES_M]
OTHERS = [Target(scene, None, size_m) for scene in ("bunny", "open_sheets") for size_m in SIZES_M]
OTHERS += [Target("three_lights", light, size_m) for light in ("Spot", "Omni") for size_m in SIZES_M]
OTHERS += [Target("three_lights", "Sun", angle_deg) for angle_deg in SUN_ANGLES_DEG]


def replace_value(point, index, value):
    """Return the point with one value replaced, rounded to six digits so that scaling back gives the same point again."""
    return tuple(float("%.6g" % value) if i == index else old for i, old in enumerate(point))


class Search:
    """The search for one target: all evaluated points, and the best one."""

    def __init__(self, target, reference, pool):
        self.target = target
        self.reference = reference
        self.pool = pool
        self.errors = {}  # point -> penumbra errors
        self.derived_errors = {}  # with the widths that the technique derives, for comparison
        self.wide = (target.width_m, target.width_m, DERIVED)
        self.best = self.wide

    def measure(self, point, reference_path):
        settings = ["%s=%g" % pair for pair in zip(PROPERTIES, point)]
        with tempfile.TemporaryDirectory() as folder:
            mask = os.path.join(folder, "mask.exr")
            self.target.render(TECHNIQUE, settings, mask)
            return json.loads(run("compare", reference_path, mask))["penumbra"]

    def evaluate(self, points, reference_path, limit):
        """Evaluate the points that are new, up to `limit` points in total. Return whether one of them is the new best."""
        fresh = [point for point in dict.fromkeys(points) if point not in self.errors]
        fresh = fresh[: max(0, limit - len(self.errors))]
        results = self.pool.map(lambda point: self.measure(point, reference_path), fresh)
        self.errors.update(zip(fresh, results))
        found = min(fresh, key=self.get_error, default=self.best)
        is_better = self.get_error(found) < self.get_error(self.best) - MIN_GAIN
        if is_better:
            self.best = found
        return is_better

    def get_error(self, point):
        return self.errors[point]["mae"]

    def improve_width(self, index, factor, reference_path, limit):
        """Scale r or t by the factor or its inverse for as long as the error falls; also try 0 with FACTORS[0]. Return whether it fell."""
        is_better_once = False
        while True:
            value = self.best[index]
            values = [value * factor, value / factor] if value > 0 else [MIN_FRACTION * self.target.width_m]
            if factor == FACTORS[0]:
                values.append(0.0)
            if not self.evaluate([replace_value(self.best, index, other) for other in values], reference_path, limit):
                return is_better_once
            is_better_once = True

    def improve_widths(self, factor, reference_path, limit):
        """Improve r and t in turn until neither gets better. any() gets a list, since with a generator it would skip t after r."""
        while any([self.improve_width(index, factor, reference_path, limit) for index in (OUTER, INNER)]):
            pass

    def run(self):
        start = START_FRACTION * self.target.width_m
        with tempfile.TemporaryDirectory() as folder:
            reference_path = os.path.join(folder, "reference.exr")
            self.pool.submit(self.target.render, self.reference, [], reference_path).result()
            self.derived_errors = self.pool.submit(self.measure, (DERIVED,) * len(PROPERTIES), reference_path).result()
            self.evaluate([self.wide, (start, start, DERIVED)], reference_path, MAX_EVALUATIONS)
            for factor in FACTORS:
                self.improve_widths(factor, reference_path, MAX_EVALUATIONS - len(BETAS_M) - RESERVED_EVALUATIONS)
            if self.best[INNER] > 0:  # beta affects only the inner fins
                self.evaluate([replace_value(self.best, BETA, beta_m) for beta_m in BETAS_M], reference_path, MAX_EVALUATIONS)
            self.improve_widths(FACTORS[-1], reference_path, MAX_EVALUATIONS)
        return self


def build_table(searches):
    """Build one row per search, and the means after the rows of the study's scenes. Print each row as it is found."""
    rows, columns = [], []
    for search in searches:
        best = search.best
        errors = [search.errors[search.wide]["mae"], search.derived_errors["mae"]] + [search.errors[best][name] for name in ERRORS]
        cells = [format_number(error) for error in errors]
        beta = "derived" if best[BETA] == DERIVED else "%g" % best[BETA]
        target = search.target
        if columns and target in OTHERS:
            rows.append(build_means(columns))
            columns = []
        if target in STUDY:
            columns.append(errors)
        rows.append((target.name, target.size, *cells[:2], "%.3g" % best[OUTER], "%.3g" % best[INNER], beta, *cells[2:]))
        print(" ".join(rows[-1]), "after %d evaluations" % len(search.errors), flush=True)
    if columns:
        rows.append(build_means(columns))
    header = ("scene", "R", "r = t = R: MAE", "derived r, t: MAE", "best r", "best t", "best beta", "MAE", "bias", "`umbra_over`")
    return format_table(header, rows)


def build_means(columns):
    means = [format_number(statistics.fmean(values)) for values in zip(*columns)]
    return ("**mean of the above**", "", *means[:2], "", "", "", *means[2:])


def split_page():
    """Return the text of the page before and after its table."""
    if not os.path.isfile(PAGE):
        raise SystemExit("ERROR: %s is missing. Write it with the lines %s and %s." % (os.path.relpath(PAGE, ROOT), BEGIN, END))
    with open(PAGE, encoding="utf-8") as file:
        before, begin, rest = file.read().partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        page = os.path.relpath(PAGE, ROOT)
        raise SystemExit("ERROR: %s has no lines %s and %s. Add them where the table belongs." % (page, BEGIN, END))
    return before + begin, end + after


def main():
    parser = argparse.ArgumentParser(description="Searches the best r, t and beta of the penumbra fins.")
    parser.add_argument("--scenes", default="", metavar="A,B", help="these scenes only")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="evaluations at a time")
    parser.add_argument("--write", action="store_true", help="write the table into doc/techniques/penumbra_fins.md")
    arguments = parser.parse_args()
    targets = STUDY + OTHERS
    if arguments.scenes:
        names = sorted({target.scene for target in targets})
        requested = arguments.scenes.split(",")
        if any(name not in names for name in requested):
            parser.error("--scenes is %s, must be of: %s" % (arguments.scenes, ",".join(names)))
        targets = [target for target in targets if target.scene in requested]
    if arguments.jobs < 1:
        parser.error("--jobs is %d, must be 1 or more" % arguments.jobs)
    if arguments.write:
        split_page()  # fails now, not after the work, if the page lacks the lines
    reference = find_reference()
    # One pool runs the programs, the other one the searches that wait for them.
    with ThreadPoolExecutor(arguments.jobs) as evaluations, ThreadPoolExecutor(arguments.jobs) as searches:
        lines = build_table(searches.map(Search.run, [Search(target, reference, evaluations) for target in targets]))
    lines += ["", "Errors over penumbra pixels, widths and beta in metres; masks of %s. A sun has degrees; its R in metres is tan(R / 2) S. Derived: r = R/4, t = R/2." % MASK_SIZE]
    print("\n" + "\n".join(lines))
    if arguments.write:
        before, after = split_page()
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(before + "\n" + "\n".join(lines) + "\n" + after)
        print("Wrote %s" % os.path.relpath(PAGE, ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
