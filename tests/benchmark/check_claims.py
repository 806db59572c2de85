#!/usr/bin/env python3
"""Measures the errors that README.md claims, and fails when one no longer holds.

    check_claims.py [--groups study,package,...] [--samples N] [--size WxH]

Each group of scenes is measured with `gnomon report`, with edge_count and pcss at their default settings
(README.md has the error of pcss with 64 taps, which is slightly smaller than with its default of 32, except in the
courtyard). A claim holds if the mean penumbra MAE of edge_count is at most the figure in README.md times TOLERANCE, if
that of pcss is at least its figure divided by TOLERANCE, and if at most the claimed number of edge_count's receivers has
an error above 0.2. Takes about ten minutes on two cores.
Exit code: 0 all claims hold, 1 one does not, or a figure is not in README.md.
"""

import argparse
import json
import os
import sys
import tempfile

from driver import ROOT, run_gnomon

README = os.path.join(ROOT, "README.md")
PROJECT = os.path.join(ROOT, "demo_project")
TOLERANCE = 1.25  # size of image and number of rays differ from those of the published tables
# Name: (scenes, light sizes in metres, penumbra MAE of edge_count in README.md, penumbra MAE of pcss in README.md, maximum number of wrong
# receivers per 100,000; where README.md states "none" or less than one it is 0.5).
GROUPS = {
    "study": ("sphere,contact_box,torus_knot,stacked_layers,clutter,terrain", "0.08,0.4,1.2", "0.0011", "0.062", 0.5),
    "package": (
        "package_jeep,package_spider,package_regr01,package_wuson,package_duck,package_grail,package_epileptic,package_cat,package_horse",
        "0.08,0.4", "0.0013", "0.064", 0.5,
    ),
    "pierced": ("kitbash,rigging,grass", "0.08,0.4", "0.0023", "0.11", 0.5),
    "courtyard": ("courtyard", "own", "0.0035", "0.074", 3),
}  # fmt: skip


def measure(scenes, sizes, options, folder):
    """Run a report and return technique id -> row of its ranking."""
    run_gnomon("report", PROJECT, "--scenes", scenes, "--sizes", sizes, "--techniques", "edge_count,pcss", "--settings", "default",
               "--samples", options.samples, "--size", options.size, "--scaling", "none", "--change", "none", "--stability", "none",
               "--frames", "1", "--out", folder)  # fmt: skip
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return {row["technique"]: row for row in json.load(file)["ranking"]}


def check(name, options):
    """Measure a group, print the figures, and return whether its claims hold."""
    scenes, sizes, edge_count_text, pcss_text, max_wrong = GROUPS[name]
    with open(README, encoding="utf-8") as file:
        text = file.read()
    missing = [figure for figure in (edge_count_text, pcss_text) if figure not in text]
    with tempfile.TemporaryDirectory() as folder:
        rows = measure(scenes, sizes, options, folder)
    edge_count, pcss = rows["edge_count"]["penumbra_mae"], rows["pcss"]["penumbra_mae"]
    wrong = rows["edge_count"]["receiver_wrong"] * 1e5
    holds = edge_count <= TOLERANCE * float(edge_count_text) and pcss >= float(pcss_text) / TOLERANCE and wrong <= max_wrong and not missing
    print("%s: edge_count %.4f (claimed %s), pcss %.4f (claimed %s), wrong %.1f in 100,000 (claimed at most %g)%s: %s" % (
        name, edge_count, edge_count_text, pcss, pcss_text, wrong, max_wrong, "; not in README.md: " + ", ".join(missing) if missing else "",
        "holds" if holds else "DOES NOT HOLD"), flush=True)  # fmt: skip
    return holds


def main():
    parser = argparse.ArgumentParser(description="Checks the errors that README.md claims.")
    parser.add_argument("--groups", default=",".join(GROUPS), help="of " + ", ".join(GROUPS))
    parser.add_argument("--samples", type=int, default=4096, help="reference rays per pixel")
    parser.add_argument("--size", default="256x256", help="WxH of the masks")
    options = parser.parse_args()
    names = options.groups.split(",")
    unknown = [name for name in names if name not in GROUPS]
    if unknown:
        parser.error("unknown group %s" % ", ".join(unknown))
    return 0 if all([check(name, options) for name in names]) else 1


if __name__ == "__main__":
    sys.exit(main())
