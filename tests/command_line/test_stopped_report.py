"""`gnomon report`: stopped reports are resumed, and bad input is reported or refused."""

import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_report_page import check_page  # noqa: E402
from command_line_case import GNOMON, SCENES, run  # noqa: E402
from report_case import PROJECT, QUICK, ReportCase, drop_times, get_record_path, load_report, stop_after  # noqa: E402

STOP_TIMEOUT_S = 120
POLL_S = 0.01


class StoppedReports(ReportCase):
    def stop_half_way(self, name, record):
        """Kill a run that hangs after it has written the record."""
        techniques = ("--techniques", self.report_techniques())
        options = ("--scenes", "contact_box,sphere", "--sizes", "0.2,0.8", *techniques, *QUICK)
        command = [GNOMON, "report", PROJECT, "--out", self.path(name), *options]
        path = get_record_path(self.path(name), record)
        environment = {**os.environ, **stop_after(path)}
        process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + STOP_TIMEOUT_S
        while process.poll() is None and time.monotonic() < end and not os.path.exists(path):
            time.sleep(POLL_S)
        self.assertTrue(os.path.exists(path), "the run did not get to its record")
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(), -signal.SIGKILL, "the run ended before it was killed")

    def load_records(self, name):
        records = {}
        for item in os.listdir(self.path(name + "/cells")):
            with open(self.path("%s/cells/%s" % (name, item)), "rb") as file:
                records[item] = file.read()
        return records

    def test_a_killed_run_goes_on_where_it_was(self):
        whole = self.load_done("whole", self.small("whole"))
        half_count = len(whole["cells"]) // 2
        self.stop_half_way("report", whole["cells"][half_count - 1]["record"])
        before = {name: data for name, data in self.load_records("report").items() if not name.endswith(".gnomon_part")}
        self.assertFalse(os.path.exists(self.path("report/report.json")))
        # There is a complete page of the cells measured so far.
        self.assertEqual(check_page(self.path("report/index.html")), [])
        with open(self.path("report/index.html"), encoding="utf-8") as file:
            self.assertNotIn('"missing_count":0', file.read())
        result = self.small("report", "--resume")
        self.assertIn("Resuming: %d cells are there, %d are left" % (half_count, len(whole["cells"]) - half_count), result.stderr)
        resumed = self.load_done("report", result)
        self.assertEqual(drop_times(resumed)["configurations"], drop_times(whole)["configurations"])
        self.assertEqual(drop_times(resumed)["cells"], drop_times(whole)["cells"])
        after = self.load_records("report")
        for name, data in before.items():
            if name in after:
                self.assertEqual(after[name], data, "measured again: " + name)
        again = self.small("report", "--resume")
        self.assertIn("0 are left", again.stderr)
        self.assertEqual(self.load_done("report", again), resumed)

    def test_a_damaged_record_is_measured_again(self):
        whole = self.load_done("report", self.small("report"))
        victim = whole["cells"][3]["record"]  # of any cell
        path = self.path("report/cells/%s.json" % victim)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace('"mae":0.', '"mae":1.', 1))  # the checksum is now wrong
        result = self.small("report", "--resume")
        self.assertRegex(result.stderr, r"WARNING: .*%s.* is damaged" % victim)
        self.assertIn("1 are left", result.stderr)
        self.assertEqual(drop_times(self.load_done("report", result)["cells"]), drop_times(whole["cells"]))

    def test_a_damaged_reference_in_the_cache_is_traced_again(self):
        cache = self.path("cache")
        arguments = ("--scenes", "sphere", "--sizes", "0.4", "--techniques", self.get_fallback())
        whole = self.load_done("report", self.report("report", *arguments, GNOMON_CACHE_DIR=cache))
        (entry,) = [os.path.join(cache, name) for name in os.listdir(cache) if name.startswith("reference_")]
        with open(entry, "rb") as file:
            data = bytearray(file.read())
        data[len(data) // 2] ^= 0x10  # flips a bit
        with open(entry, "wb") as file:
            file.write(data)
        result = self.report("again", *arguments, GNOMON_CACHE_DIR=cache)
        self.assertIn("damaged", result.stderr)
        self.assertEqual(drop_times(self.load_done("again", result)["cells"]), drop_times(whole["cells"]))
        with open(entry, "rb") as file:
            self.assertNotEqual(file.read(), bytes(data), "the entry was not rewritten")

    def test_a_scene_that_cannot_be_loaded_is_reported_and_the_rest_goes_on(self):
        project = self.path("project")
        os.mkdir(project)
        for name in ("sphere.gltf", "sphere.bin"):
            shutil.copy(os.path.join(SCENES, name), project)
        with open(os.path.join(project, "broken.gltf"), "w", encoding="utf-8") as file:
            file.write("{")
        with open(os.path.join(project, "project.cfg"), "w", encoding="utf-8") as file:
            file.write('[project]\nname="Two"\nscenes=["broken.gltf", "sphere.gltf"]\n')
        arguments = ("--sizes", "0.4", "--techniques", self.get_fallback())
        result = self.report("report", *arguments, project=project)
        self.assertEqual(result.returncode, 1)
        report = load_report(self.path("report"))
        self.assertEqual([item["status"] for item in report["configurations"]], ["failed", "ok"])
        self.assertIn("broken.gltf", report["configurations"][0]["message"])
        self.assertEqual(report["cells"][0]["status"], "ok")
        self.assertEqual(check_page(self.path("report/index.html")), [])


class RefusedReports(ReportCase):
    def test_bad_options_are_named(self):
        for arguments, words in (
            (("--scenes", "nowhere"), ("nowhere", "sphere")),
            (("--techniques", "magic"), ("magic", self.get_fallback())),
            (("--sizes", "-1"), ("-1", "0..")),
            (("--sizes", "nan"), ("nan", "0..")),
            (("--size", "0x5"), ("0x5",)),
            (("--samples", "0"), ("samples",)),
            (("--light-types", "candle"), ("candle", "omni")),
            (("--scaling", "huge"), ("huge", "quick")),
            (("--shard", "3/2"), ("3/2",)),
            (("--shard", "0/2"), ("0/2",)),
            (("--shard", "half"), ("half",)),
            (("--shard", "1/-1"), ("1/-1",)),
            (("--precision", "-1"), ("precision",)),
            (("--budget", "-3"), ("-3",)),
        ):
            with self.subTest(arguments=arguments):
                self.assert_refused(run("report", PROJECT, "--out", self.path("out"), *arguments), *words, code=2)

    def test_no_project_is_wrong_usage(self):
        self.assert_refused(run("report"), "PROJECT", code=2)

    def test_an_old_report_that_cannot_be_read_is_named_before_the_work(self):
        self.assert_refused(run("report", PROJECT, "--out", self.path("out"), "--against", self.path("gone.json")), "gone.json")

    def test_a_project_that_does_not_exist_is_named(self):
        self.assert_refused(run("report", self.path("demo_projct"), "--out", self.path("out")), "demo_projct")

    def test_two_scenes_of_one_name_are_refused(self):
        text = '[project]\nname="Twins"\nscenes=["a/room.gltf", "b/room.gltf"]\n'
        project = self.path("twins")
        for name in ("a", "b"):
            os.makedirs(os.path.join(project, name))
            shutil.copy(os.path.join(SCENES, "sphere.gltf"), os.path.join(project, name, "room.gltf"))
        with open(os.path.join(project, "project.cfg"), "w", encoding="utf-8") as file:
            file.write(text)
        result = run("report", project, "--out", self.path("out"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("two scenes are named", result.stderr)

    def test_a_report_of_other_options_is_not_resumed_and_not_lost(self):
        whole = self.load_done("report", self.small("report"))
        result = self.report("report", "--scenes", "sphere", "--resume")
        self.assertEqual(result.returncode, 1)
        self.assertIn("other options", result.stderr)
        self.assertEqual(load_report(self.path("report")), whole)
        self.assertEqual(self.load_done("report", self.small("report", "--resume")), whole)

    def test_a_folder_without_parts_cannot_be_merged(self):
        self.assert_refused(run("report", "merge", self.path("gone"), "--out", self.path("out")), "gone")

    def test_an_out_folder_that_cannot_be_made_is_named(self):
        inside = os.path.join(self.write("notes.txt", "hello"), "report")
        self.assert_refused(run("report", PROJECT, "--out", inside, *QUICK), "notes.txt")


if __name__ == "__main__":
    unittest.main()
