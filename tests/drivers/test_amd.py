#!/usr/bin/env python3
"""Tests all compute pipelines with AMD's compiler (RADV on a null device), and that the test notices what it must.

Needs bin/gnomon_pipelines. tests/drivers/amd_pipelines.py --update replaces the table.
"""

import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, FOLDER)
import amd_pipelines  # noqa: E402

CANARIES = os.path.join(FOLDER, "canaries")
FAMILY = amd_pipelines.SHOWN_FAMILY


def build_canary(name, folder):
    """Compile a shader of the folder canaries; return its job."""
    path = os.path.join(folder, name + ".spv")
    command = ["glslangValidator", "-V", "--quiet", "--target-env", "vulkan1.1", "-o", path, os.path.join(CANARIES, name + ".comp")]
    subprocess.run(command, check=True, capture_output=True)
    return name, "canaries/" + name, "", path


class CanaryTest(unittest.TestCase):
    """Shaders with one deliberate error each must be reported, and one without must not."""

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            names = sorted(name.removesuffix(".comp") for name in os.listdir(CANARIES))
            jobs = [build_canary(name, folder) for name in names]
            cls.device, results = amd_pipelines.compile_jobs(FAMILY, jobs)
        cls.rows = {job[0]: amd_pipelines.make_row(FAMILY, job, result) for job, result in zip(jobs, results)}
        cls.results = dict(zip(names, results))

    def find_breaches(self, name, growth=1.0):
        """Breaches against a stored row whose pipeline had fewer instructions, by the factor 1 / growth."""
        row = self.rows[name]
        stored = dict(row, instructions=str(int(int(row["instructions"]) / growth)))
        return amd_pipelines.find_breaches(row, self.results[name], stored)

    def test_subgroup_operations_in_divergent_flow_are_reported(self):
        for name in ("divergent_branch", "divergent_loop", "divergent_barrier"):
            with self.subTest(name):
                breaches = self.find_breaches(name)
                self.assertEqual(len(breaches), 1, breaches)
                self.assertIn("canaries/%s" % name, breaches[0])
                self.assertIn("divergent flow", breaches[0])

    def test_subgroup_operations_in_uniform_flow_are_not_reported(self):
        self.assertGreater(self.results["uniform_flow"]["operations"], 2)
        self.assertEqual(self.find_breaches("uniform_flow"), [])

    def test_operations_that_the_compiler_adds_are_not_reported(self):
        self.assertEqual(self.find_breaches("atomics"), [])

    def test_spilled_registers_and_scratch_are_reported(self):
        self.assertIn("spilled VGPRs", " ".join(self.find_breaches("spilled_registers")))
        self.assertIn("scratch B", " ".join(self.find_breaches("scratch")))

    def test_where_shuffles_become_loops_the_table_limits_spilled_registers(self):
        row = dict(self.rows["spilled_registers"], family=amd_pipelines.LOOPING_SHUFFLES, shader=amd_pipelines.SPILLING[0])
        found = {"divergent": []}
        self.assertEqual(amd_pipelines.find_breaches(row, found, row), [])
        fewer = dict(row, **{"spilled VGPRs": "100"})
        self.assertIn("at most 110", " ".join(amd_pipelines.find_breaches(row, found, fewer)))

    def test_a_tenth_more_instructions_than_the_table_are_reported(self):
        self.assertEqual(self.find_breaches("uniform_flow", growth=1.05), [])
        self.assertIn("at most 10 % more", " ".join(self.find_breaches("uniform_flow", growth=1.2)))

    def test_a_pipeline_without_a_row_is_reported(self):
        breaches = amd_pipelines.find_breaches(self.rows["uniform_flow"], self.results["uniform_flow"], None)
        self.assertIn("--update", " ".join(breaches))

    def test_subgroups_have_the_requested_size(self):
        # A GPU of this family would choose 64 by itself.
        self.assertEqual(self.device["subgroup_size"], 32)
        self.assertEqual(self.results["uniform_flow"]["subgroup_size"], 32)
        self.assertTrue(self.device["has_uniform_control_flow"])

    def test_a_constant_without_values_is_an_error(self):
        with self.assertRaisesRegex(amd_pipelines.PipelineError, "specialization constant 9"):
            amd_pipelines.list_constants("shadow_map/resolve", [0, 9])


class PipelinesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.version, cls.measured = amd_pipelines.measure_all()
        cls.table_version, cls.table = amd_pipelines.load_table()

    def test_no_pipeline_spills_or_diverges_or_has_grown(self):
        stored = self.table
        if self.version != self.table_version:  # other compilers make other numbers of instructions
            print("The table is of Mesa %s, this is %s: instructions are not compared." % (self.table_version, self.version))
            stored = {amd_pipelines.get_key(row): row for row, _ in self.measured}
        breaches = []
        for row, result in self.measured:
            breaches += amd_pipelines.find_breaches(row, result, stored.get(amd_pipelines.get_key(row)))
        self.assertEqual(breaches, [], "\n" + "\n".join(breaches))

    def test_subgroups_have_the_requested_size(self):
        found = [row for row, result in self.measured if result["operations"] > 0 and "0=subgroup" in row["constants"]]
        self.assertGreater(len(found), 10)
        self.assertEqual({row["wave"] for row in found}, {"32"})

    def test_the_table_in_the_documentation_is_that_of_the_stored_rows(self):
        lines = amd_pipelines.make_short_table(self.table_version, self.table.values())
        with open(amd_pipelines.PAGE, encoding="utf-8") as file:
            text = file.read()
        self.assertIn("\n".join(lines), text, "Run tests/drivers/amd_pipelines.py --update")

    def test_spilled_registers_are_listed(self):
        for row, _ in self.measured:  # a note: those that may not be are reported above
            for column in ("spilled SGPRs", "spilled VGPRs"):
                if int(row[column]) > 0:
                    print("%s %s %s: %s %s" % (row["family"], row["shader"], row["constants"], row[column], column))


if __name__ == "__main__":
    unittest.main()
