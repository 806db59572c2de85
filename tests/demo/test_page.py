"""The demo page shows what was measured, and lists what failed."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROJECT = os.path.join(ROOT, "demo_project")
sys.path.insert(0, PROJECT)

import make_page  # noqa: E402
import measure_demo  # noqa: E402

ERROR = {"pixels": 10, "mae": 0.0123, "rmse": 0.02, "p99": 0.1, "bias": -0.005, "wrong": 0.375, "umbra_over": 0.25}
TIME = {"gpu_ms": 1.5, "gpu_ms_p90": 1.75, "wall_ms": 12.3, "wall_ms_p90": 230.0}


def make_row(name, **changes):
    row = {"id": name, "mask": None, "heat": None, "error": {"penumbra": ERROR}, "time": TIME, "failure": None}
    return {**row, **changes}


def make_results(*rows):
    light = {"name": "Key", "type": "spot", "truth": None, "failure": None, "techniques": list(rows)}
    return {
        "info": {"version": "1", "devices": [{"index": 3, "name": "Some device"}], "chosen": 3, "cpu": "Some CPU"},
        "size": "64x32",
        "samples": 0,
        "techniques": [{"id": "first", "name": "First & best", "is_default": True}, {"id": "second", "name": "Second"}],
        "scenes": [{"name": "a_scene", "pictures": {}, "failures": [], "lights": [light]}],
        "failure_count": 0,
    }


def build(results):
    return make_page.Page(results, "/nonexistent", False).build()


class PageText(unittest.TestCase):
    def test_errors_times_and_device_are_shown(self):
        page = build(make_results(make_row("first"), make_row("second")))
        for text in ("0.0123", "-0.0050", "25.0&thinsp;%", "37.5&thinsp;%", "1.50", "230", "Some device", "First &amp; best (default)"):
            self.assertIn(text, page)

    def test_a_failure_is_shown_and_escaped(self):
        row = make_row("second", error=None, time=None, failure='ERROR: "x" <b>')
        page = build({**make_results(make_row("first"), row), "failure_count": 1})
        self.assertIn("ERROR: &quot;x&quot; &lt;b&gt;", page)
        self.assertIn("1 failed", page)

    def test_missing_numbers_are_dashes(self):
        row = make_row("first", error={"penumbra": {"pixels": 0, "mae": None}}, time={"gpu_ms": 1.0})
        self.assertIn("&ndash;", build(make_results(row)))

    def test_an_error_of_zero_and_a_time_of_zero_are_no_problem(self):
        exact = {"penumbra": {**ERROR, "mae": 0.0}}
        build(make_results(make_row("first", error=exact), make_row("second", time={**TIME, "gpu_ms": 0.0})))

    def test_nothing_measured_still_gives_a_page(self):
        self.assertIn("</html>", build({**make_results(), "scenes": []}))

    def test_the_page_loads_nothing_from_elsewhere(self):
        self.assertIsNone(re.search(r"(?:src|href)=\"[a-z]+:(?!image)", build(make_results(make_row("first")))))


class ProjectFile(unittest.TestCase):
    def load(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "project.cfg")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            return measure_demo.load_config(path)

    def test_sections_values_and_comments(self):
        found = self.load('; a comment\n[a]\nx="y=z"\n\n[b]\nlist=["1", "2"]\n')
        self.assertEqual(found, {"a": {"x": "y=z"}, "b": {"list": ["1", "2"]}})

    def test_a_line_that_is_no_value_is_refused(self):
        for line in ("x", "x=", "x=[1", "=1 2"):
            with self.subTest(line=line), self.assertRaises(SystemExit):
                self.load("[a]\n" + line + "\n")

    def test_lights_whose_shadow_is_off_are_skipped(self):
        lights = [
            {"type": "spot", "extras": {"shadow_enabled": False}},
            {"type": "point", "name": "B"},
        ]
        nodes = [
            {"name": "A", "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"name": "C"},
        ]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.gltf")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"nodes": nodes, "extensions": {"KHR_lights_punctual": {"lights": lights}}}, file)
            self.assertEqual(measure_demo.find_lights(path), [("B", "point")])


class DemoScript(unittest.TestCase):
    """run_demo.sh with a program that fails at everything."""

    def run_script(self, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "gnomon")
            with open(program, "w", encoding="utf-8") as file:
                file.write(FAILING_PROGRAM)
            os.chmod(program, 0o755)
            command = [os.path.join(PROJECT, "run_demo.sh"), "--no-build", "--no-window", "--out", folder, *arguments]
            result = subprocess.run(
                command, capture_output=True, text=True, env={**os.environ, "GNOMON": program}, timeout=120, check=False
            )
            page = os.path.join(folder, "index.html")
            text = ""
            if os.path.isfile(page):
                with open(page, encoding="utf-8") as file:
                    text = file.read()
        return result, text

    def test_failures_are_on_the_page_and_the_exit_code_is_1(self):
        result, page = self.run_script("--scenes", "sphere,contact_box")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("the lamp is broken", page)
        self.assertIn("Sphere", page)
        self.assertIn("Contact box", page)

    def test_wrong_usage_ends_with_2(self):
        for arguments in (("--gone",), ("--size", "64"), ("--samples", "0"), ("--size",)):
            with self.subTest(arguments=arguments):
                result, page = self.run_script(*arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn("ERROR: ", result.stderr)
                self.assertEqual(page, "")


FAILING_PROGRAM = """#!/bin/sh
case $1 in
    info) echo '{"version": "1", "devices": [], "chosen": -1, "cpu": "c", "threads": 1}' ;;
    techniques) echo '[{"id": "a", "name": "A"}, {"id": "b", "name": "B", "is_reference": true}]' ;;
    *) echo "ERROR: the lamp is broken" >&2; exit 1 ;;
esac
"""


if __name__ == "__main__":
    unittest.main()
