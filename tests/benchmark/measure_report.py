#!/usr/bin/env python3
"""Runs `gnomon report` without its stability sweeps; --write puts its ranking, errors in the study's scenes, scaling and plots
into doc/benchmarks.md.

    measure_report.py [--write] [--out DIR] [--resume] [--no-run]

--resume continues a run that was stopped, --no-run uses the existing report in DIR.
Every cell is timed over 20 frames or 3 s, and the scaling curves have all points:
about 20 minutes on two cores. Headless chromium takes screenshots of the page's plots.
"""

import argparse
import base64
import json
import os
import pathlib
import statistics
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "command_line"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_report_page  # noqa: E402
from driver import PROGRAM, describe_machine, format_table, write_table  # noqa: E402

IMAGE_FOLDER = os.path.join(ROOT, "doc", "images")
# The scenes of the study, see doc/benchmarks.md.
STUDY_SCENES = ("sphere", "contact_box", "torus_knot", "stacked_layers", "clutter", "terrain")
SHOWN_SCENE = "torus_knot"
SCENE = "[...document.querySelectorAll('section.scene')].find((item) => item.querySelector('h2').textContent == '%s')" % SHOWN_SCENE
# Name of the screenshot, and the element of the page that it shows.
IMAGES = {
    "report_ranking.png": "document.querySelector('#ranking .plot-host')",
    "report_scene.png": SCENE + ".querySelector('.grid')",
    "report_pictures.png": SCENE + ".querySelector('.viewer')",
    "report_scaling.png": "document.querySelector('#scaling .grid')",
}
IMAGE_WIDTH_PX = 1400  # narrower plots have no labels at their curves


def run_report(options):
    arguments = ["--scaling", "full", "--stability", "none", "--precision", "0", "--out", options.out]
    if options.resume:
        arguments.append("--resume")
    result = subprocess.run([PROGRAM, "report", os.path.join(ROOT, "demo_project"), *arguments], check=False)
    # Exit code 1 means that cells failed, for example for lack of memory. The page lists them.
    if result.returncode not in (0, 1):
        raise SystemExit("ERROR: gnomon report ended with %d" % result.returncode)


def format_ratio(row):
    return "%.1f" % row["time_ratio"] if "time_ratio" in row else ""


def build_ranking(report):
    header = ("technique", "setting", "penumbra MAE", "bias", "p99", "umbra over", "median ms", "times shadow map", "cells")
    rows = [
        (
            "`%s`" % row["technique"],
            row["setting"],
            "%.4f" % row["penumbra_mae"],
            "%+.3f" % row["penumbra_bias"],
            "%.2f" % row["penumbra_p99"],
            "%.3f" % row["umbra_over"],
            "%.1f" % row["cost_ms"],
            format_ratio(row),
            row["configuration_count"],
        )
        for row in report["ranking"]
    ]
    return format_table(header, rows)


def build_study(report):
    """Build the table of mean errors over the study's scenes, over all receivers and over those with the whole light above
    their horizon."""
    errors = {}
    best = {}  # (technique, configuration) -> smallest errors of its settings
    for cell in report["cells"]:
        # The group "matrix" has the project's scenes, without scaling and stability.
        at = report["configurations"][cell["configuration"]]
        if at["group"] != "matrix" or at["scene"] not in STUDY_SCENES or cell["status"] != "ok":
            continue
        pair = tuple(cell["error"][population]["penumbra"]["mae"] for population in ("all", "whole_light"))
        errors.setdefault((cell["technique"], cell["setting"]), []).append(pair)
        key = (cell["technique"], cell["configuration"])
        best[key] = min(best.get(key, pair), pair)
    for technique in dict.fromkeys(technique for technique, _ in errors):
        if sum(name == technique for name, _ in errors) > 1:
            errors[(technique, "best in each")] = [pair for (name, _), pair in best.items() if name == technique]
    rows = [
        ("`%s`" % technique, setting, *("%.3f" % statistics.mean(pair[index] for pair in pairs) for index in (0, 1)), len(pairs))
        for (technique, setting), pairs in sorted(errors.items())
    ]
    return format_table(("technique", "setting", "MAE", "MAE, whole disc above the horizon", "cells"), rows)


def format_value(value):
    return "%g" % value if value < 1000 else "{:,.0f}".format(value)


def build_scaling(report):
    """Build the table of the first and last point of each curve, and how much the cost grew between them."""
    rows = []
    for curve in report["scaling"]:
        for series in curve["series"]:
            first, last = series["points"][0], series["points"][-1]
            rows.append(
                (
                    curve["name"],
                    "`%s`" % series["technique"],
                    "%s: %.1f ms" % (format_value(first["value"]), first["cost_ms"]),
                    "%s: %.1f ms" % (format_value(last["value"]), last["cost_ms"]),
                    "%.1f" % (last["cost_ms"] / first["cost_ms"]),
                    "%.0f" % (last["value"] / first["value"]),
                )
            )
    return format_table(("curve", "technique", "first point", "last point", "cost grew times", "for times"), rows)


def save_images(page, images):
    """Save screenshots of page elements, at desktop width in light colours. images: file name -> JavaScript of the element."""
    url = pathlib.Path(page).resolve().as_uri() + "#all"
    with check_report_page.Browser() as browser:
        browser.open(url, IMAGE_WIDTH_PX, 900)
        for name, element in images.items():
            box = browser.evaluate(
                "(() => { const box = %s.getBoundingClientRect();"
                "return { x: box.x + scrollX, y: box.y + scrollY, width: box.width, height: box.height, scale: 1 }; })()" % element
            )
            result = browser.call("Page.captureScreenshot", captureBeyondViewport=True, clip=box)
            path = os.path.join(IMAGE_FOLDER, name)
            # 64 colours are enough for plots, and keep the repository small.
            command = ["convert", "png:-", "-colors", "64", "-strip", "PNG8:" + path]
            subprocess.run(command, input=base64.b64decode(result["data"]), check=True)


def main():
    parser = argparse.ArgumentParser(description="Measures the whole report for doc/benchmarks.md.")
    parser.add_argument("--out", default=os.path.join(ROOT, "demo_project", "out", "full_report"), help="the report's folder")
    parser.add_argument("--resume", action="store_true", help="continue a run that was stopped")
    parser.add_argument("--write", action="store_true", help="write tables into doc/benchmarks.md, and images")
    parser.add_argument("--no-run", action="store_true", help="use the existing report")
    options = parser.parse_args()
    load_path = os.path.join(options.out, "load.txt")
    if not options.no_run:
        os.makedirs(options.out, exist_ok=True)
        with open(load_path, "w", encoding="utf-8") as file:
            file.write("%.2f" % os.getloadavg()[0])
        run_report(options)
    with open(load_path, encoding="utf-8") as file:
        load = float(file.read())
    with open(os.path.join(options.out, "report.json"), encoding="utf-8") as file:
        report = json.load(file)
    where = describe_machine(load)
    for part, lines in (
        ("report_ranking", build_ranking(report)),
        ("report_study", build_study(report)),
        ("report_scaling", build_scaling(report)),
    ):
        lines += ["", where]
        print("\n".join(lines), flush=True)
        if options.write:
            write_table(part, lines)
    if options.write:
        save_images(os.path.join(options.out, "index.html"), IMAGES)
    return 0


if __name__ == "__main__":
    sys.exit(main())
