"""Devices that are lost, hang or run out of memory: one message, exit code 1, and no work is lost."""

import json
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import CONTACT_BOX, SMALL, CommandLineTest, full_run_only, find_technique, run  # noqa: E402
from display_case import TIMEOUT_S  # noqa: E402
from editor_case import EditorCase, load  # noqa: E402
from report_case import ReportCase, get_record_path, load_report  # noqa: E402

# $GNOMON_INJECT_FAULT -> texts of the error message.
FAULTS = {
    "device_lost": ("The device was lost", "Restart the program"),
    "device_lost@pass:receivers": ("The device was lost", "receivers' (last pass", "Restart the program"),
    "out_of_memory": ("Out of memory", "smaller scene or image"),
    "hang": ("no progress for 3 s", "before pass '", "GNOMON_DEVICE_TIMEOUT_S"),
}
FIRST_HANG = {"GNOMON_DEVICE_TIMEOUT_S": "3"}  # a short limit is safe, since the first submission hangs
HANG = {"GNOMON_DEVICE_TIMEOUT_S": "15"}  # far above what a pass of these tests takes, its compilation included
LITTLE_MEMORY = {"GNOMON_MEMORY_BUDGET_MIB": "200"}  # enough for the editor and the scene
MAX_MAP_SIZE = 8192  # texels per side: 256 MiB


class FailingDevices(CommandLineTest):
    def test_run_and_visibility_end_with_the_reason_and_what_to_do(self):
        out = self.path("mask.exr")
        for command in (
            ("run", CONTACT_BOX, "--headless", *SMALL),
            ("visibility", CONTACT_BOX, "--technique", self.get_fallback(), "--out", out, *SMALL),
        ):
            for fault, words in FAULTS.items():
                if fault == "hang" and command[0] == "run":
                    continue  # slow, and it waits in the same code as visibility
                with self.subTest(command=command[0], fault=fault):
                    result = run(*command, GNOMON_INJECT_FAULT=fault, **FIRST_HANG)
                    self.assertEqual(result.returncode, 1, result.stderr)
                    for word in words:
                        self.assertIn(word, result.stderr)
                    self.assertFalse(os.path.exists(out))
            with self.subTest(command=command[0], fault="no device memory"):
                self.assert_refused(run(*command, GNOMON_MEMORY_BUDGET_MIB="0.05"), "Out of device memory", "Lower the")

    def test_bad_limits_are_named(self):
        for variable in ("GNOMON_MEMORY_BUDGET_MIB", "GNOMON_DEVICE_TIMEOUT_S", "GNOMON_INJECT_FAULT"):
            self.assert_refused(run("run", CONTACT_BOX, "--headless", *SMALL, **{variable: "soon"}), variable, "soon")


class FailingReports(ReportCase):
    def measure(self, name, *arguments, scenes="sphere", **environment):
        """Write a report with one cell of the fallback and one or more of another technique for each scene."""
        techniques = ("--techniques", self.report_techniques())
        return self.report(name, "--scenes", scenes, "--sizes", "0.4", *techniques, *arguments, **environment)

    def plan(self, name, **options):
        """Return the plan of a report with these options, written by a run whose device is lost at once."""
        result = self.measure(name, **options, GNOMON_INJECT_FAULT="device_lost")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(os.listdir(self.path(name + "/cells")), [])
        return load(self.path(name + "/plan.json"))

    def fail_after(self, fault, name, record):
        """Return a fault with which the first submission after that record is written fails."""
        return "%s@file:%s" % (fault, get_record_path(self.path(name), record))

    def test_a_report_goes_on_after_a_cell_that_had_no_memory_and_a_resume_measures_it(self):
        (configuration,) = self.plan("report")["configurations"]
        # The record is written when its reference is traced, before the cells.
        fault = self.fail_after("out_of_memory", "report", configuration["record"])
        result = self.measure("report", GNOMON_INJECT_FAULT=fault)
        self.assertEqual(result.returncode, 1)
        self.assertIn("Out of memory", result.stderr)
        cells = load_report(self.path("report"))["cells"]
        self.assertEqual([cell["status"] for cell in cells], ["failed"] + ["ok"] * (len(cells) - 1))
        resumed = self.measure("report", "--resume")
        self.assertIn("1 are left", resumed.stderr)
        self.assertTrue(all(cell["status"] == "ok" for cell in self.load_done("report", resumed)["cells"]))

    def test_cells_that_do_not_fit_into_the_device_are_named_in_the_report(self):
        arguments = ("--scenes", "sphere", "--sizes", "0.4", "--techniques", self.get_fallback())
        result = self.report("report", *arguments, GNOMON_MEMORY_BUDGET_MIB="2")
        self.assertEqual(result.returncode, 1)
        (cell,) = load_report(self.path("report"))["cells"]
        self.assertEqual(cell["status"], "failed")
        self.assertIn("Out of device memory", cell["message"])

    def check_lost(self, fault, **limit):
        """Let the device fail before the last configuration's cells; earlier cells must stay."""
        scenes = "contact_box,sphere"
        plan = self.plan("report", scenes=scenes)
        last = len(plan["configurations"]) - 1
        left_count = sum(cell["configuration"] == last for cell in plan["cells"])
        done_count = len(plan["cells"]) - left_count
        self.assertGreater(done_count, 0)
        fault = self.fail_after(fault, "report", plan["configurations"][last]["record"])
        result = self.measure("report", scenes=scenes, GNOMON_INJECT_FAULT=fault, **limit)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("go on with --resume", result.stderr)
        self.assertFalse(os.path.exists(self.path("report/report.json")))
        resumed = self.measure("report", "--resume", scenes=scenes)
        self.assertIn("Resuming: %d cells are there, %d are left" % (done_count, left_count), resumed.stderr)
        self.assertTrue(all(cell["status"] == "ok" for cell in self.load_done("report", resumed)["cells"]))

    def test_a_report_whose_device_is_lost_ends_and_goes_on_with_resume(self):
        self.check_lost("device_lost")

    @full_run_only
    def test_a_report_whose_device_hangs_ends_and_goes_on_with_resume(self):
        self.check_lost("hang", **HANG)


