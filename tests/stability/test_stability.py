"""Extreme parameter values: no technique fails, nonsense results come with a warning, and edge_count keeps its error limits.

STABILITY_EXTENT=full sweeps all techniques over all values. Otherwise some techniques are swept, over
two or three values of each sweep.
"""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stability_case import IS_FULL, ROOT, StabilityCase, find_techniques  # noqa: E402

SCENE = os.path.join(ROOT, "demo_project", "scenes", "sphere.gltf")
QUICK_TECHNIQUES = ("shadow_map", "pcss", "outer_fins", "edge_count")
# Techniques whose result is nonsense by design in these sweeps (None: all), although the light is within their limits.
BY_DESIGN = {
    "planar": None,  # it shadows only declared receivers, and only from casters in front of their plane
    "edge_count": ("fin_width",),  # it takes the mean of r and t as the light's size
}
SWEEP_LIMITS = {"light_size": 0.75, "depth_range": 1e7, "scale": 1e3, "offset": 1e6}  # sweep -> value up to which edge_count must keep its error limit
MIN_MAE = 1.0 / 256  # smaller errors are invisible in an 8-bit image
MAX_CHANGE = 0.003  # RMSE of edge_count's change while the light moves by 0.001 R; doc/stability.md has 0.0014


class Stability(StabilityCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.ids = find_techniques(QUICK_TECHNIQUES)
        cls.measure(SCENE, 1024 if IS_FULL else 256, "--techniques", ",".join(cls.ids))

    def test_every_point_is_measured_and_none_fails(self):
        self.assertEqual(self.status, 0, self.errors)
        # doc/stability.md counts 415 points for each of the ten techniques of a full sweep.
        self.assertGreater(len(self.points), 3000 if IS_FULL else 200)
        for sweep, light, technique, point, cell in self.points:
            with self.subTest(sweep=sweep, light=light, technique=technique, value=point["label"]):
                self.assertIn(point["state"], ("ok", "doubled", "nonsense"), cell)

    def test_nonsense_is_warned_of(self):
        for sweep, light, technique, point, cell in self.points:
            by_design = technique in BY_DESIGN and sweep in (BY_DESIGN[technique] or (sweep,))
            if point["state"] == "nonsense" and not by_design:
                with self.subTest(sweep=sweep, light=light, technique=technique, value=point["label"]):
                    self.assertTrue(cell["stability"]["warnings"])

    def test_scaled_and_moved_scenes_are_not_warned_of(self):
        for sweep, light, technique, point, cell in self.points:
            if sweep in ("scale", "offset"):
                self.assertEqual(cell["stability"]["warnings"], [], technique)

    def test_edge_count_holds_its_error(self):
        if "edge_count" not in self.ids:
            return
        for plot in self.report["stability"]:
            (series,) = [item for item in plot["series"] if item["technique"] == "edge_count"]
            for point in series["points"]:
                cell = self.report["cells"][point["cell"]]
                moved = cell["stability"].get("temporal_rmse")
                with self.subTest(sweep=plot["sweep"], light=plot["light_type"], value=point["label"]):
                    if plot["sweep"] in SWEEP_LIMITS and point["value"] <= SWEEP_LIMITS[plot["sweep"]]:
                        center = next(item for item in series["points"] if item["label"] == plot["center"])
                        reference = self.report["configurations"][cell["configuration"]]["reference_mask"]
                        # The limit of the state "doubled" (StabilityState::DOUBLED).
                        allowed = max(2 * center["mae"], MIN_MAE) + 2 * reference["standard_error"]
                        self.assertLessEqual(point["mae"], allowed)
                    if moved is not None:
                        self.assertLessEqual(moved, MAX_CHANGE)

    def test_a_caster_in_the_light_does_not_double_the_error_of_edge_count(self):
        states = [
            point["state"]
            for sweep, _, technique, point, _ in self.points
            if sweep == "inside" and technique == "edge_count"
        ]
        if "edge_count" in self.ids:
            self.assertTrue(states)
            self.assertNotIn("doubled", states)


if __name__ == "__main__":
    unittest.main()
