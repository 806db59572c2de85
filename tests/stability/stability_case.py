"""Base class of the stability tests: runs one report and lists its points."""

import json
import os
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GNOMON = os.path.abspath(os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon")))
IS_FULL = os.environ.get("STABILITY_EXTENT") == "full"
TIMEOUT_S = 7200 if IS_FULL else 600


def run_program(*arguments):
    return subprocess.run([GNOMON, *arguments], capture_output=True, text=True, check=False, timeout=TIMEOUT_S)


def find_techniques(quick):
    """Return the ids to sweep. IS_FULL: all but the reference and the template. Otherwise those of `quick` that this build has."""
    listed = json.loads(run_program("techniques", "--json").stdout)
    ids = [item["id"] for item in listed if not item["is_reference"] and item["id"] != "template"]
    return ids if IS_FULL else [name for name in quick if name in ids]


class StabilityCase(unittest.TestCase):
    """cls.points: (sweep, light type, technique, point, cell) of each point of cls.report."""

    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @classmethod
    def measure(cls, project, samples, *arguments):
        """Run a report with that many reference rays per pixel.

        Set cls.status to its exit code, cls.errors to its stderr, and cls.report and cls.points.
        """
        out = os.path.join(cls.holder.name, "report")
        result = run_program(
            "report", project, "--sizes", "0.2", "--size", "32x32", "--samples", str(samples), "--scaling", "none",
            "--stability", "full" if IS_FULL else "quick", "--validation", "--out", out, *arguments,
        )  # fmt: skip
        cls.status, cls.errors = result.returncode, result.stderr
        with open(os.path.join(out, "report.json"), encoding="utf-8") as file:
            cls.report = json.load(file)
        cls.points = [
            (plot["sweep"], plot["light_type"], series["technique"], point, cls.report["cells"][point["cell"]])
            for plot in cls.report["stability"] for series in plot["series"] for point in series["points"]
        ]  # fmt: skip