class FailingEditor(EditorCase):
    def open_with(self, environment):
        os.environ.update(environment)
        try:
            self.open_editor()
        finally:
            for name in environment:
                del os.environ[name]

    def fail_with(self, fault, *words, **limit):
        os.makedirs(self.path("config"), exist_ok=True)
        with open(os.path.join(self.path("config"), "editor.json"), "w", encoding="utf-8") as file:
            json.dump({"autosave_s": 3600}, file)  # no autosave before the failure
        recovery = os.path.join(self.project, "scenes", ".three_lights.recovery.gltf")
        signal = self.path("fail_now")
        self.open_with({"GNOMON_INJECT_FAULT": "%s@file:%s" % (fault, signal), **limit})
        self.select_light()
        self.drag("property light_size", 3)
        self.wait_for(lambda state: state["is_changed"])
        self.assertFalse(os.path.exists(recovery))
        self.write("fail_now", "")
        _, errors = self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(self.process.returncode, 1, errors)
        for word in words:
            self.assertIn(word, errors)
        self.assertTrue(os.path.exists(recovery))
        self.open_editor()
        self.click("button Recover")
        self.wait_for(lambda state: state["is_changed"])
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: not state["is_changed"])
        self.finish()

    def test_changes_are_saved_for_recovery_when_the_device_is_lost(self):
        self.fail_with("device_lost", "The device was lost", "Restart the program")

    @full_run_only
    def test_changes_are_saved_for_recovery_when_the_device_hangs(self):
        self.fail_with("hang", "no progress for 15 s", **HANG)

    @full_run_only
    def test_changes_are_saved_for_recovery_when_memory_is_exhausted(self):
        self.fail_with("out_of_memory", "Out of memory", "smaller scene or image")

    def test_a_shadow_that_does_not_fit_into_the_device_is_reported_and_undone(self):
        technique, scene = find_technique("is_fallback"), load(self.scene)
        before = self.find_light(scene)["extras"]
        before["%s_size" % technique] = MAX_MAP_SIZE
        self.save(scene)
        self.open_with(LITTLE_MEMORY)
        self.select_light()
        first = self.capture_viewport()
        self.choose("property shadow_technique", technique)
        state = self.wait_for(lambda state: "Out of device memory" in state["status"])
        for word in ("Lower the map size", "MiB"):
            self.assertIn(word, state["status"])
        self.press("key", "ctrl+z")
        self.wait_for(lambda state: not state["is_changed"])
        self.assertLess(self.compute_changed_fraction(first, self.capture_viewport()), 0.001)
        self.drag("property light_size", 3)
        self.assertGreater(self.compute_changed_fraction(first, self.capture_viewport()), 0.005)
        self.press("key", "ctrl+s")
        self.wait_for(lambda state: not state["is_changed"] and state["status"].startswith("Saved"))
        after = self.find_light(load(self.scene))["extras"]
        self.assertGreater(after["light_size"], before["light_size"])
        self.assertEqual(after["%s_size" % technique], MAX_MAP_SIZE)
        self.finish()


if __name__ == "__main__":
    unittest.main()
