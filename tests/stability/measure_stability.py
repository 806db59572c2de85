#!/usr/bin/env python3
"""Sweeps every technique through extreme parameter values, and writes the tables and curves of doc/stability.md.

    measure_stability.py [--out DIR] [--resume] [--no-run] [--write]

--resume continues a run that was stopped, --no-run uses the existing report in DIR. Without --write the tables are only
printed. Takes about 12 minutes on two cores; errors do not depend on the machine's load. Headless chromium takes screenshots of the page's curves.
"""

import argparse
import datetime
import json
import os
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "tests", "benchmark"), os.path.dirname(os.path.abspath(__file__))]
from measure_report import save_images  # noqa: E402
from driver import PROGRAM, format_table, write_table  # noqa: E402
from untuned_project import make_untuned_project  # noqa: E402

PAGE = os.path.join(ROOT, "doc", "stability.md")
TYPES = ("spot", "omni", "directional")
# Marks of a point in tables, by its state (StabilityState).
MARKS = {"ok": "", "doubled": " ×2", "nonsense": " !", "refused": " refused", "failed": " FAILED", "missing": "?"}


def run_report(options):
    arguments = ["--sizes", "0.2", "--size", "64x64", "--scaling", "none", "--stability", "full", "--out", options.out]
    if options.resume:
        arguments.append("--resume")
    with tempfile.TemporaryDirectory() as project:
        make_untuned_project(project)
        code = subprocess.run([PROGRAM, "report", project, *arguments], check=False).returncode
        if code not in (0, 1):  # 1: a cell failed, which the tables mark
            raise SystemExit("ERROR: gnomon report ended with %d. Its own messages are above." % code)


def get_plots(report, light_type):
    """Return the sweeps that vary a quantity, so that the report shows them as curves."""
    return [item for item in report["stability"] if item["light_type"] == light_type and not item["has_cases"]]


def describe_break(series):
    """Describe the values beyond which a technique no longer holds its error limit in a sweep."""
    ends = [series[name] for name in ("break_before", "break_after") if name in series]
    if len(ends) == 2 and ends[0] == ends[1]:
        return "not at its centre"
    return " and ".join("from %s" % end for end in ends) or ("holds" if series["is_complete"] else "?")


def get_techniques(report):
    """Return the techniques that were swept; mask filters are not."""
    swept = {series["technique"] for plot in report["stability"] for series in plot["series"]}
    return [item["id"] for item in report["techniques"] if item["id"] in swept]


def find_series(plot, technique):
    return next((series for series in plot["series"] if series["technique"] == technique), None)


def name_sweep(plot):
    return plot["sweep"].replace("_", " ")


def build_sweeps(report):
    """Build the table of sweeps: quantity, values, centre and types of light."""
    rows = []
    for plot in get_plots(report, "spot"):
        labels = [point["label"] for point in plot["series"][0]["points"]]
        types = [kind for kind in TYPES if any(item["sweep"] == plot["sweep"] for item in get_plots(report, kind))]
        rows.append((name_sweep(plot), plot["quantity"], ", ".join(labels), plot["center"], ", ".join(types)))
    return format_table(("sweep", "quantity", "values", "centre", "lights"), rows)


def build_breaks(report, light_type):
    """Build the table of where each technique breaks in each sweep (see describe_break)."""
    plots = get_plots(report, light_type)
    rows = []
    for technique in get_techniques(report):
        found = [find_series(plot, technique) for plot in plots]
        rows.append(("`%s`" % technique, *(describe_break(series) if series else "" for series in found)))
    return format_table(("technique", *(name_sweep(plot) for plot in plots)), rows)


def build_errors(report):
    """Build the table of the error at the centre of each sweep, and of the largest error, for spot lights."""
    rows = []
    for technique in get_techniques(report):
        row = ["`%s`" % technique]
        for plot in get_plots(report, "spot"):
            points = find_series(plot, technique)["points"]
            center = next(point for point in points if point["label"] == plot["center"])
            errors = [point["mae"] for point in points if "mae" in point]
            row.append("%.4f (%.4f)" % (center["mae"], max(errors)))
        rows.append(row)
    return format_table(("technique", *(name_sweep(plot) for plot in get_plots(report, "spot"))), rows)


