"""demo_project/run_demo.sh: what it passes on to `gnomon report`, wrong usage and failures."""

import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from project_scenes import ROOT, list_project_scenes  # noqa: E402

SCRIPT = os.path.join(ROOT, "demo_project", "run_demo.sh")
# Writes its arguments, one a line, and ends with 1 where a file named "fail" is in the folder.
PROGRAM = """#!/bin/sh
printf '%s\\n' "$@" > "$(dirname "$0")/arguments"
[ ! -f "$(dirname "$0")/fail" ]
"""


class RunDemo(unittest.TestCase):
    def run_script(self, *arguments, fails=False):
        """Run the script with PROGRAM as gnomon. Return (finished process, PROGRAM's arguments)."""
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "gnomon")
            with open(program, "w", encoding="utf-8") as file:
                file.write(PROGRAM)
            os.chmod(program, 0o755)
            if fails:
                open(os.path.join(folder, "fail"), "w", encoding="utf-8").close()
            command = [SCRIPT, "--no-build", "--no-window", "--out", os.path.join(folder, "out"), *arguments]
            environment = {**os.environ, "GNOMON": program}
            result = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=120, check=False)
            received = []
            if os.path.isfile(os.path.join(folder, "arguments")):
                with open(os.path.join(folder, "arguments"), encoding="utf-8") as file:
                    received = file.read().splitlines()
            return result, received

    def get_value(self, received, option):
        return received[received.index(option) + 1] if option in received else None

    def test_the_default_is_short_and_its_scenes_are_in_the_project(self):
        result, received = self.run_script()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(received[:2], ["report", "demo_project"])
        self.assertEqual(self.get_value(received, "--settings"), "default")
        names = {os.path.splitext(os.path.basename(path))[0] for path in list_project_scenes()}
        self.assertLessEqual(set(self.get_value(received, "--scenes").split(",")), names)

    def test_all_measures_every_scene_and_setting(self):
        _, received = self.run_script("--all", "--skip", "package_*")
        self.assertNotIn("--scenes", received)
        self.assertNotIn("--settings", received)
        self.assertEqual(self.get_value(received, "--skip"), "package_*")

    def test_options_are_passed_on(self):
        _, received = self.run_script("--size", "64x32", "--samples", "16", "--frames", "3", "--scenes", "sphere", "--device", "1")
        for option, value in (("--size", "64x32"), ("--samples", "16"), ("--frames", "3"), ("--scenes", "sphere"), ("--device", "1")):
            self.assertEqual(self.get_value(received, option), value)

    def test_a_failing_report_ends_with_1(self):
        self.assertEqual(self.run_script(fails=True)[0].returncode, 1)

    def test_wrong_usage_ends_with_2(self):
        for arguments in (("--gone",), ("--size", "64"), ("--samples", "0"), ("--size",)):
            with self.subTest(arguments=arguments):
                result, received = self.run_script(*arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn("ERROR: ", result.stderr)
                self.assertEqual(received, [])


if __name__ == "__main__":
    unittest.main()
