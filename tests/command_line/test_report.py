"""`gnomon report`: what it writes, what it refuses, and that a stopped run can go on."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_report_page import check_page  # noqa: E402
from command_line_case import GNOMON, ROOT, SCENES, CommandLineTest, find_technique, load_json, run  # noqa: E402

PROJECT = os.path.join(ROOT, "demo_project")
SMALL_TRUTH = ("--size", "64x64", "--samples", "64")
QUICK = (*SMALL_TRUTH, "--scaling", "none")
STOP_TIMEOUT_S = 120
POLL_S = 0.01


def load_report(folder):
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return json.load(file)


def drop_times(value):
    """A copy without what two measurements never have in common."""
    if isinstance(value, dict):
        timed = ("time", "wall_ms", "time_ratio", "cost_ms", "pareto", "scaling")
        return {name: drop_times(item) for name, item in value.items() if name not in timed}
    return [drop_times(item) for item in value] if isinstance(value, list) else value


class ReportCase(CommandLineTest):
    def report(self, name, *arguments, project=PROJECT, **environment):
        """The finished process; its report, where there is one, lies in the folder of that name."""
        return run("report", project, "--out", self.path(name), *QUICK, *arguments, **environment)

    def report_techniques(self):
        """The fallback and another one: enough for a report with ratios and a front."""
        listed = load_json("techniques", "--json")
        others = [item["id"] for item in listed if not item["is_fallback"] and not item["is_reference"]]
        return ",".join([self.get_fallback(), *others[:1]])

    def small(self, name, *arguments):
        techniques = ("--techniques", self.report_techniques())
        return self.report(name, "--scenes", "contact_box,sphere", "--sizes", "0.2,0.8", *techniques, *arguments)

    def load_done(self, name, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        return load_report(self.path(name))


class Reports(ReportCase):
    def test_errors_times_and_files_are_whole(self):
        report = self.load_done("report", self.small("report"))
        self.assertEqual([item["id"] for item in report["configurations"]][:2], ["sphere/Light/0.2", "sphere/Light/0.8"])
        self.assertEqual(len(report["configurations"]), 4)
        self.assertEqual((report["failed_count"], report["missing_count"]), (0, 0))
        for cell in report["cells"]:
            self.assertEqual(cell["status"], "ok")
            self.assertTrue(0.0 <= cell["error"]["all"]["penumbra"]["mae"] < 0.6)
            self.assertLessEqual(cell["error"]["whole_light"]["pixels"], cell["error"]["all"]["pixels"])
            self.assertTrue(5 <= cell["time"]["frames"] <= 20)
            self.assertGreater(cell["time"]["cost_ms"], 0.0)
            self.assertGreater(cell["bytes"], 0)
            if cell["technique"] == self.get_fallback():
                self.assertEqual(cell["time_ratio"], 1.0)
        errors = [row["penumbra_mae"] for row in report["ranking"]]
        self.assertEqual(errors, sorted(errors))
        with open(self.path("report/report.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(report["cells"]))
        for row, cell in zip(rows, report["cells"]):
            self.assertEqual(row["technique"], cell["technique"])
            self.assertAlmostEqual(float(row["penumbra_mae"]), cell["error"]["all"]["penumbra"]["mae"], 6)

    def test_the_errors_are_those_of_compare(self):
        report = self.load_done("report", self.small("report"))
        truth, mask = self.path("truth.exr"), self.path("mask.exr")
        scene = os.path.join(SCENES, "sphere.gltf")
        common = ("--size", "64x64", "--set", "light_size=0.8")
        reference = find_technique("is_reference")
        run("visibility", scene, "--technique", reference, "--out", truth, *common, "--set", reference + "_samples=64")
        run("visibility", scene, "--technique", self.get_fallback(), "--out", mask, *common)
        index = [item["id"] for item in report["configurations"]].index("sphere/Light/0.8")
        (cell,) = [
            item
            for item in report["cells"]
            if item["configuration"] == index and item["technique"] == self.get_fallback()
        ]
        self.assertEqual(cell["error"]["all"], load_json("compare", truth, mask))

    def test_the_page_is_drawn_without_a_console_message(self):
        self.load_done("report", self.small("report"))
        self.assertEqual(check_page(self.path("report/index.html")), [])

    def test_the_check_of_pages_notices_a_broken_one(self):
        self.load_done("report", self.small("report"))
        path = self.path("report/index.html")
        with open(path, encoding="utf-8") as file:
            page = file.read()
        broken = page.replace("</body>", '<img src="missing.png"><script>throw new Error("canary")</script></body>')
        self.assertNotEqual(broken, page)
        problems = "\n".join(check_page(self.write("broken.html", broken)))
        self.assertIn("canary", problems)
        self.assertIn("missing.png", problems)
        other = page.replace('"format":"gnomon_report"', '"format":"other"')
        self.assertNotEqual(other, page)
        self.assertIn("data-ready is 'failed'", "\n".join(check_page(self.write("other.html", other))))

    def test_one_scene_file_is_a_report_too(self):
        scene = os.path.join(SCENES, "contact_box.gltf")
        result = self.report("report", "--techniques", self.get_fallback(), project=scene)
        self.assertEqual(len(self.load_done("report", result)["configurations"]), 3)

    def test_light_types_and_scaling_curves_are_measured_when_asked_for(self):
        fallback = ("--techniques", self.get_fallback(), "--scenes", "sphere", "--sizes", "0.4")
        result = self.report("report", *fallback, "--light-types", "spot,omni,directional")
        types = [item["light_type"] for item in self.load_done("report", result)["configurations"]]
        self.assertEqual(types, ["spot", "omni", "directional"])
        options = (*SMALL_TRUTH, *fallback, "--scaling", "quick", "--out", self.path("more"))
        report = self.load_done("more", run("report", PROJECT, *options))
        self.assertEqual([item["name"] for item in report["scaling"]], ["triangles", "light_size", "lights", "resolution"])
        for curve in report["scaling"]:
            for series in curve["series"]:
                values = [point["value"] for point in series["points"]]
                self.assertEqual((values, len(values)), (sorted(values), 3))

    def test_the_budget_names_the_least_error_within_it(self):
        result = self.small("report", "--budget", "1000000")
        report = self.load_done("report", result)
        self.assertIn("Least error within 1e+06 ms", result.stdout)
        for choice in report["budget"]["choices"]:
            cells = [item for item in report["cells"] if item["configuration"] == choice["configuration"]]
            least = min(item["error"]["all"]["penumbra"]["mae"] for item in cells)
            self.assertEqual(report["cells"][choice["cell"]]["error"]["all"]["penumbra"]["mae"], least)
        result = self.small("report", "--budget", "1e-6", "--resume")
        self.assertEqual([list(item) for item in self.load_done("report", result)["budget"]["choices"]], [["configuration"]] * 4)
        self.assertIn("nothing is that quick", result.stdout)


class StoppedReports(ReportCase):
    def stop_half_way(self, name, cell_count):
        """Kills a run as soon as it has kept that many records."""
        techniques = ("--techniques", self.report_techniques())
        options = ("--scenes", "contact_box,sphere", "--sizes", "0.2,0.8", *techniques, *QUICK)
        command = [GNOMON, "report", PROJECT, "--out", self.path(name), *options]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cells = self.path(name + "/cells")
        end = time.monotonic() + STOP_TIMEOUT_S
        while process.poll() is None and time.monotonic() < end:
            if os.path.isdir(cells) and sum(item.endswith(".json") for item in os.listdir(cells)) >= cell_count:
                break
            time.sleep(POLL_S)
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
        self.stop_half_way("report", 6)
        kept = {name: data for name, data in self.load_records("report").items() if not name.endswith(".tmp")}
        self.assertFalse(os.path.exists(self.path("report/index.html")))
        resumed = self.load_done("report", self.small("report", "--resume"))
        self.assertEqual(drop_times(resumed)["configurations"], drop_times(whole)["configurations"])
        self.assertEqual(drop_times(resumed)["cells"], drop_times(whole)["cells"])
        after = self.load_records("report")
        for name, data in kept.items():
            if name in after:
                self.assertEqual(after[name], data, "measured again: " + name)
        again = self.small("report", "--resume")
        self.assertIn("0 are left", again.stderr)
        self.assertEqual(self.load_done("report", again), resumed)

    def test_a_damaged_record_is_measured_anew(self):
        whole = self.load_done("report", self.small("report"))
        victim = next(cell["record"] for cell in whole["cells"][3:])
        path = self.path("report/cells/%s.json" % victim)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace('"mae":0.', '"mae":1.', 1))
        result = self.small("report", "--resume")
        self.assertRegex(result.stderr, r"WARNING: .*%s.* is damaged" % victim)
        self.assertIn("1 are left", result.stderr)
        self.assertEqual(drop_times(self.load_done("report", result)["cells"]), drop_times(whole["cells"]))

    def test_a_damaged_truth_in_the_cache_is_traced_anew(self):
        cache = self.path("cache")
        arguments = ("--scenes", "sphere", "--sizes", "0.4", "--techniques", self.get_fallback())
        whole = self.load_done("report", self.report("report", *arguments, GNOMON_CACHE_DIR=cache))
        (entry,) = [os.path.join(cache, name) for name in os.listdir(cache) if name.startswith("truth")]
        with open(entry, "rb") as file:
            data = bytearray(file.read())
        data[len(data) // 2] ^= 0x10
        with open(entry, "wb") as file:
            file.write(data)
        result = self.report("again", *arguments, GNOMON_CACHE_DIR=cache)
        self.assertIn("damaged", result.stderr)
        self.assertEqual(drop_times(self.load_done("again", result)["cells"]), drop_times(whole["cells"]))
        with open(entry, "rb") as file:
            self.assertNotEqual(file.read(), bytes(data), "the entry was not written anew")

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


class ComparedReports(ReportCase):
    def change(self, name, change):
        report = load_report(self.path("report"))
        for cell in report["cells"]:
            change(cell)
        path = self.path(name)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(report, file)
        return path

    def test_grown_errors_fail_and_grown_times_warn(self):
        def had_less_error(cell):
            cell["error"]["all"]["penumbra"]["mae"] *= 0.9

        def was_twice_as_fast(cell):
            if cell["technique"] != self.get_fallback():
                for key in ("cost_ms", "gpu_ms", "gpu_ms_p90", "wall_ms", "wall_ms_p90"):
                    cell["time"][key] /= 20

        self.load_done("report", self.small("report"))
        same = self.small("report", "--resume", "--against", self.path("report/report.json"))
        self.assertIn("Nothing differs", same.stdout)
        self.assertEqual(same.returncode, 0, same.stderr)
        worse = self.small("report", "--resume", "--against", self.change("old.json", had_less_error))
        self.assertEqual(worse.returncode, 1)
        self.assertIn("worse penumbra error: sphere/Light/0.8", worse.stdout)
        self.assertIn("Errors grew against", worse.stderr)
        report = load_report(self.path("report"))
        self.assertEqual(len(report["against"]["rows"]), len(report["cells"]))
        self.assertEqual(check_page(self.path("report/index.html")), [])
        slower = self.small("report", "--resume", "--against", self.change("old.json", was_twice_as_fast))
        self.assertEqual(slower.returncode, 0, slower.stderr)
        self.assertIn("slower than before", slower.stderr)

    def test_a_report_with_no_common_cell_is_no_proof(self):
        self.load_done("report", self.small("report"))
        old = self.path("report/report.json")
        arguments = ("--scenes", "sphere", "--sizes", "0.3", "--techniques", self.get_fallback(), "--against", old)
        result = self.report("other", *arguments)
        self.assertEqual(result.returncode, 1)
        self.assertIn("no cell is in both", result.stderr)

    def test_shards_are_merged_to_the_whole(self):
        whole = self.load_done("whole", self.small("whole"))
        for index in (1, 2, 3):
            part = self.load_done("part%d" % index, self.small("part%d" % index, "--shard", "%d/3" % index))
            self.assertGreater(part["missing_count"], 0)
        parts = [self.path("part%d" % index) for index in (1, 2, 3)]
        old = ("--against", self.path("whole/report.json"), "--budget", "50")
        result = run("report", "merge", *parts, "--out", self.path("merged"), *old)
        self.assertIn("Least error within 50 ms", result.stdout)
        self.assertEqual(drop_times(self.load_done("merged", result)["cells"]), drop_times(whole["cells"]))
        self.assertEqual(check_page(self.path("merged/index.html")), [])
        result = run("report", "merge", *parts[:2], "--out", self.path("less"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("missing", result.stderr)


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