def build_cases(report, sweep):
    """Build the tables of the MAE, one per light type, for a sweep over named cases (guards or scenes)."""
    lines = []
    for kind in TYPES:
        for plot in (item for item in report["stability"] if (item["sweep"], item["light_type"]) == (sweep, kind)):
            techniques = [series["technique"] for series in plot["series"]]
            rows = []
            for index, point in enumerate(plot["series"][0]["points"]):
                cells = [series["points"][index] for series in plot["series"]]
                rows.append((point["label"], *(
                    ("%.4f" % cell["mae"] if "mae" in cell else "-") + MARKS[cell["state"]] for cell in cells
                )))  # fmt: skip
            lines += ["", "%s light:" % kind.capitalize(), "", *format_table((kind, *("`%s`" % name for name in techniques)), rows)]
    return lines[1:]


def build_causes(report):
    """Build the table of how often each technique breaks, and of the causes found by the double-precision path."""
    rows = []
    points = [
        (series["technique"], point, report["cells"][point["cell"]].get("stability", {}))
        for plot in report["stability"] for series in plot["series"] for point in series["points"]
    ]  # fmt: skip
    for technique in get_techniques(report):
        own = [item for item in points if item[0] == technique]
        broken = [item for item in own if item[1]["state"] in ("doubled", "nonsense")]
        conditions = [item[2]["condition"] for item in broken if "condition" in item[2]]
        nonsense = [item for item in own if item[1]["state"] == "nonsense"]
        moved = [item[2]["temporal_rmse"] for item in own if "temporal_rmse" in item[2]]
        causes = [condition["cause"] for condition in conditions]
        rows.append((
            "`%s`" % technique, len(own), len(broken), len(nonsense), sum(1 for item in nonsense if item[2]["warnings"]),
            "%.0f" % statistics.median([condition["number"] for condition in conditions]) if conditions else "",
            ", ".join("%s %d" % (cause, causes.count(cause)) for cause in ("method", "rounding", "reference_mask") if cause in causes),
            "%.4f" % statistics.median(moved), "%.4f" % max(moved),
        ))  # fmt: skip
    header = ("technique", "points", "do not hold", "nonsense", "of them warned of", "condition number", "cause",
              "error of change, median", "greatest")  # fmt: skip
    return format_table(header, rows)


def describe_run(report, date):
    machine = report["machines"][0]
    return "%s: %s, %s; %s. %d reference rays per pixel." % (
        date.isoformat(), machine["cpu"], machine["device"], machine["driver"], report["samples"]
    )  # fmt: skip


def save_curves(report, folder):
    """Save screenshots of the report's curves into doc/images. Return the lines that show them."""
    element = "[...document.querySelectorAll('#stability .grid figure')].find((item) => item.querySelector('h3').textContent == '%s')"
    images = {"stability_%s.png" % plot["sweep"]: element % name_sweep(plot) for plot in get_plots(report, "spot")}
    save_images(os.path.join(folder, "index.html"), {**images, "stability_legend.png": "document.getElementById('legend')"})
    names = list(images)
    rows = [names[index : index + 2] for index in range(0, len(names), 2)]
    legend = "![Colours of the techniques](images/stability_legend.png)"
    labels = {name: name[len("stability_") : -len(".png")].replace("_", " ") for name in names}
    return [legend, ""] + [" ".join("![%s](images/%s)" % (labels[name], name) for name in row) for row in rows]


def main():
    parser = argparse.ArgumentParser(description="Measures the stability sweeps for doc/stability.md.")
    parser.add_argument("--out", default=os.path.join(ROOT, "demo_project", "out", "stability"), help="the report's folder")
    parser.add_argument("--resume", action="store_true", help="continue a run that was stopped")
    parser.add_argument("--no-run", action="store_true", help="use the existing report")
    parser.add_argument("--write", action="store_true", help="write doc/stability.md and its images")
    options = parser.parse_args()
    path = os.path.join(options.out, "report.json")
    if not options.no_run:
        if os.path.exists(path):
            os.remove(path)  # so that a failed run does not leave the old report
        run_report(options)
    with open(path, encoding="utf-8") as file:
        report = json.load(file)
    date = datetime.date.fromtimestamp(os.path.getmtime(path))
    parts = {
        "stability_sweeps": build_sweeps(report),
        "stability_breaks": [*build_breaks(report, "spot"), "", describe_run(report, date)],
        "stability_breaks_omni": build_breaks(report, "omni"),
        "stability_breaks_directional": build_breaks(report, "directional"),
        "stability_errors": build_errors(report),
        "stability_cases": build_cases(report, "guards"),
        "stability_scenes": build_cases(report, "scenes"),
        "stability_causes": build_causes(report),
    }
    if options.write:
        parts["stability_curves"] = save_curves(report, options.out)
    for name, lines in parts.items():
        print("\n".join((name, *lines, "")))
        if options.write:
            write_table(name, lines, PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
