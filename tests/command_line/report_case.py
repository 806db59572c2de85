"""Base class and functions of the tests of `gnomon report`."""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import ROOT, CommandLineTest, list_matrix_only, load_json, run  # noqa: E402

PROJECT = os.path.join(ROOT, "demo_project")
SMALL_REFERENCE = ("--size", "64x64", "--samples", "64")
QUICK = (*SMALL_REFERENCE, *list_matrix_only())


def load_report(folder):
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return json.load(file)


def get_record_path(folder, record):
    """Return the path of the file that is written when a cell, or a configuration's reference, has been measured."""
    return os.path.join(folder, "cells", record + ".json")


def stop_after(path):
    """Return environment variables with which the device hangs, with no timeout, once a file exists."""
    return {"GNOMON_INJECT_FAULT": "hang@file:" + path, "GNOMON_DEVICE_TIMEOUT_S": "0"}


def drop_times(value):
    """Return a copy of a report's JSON without times and what depends on them, which differ between any two measurements."""
    if isinstance(value, dict):
        timed = ("time", "wall_ms", "time_ratio", "cost_ms", "pareto", "scaling")
        return {name: drop_times(item) for name, item in value.items() if name not in timed}
    return [drop_times(item) for item in value] if isinstance(value, list) else value


class ReportCase(CommandLineTest):
    def report(self, name, *arguments, project=PROJECT, **environment):
        """Write a report into the folder `name` and return the finished process."""
        return run("report", project, "--out", self.path(name), *QUICK, *arguments, **environment)

    def report_techniques(self):
        """Return the ids of the fallback and another technique: enough for a report with time ratios and a Pareto front."""
        listed = load_json("techniques", "--json")
        others = [item["id"] for item in listed if not item["is_fallback"] and not item["is_reference"]]
        return ",".join([self.get_fallback(), *others[:1]])

    def small(self, name, *arguments):
        """Write a report of two scenes, two light sizes and report_techniques()."""
        techniques = ("--techniques", self.report_techniques())
        return self.report(name, "--scenes", "contact_box,sphere", "--sizes", "0.2,0.8", *techniques, *arguments)

    def load_done(self, name, result):
        """Assert that the process that wrote the report succeeded, and return the report."""
        self.assertEqual(result.returncode, 0, result.stderr)
        return load_report(self.path(name))
