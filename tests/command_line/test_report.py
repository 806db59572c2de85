"""`gnomon report`: what it writes, and how it compares reports."""

import csv
import json
import os
import re
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_report_page import check_page  # noqa: E402
from command_line_case import SCENES, find_technique, load_json, run  # noqa: E402
from report_case import PROJECT, SMALL_REFERENCE, ReportCase, drop_times, load_report  # noqa: E402


class Reports(ReportCase):
    def test_a_report_has_all_cells_with_errors_and_times(self):
        report = self.load_done("report", self.small("report"))
        # In the order of the project, which differs from that of --scenes.
        self.assertEqual([item["id"] for item in report["configurations"]][:2], ["sphere/Light/0.2", "sphere/Light/0.8"])
        self.assertEqual(len(report["configurations"]), 4)
        self.assertEqual((report["failed_count"], report["missing_count"]), (0, 0))
        for cell in report["cells"]:
            self.assertEqual(cell["status"], "ok")
            self.assertTrue(0.0 <= cell["error"]["all"]["penumbra"]["mae"] < 0.6)
            self.assertLessEqual(cell["error"]["whole_light"]["pixels"], cell["error"]["all"]["pixels"])
            self.assertTrue(5 <= cell["time"]["frames"] <= 20)  # timing may end early
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
        reference_path, mask = self.path("reference.exr"), self.path("mask.exr")
        scene = os.path.join(SCENES, "sphere.gltf")
        common = ("--size", "64x64", "--set", "light_size=0.8")
        reference = find_technique("is_reference")
        run("visibility", scene, "--technique", reference, "--out", reference_path, *common, "--set", reference + "_samples=64")
        run("visibility", scene, "--technique", self.get_fallback(), "--out", mask, *common)
        index = [item["id"] for item in report["configurations"]].index("sphere/Light/0.8")
        (cell,) = [
            item
            for item in report["cells"]
            if item["configuration"] == index and item["technique"] == self.get_fallback()
        ]
        self.assertEqual(cell["error"]["all"], load_json("compare", reference_path, mask))

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
        # One configuration for each of the default light sizes.
        self.assertEqual(len(self.load_done("report", result)["configurations"]), 3)

    def test_light_types_and_scaling_curves_are_measured_when_requested(self):
        fallback = ("--techniques", self.get_fallback(), "--scenes", "sphere", "--sizes", "0.4")
        result = self.report("report", *fallback, "--light-types", "spot,omni,directional")
        types = [item["light_type"] for item in self.load_done("report", result)["configurations"]]
        self.assertEqual(types, ["spot", "omni", "directional"])
        options = (*SMALL_REFERENCE, *fallback, "--scaling", "quick", "--out", self.path("more"))
        report = self.load_done("more", run("report", PROJECT, *options))
        self.assertEqual([item["name"] for item in report["scaling"]], ["triangles", "light_size", "lights", "resolution"])
        for curve in report["scaling"]:
            for series in curve["series"]:
                values = [point["value"] for point in series["points"]]
                self.assertEqual((values, len(values)), (sorted(values), 3))

    def test_own_sizes_default_settings_and_skipped_scenes_are_respected(self):
        options = ("--sizes", "own", "--settings", "default", "--frames", "2", "--skip", "*ree_*ts,contact*,s*x*e")
        report = self.load_done("report", self.report("report", "--scenes", "three_lights,contact_box,sphere,terrain", *options))
        self.assertEqual([item["id"] for item in report["configurations"]], ["sphere/Light/0.4", "terrain/Light/0.4"])
        self.assertEqual({cell["setting"] for cell in report["cells"]}, {"default"})
        self.assertEqual({cell["time"]["frames"] for cell in report["cells"]}, {2})

    def test_own_sizes_are_those_of_the_file(self):
        report = self.load_done("report", self.report(
            "report", "--scenes", "three_lights", "--sizes", "own", "--techniques", self.get_fallback(),
        ))  # fmt: skip
        (sun,) = [item for item in report["configurations"] if item["light_type"] == "directional"]
        self.assertAlmostEqual(sun["light_angular_distance_deg"], 6.0, 3)
        report = self.load_done("types", self.report(
            "types", "--scenes", "sphere", "--sizes", "own", "--light-types", "omni", "--techniques", self.get_fallback(),
        ))  # fmt: skip
        self.assertEqual([item["light_size_m"] for item in report["configurations"]], [0.4])

    def test_wrong_sizes_are_refused(self):
        for sizes in ("own,0.4", "large", "-1", "nan"):
            result = self.report("report", "--scenes", "sphere", "--sizes=" + sizes)
            self.assertEqual(result.returncode, 2)
            self.assertIn("--sizes", result.stderr)

    def test_each_scene_is_on_the_page_with_and_without_shadows(self):
        report = self.load_done("report", self.small("report"))
        shown = [(item["scene"], item["has_shadows"]) for item in report["scene_images"]]
        self.assertEqual(sorted(shown), sorted((name, flag) for name in ("contact_box", "sphere") for flag in (True, False)))
        images = []
        for item in report["scene_images"]:
            with open(self.path("report/cells/" + item["image"]), "rb") as file:
                images.append(file.read())
        self.assertEqual(len(set(images)), 4)

    def test_equal_warnings_are_printed_once_with_their_number(self):
        arguments = ("--scenes", "sphere", "--sizes", "1.2", "--settings", "default", "--light-types", "spot,omni")
        lines = self.report("report", *arguments).stderr.splitlines()
        warnings = [line[len("WARNING: ") :] for line in lines if line.startswith("WARNING: ")]
        counted = [line.split(" times: ", 1)[1] for line in warnings if re.match(r"\d+ times: ", line)]
        self.assertGreater(len(counted), 0, lines)  # such large lights exceed the limits of some techniques
        for line in counted:  # also printed without its number, when it was first logged
            self.assertEqual(warnings.count(line), 1)

    def test_the_budget_names_the_least_error_within_it(self):
        result = self.small("report", "--budget", "1000000")
        report = self.load_done("report", result)
        self.assertIn("Least error within 1e+06 ms", result.stdout)
        for choice in report["budget"]["choices"]:
            cells = [item for item in report["cells"] if item["configuration"] == choice["configuration"]]
            least = min(item["error"]["all"]["penumbra"]["mae"] for item in cells)
            self.assertEqual(report["cells"][choice["cell"]]["error"]["all"]["penumbra"]["mae"], least)
        result = self.small("report", "--budget", "1e-6", "--resume")
        # Each choice lacks its "cell".
        self.assertEqual([list(item) for item in self.load_done("report", result)["budget"]["choices"]], [["configuration"]] * 4)
        self.assertIn("nothing is that quick", result.stdout)


class ComparedReports(ReportCase):
    def change(self, name, change):
        """Write a copy of the report in which `change` has modified every cell. Return its path."""
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

        def was_much_faster(cell):
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
        slower = self.small("report", "--resume", "--against", self.change("old.json", was_much_faster))
        self.assertEqual(slower.returncode, 0, slower.stderr)
        self.assertIn("slower than before", slower.stderr)

    def test_a_comparison_without_a_common_cell_fails(self):
        self.load_done("report", self.small("report"))
        old = self.path("report/report.json")
        arguments = ("--scenes", "sphere", "--sizes", "0.3", "--techniques", self.get_fallback(), "--against", old)
        result = self.report("other", *arguments)
        self.assertEqual(result.returncode, 1)
        self.assertIn("no cell was measured in both", result.stderr)

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


if __name__ == "__main__":
    unittest.main()
