"""Merged, open, duplicated and third-party meshes: every technique draws them with each type of light, and none fails.

STABILITY_EXTENT=full measures all scenes, those of a second seed too, with all techniques. Otherwise
two package meshes, the generated scenes of one seed and four techniques are measured.
"""

import json
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stability_case import IS_FULL, StabilityCase, find_techniques, run_program  # noqa: E402
from untuned_project import DEFAULT_SEED, PACKAGE_MESHES, make_untuned_project, save_artist_scene  # noqa: E402

SECOND_SEED = 7
ROPE_COUNT = 1000
QUICK_PACKAGE_MESHES = ("jeep", "regr01")
QUICK_TECHNIQUES = ("shadow_map", "pcss", "shadow_volume", "edge_count")
# These have a penumbra MAE of 0.03 to 0.13 on these scenes; a hard shadow has 0.18 to 0.3, and so
# have masks that lack parts of the mesh.
SOFT_TECHNIQUES = ("pcss", "views")
MAX_SOFT_MAE = 0.16
# Receivers that are fully lit or hidden in the reference and wrong by more than 0.5, as a fraction of all receivers. Shadow
# volumes are exact there.
EXACT_TECHNIQUES = ("shadow_volume", "shadow_volume_cpu")
MAX_WRONG_FRACTION = 0.001


class UntunedMeshes(StabilityCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        project = os.path.join(cls.holder.name, "project")
        os.mkdir(project)
        seeds = (DEFAULT_SEED, SECOND_SEED) if IS_FULL else (DEFAULT_SEED,)
        package_meshes = PACKAGE_MESHES if IS_FULL else QUICK_PACKAGE_MESHES
        cls.scenes, cls.failed = make_untuned_project(project, seeds, package_meshes)
        cls.ids = find_techniques(QUICK_TECHNIQUES)
        cls.measure(project, 256, "--sweeps", "scenes", "--techniques", ",".join(cls.ids))

    def test_every_package_mesh_is_converted(self):
        self.assertEqual(self.failed, [])

    def test_every_technique_draws_every_scene_with_every_light(self):
        self.assertEqual(self.status, 0, self.errors)
        found = {(technique, point["label"]) for _, _, technique, point, _ in self.points}
        labels = ["%s/%s" % (scene, light) for scene in self.scenes for light in ("Spot", "Omni", "Sun")]
        expected = {(technique, label) for technique in self.ids for label in labels}
        self.assertEqual(found, expected)
        for _, light, technique, point, cell in self.points:
            # Values that are not finite or outside 0..1, and validation messages, are failures.
            with self.subTest(technique=technique, scene=point["label"], light=light):
                self.assertIn(point["state"], ("ok", "nonsense"), cell)

    def test_soft_techniques_draw_the_shadow_of_all_parts(self):
        for _, light, technique, point, _ in self.points:
            if technique in SOFT_TECHNIQUES:
                with self.subTest(technique=technique, scene=point["label"], light=light):
                    self.assertLess(point["mae"], MAX_SOFT_MAE)

    def test_shadow_volumes_are_exact_outside_penumbrae(self):
        for _, light, technique, point, cell in self.points:
            if technique in EXACT_TECHNIQUES:
                with self.subTest(technique=technique, scene=point["label"], light=light):
                    self.assertLess(cell["stability"]["wrong_share"], MAX_WRONG_FRACTION)

    def test_edge_count_has_no_wrong_receivers_among_a_thousand_ropes(self):
        # A tile of pixels has so many edges that building its lists would exceed llvmpipe's limit of loop
        # iterations ("Too many edges" in doc/techniques/edge_count.md).
        folder = os.path.join(self.holder.name, "ropes")
        os.mkdir(folder)
        scene = save_artist_scene("rigging", DEFAULT_SEED, ROPE_COUNT, "rigging", folder)
        masks = []
        for technique, setting in (("reference", "reference_samples=256"), ("edge_count", "edge_count_quality=64")):
            masks.append(os.path.join(folder, technique + ".exr"))
            result = run_program(
                "visibility", scene, "--technique", technique, "--light", "Sun", "--set", setting, "--size", "256x256",
                "--out", masks[-1], "--validation",
            )  # fmt: skip
            self.assertEqual(result.returncode, 0, result.stderr)
        errors = json.loads(run_program("compare", *masks).stdout)
        self.assertGreater(errors["penumbra"]["pixels"], 1000)
        self.assertEqual(errors["receiver"]["wrong"], 0.0)


if __name__ == "__main__":
    unittest.main()
