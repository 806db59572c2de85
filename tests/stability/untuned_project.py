"""A project whose report draws merged, open, duplicated and third-party meshes in its stability sweep "scenes".

Untuned meshes are held-out test scenes: no technique was tuned with them."""

import contextlib
import io
import os
import shutil
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENES = os.path.join(ROOT, "demo_project", "scenes")
sys.path.insert(0, SCENES)

import gltf_writer  # noqa: E402
import make_artist_scenes  # noqa: E402
import make_package_meshes  # noqa: E402
import seeded_scenes  # noqa: E402

DEFAULT_SEED = seeded_scenes.DEFAULT_SEED
PACKAGE_MESHES = tuple(make_package_meshes.MESHES)


def save_artist_scene(name, seed, count, stem, folder):
    """Write a generated scene and return its path. count: number of parts, or None for the scene's default."""
    gltf_writer.save_files(make_artist_scenes.build_scene(name, seed, count).build_files(stem), folder)
    return os.path.join(folder, stem + ".gltf")


def make_untuned_project(folder, seeds=(DEFAULT_SEED,), package_meshes=PACKAGE_MESHES):
    """Write the project. Return (names of its scenes, package meshes that could not be converted, which stderr names too)."""
    for kind in (".gltf", ".bin"):
        shutil.copy(os.path.join(SCENES, "sphere" + kind), folder)  # a report times at least one scene
    names = []
    for seed in seeds:
        for name in make_artist_scenes.SCENES:
            stem = name if seed == DEFAULT_SEED else "%s_%d" % (name, seed)
            save_artist_scene(name, seed, None, stem, folder)
            names.append(stem)
    with contextlib.redirect_stdout(io.StringIO()):
        failed = make_package_meshes.make_scenes({name: make_package_meshes.MESHES[name] for name in package_meshes}, folder)
    names += [make_package_meshes.PREFIX + name for name in package_meshes if name not in failed]
    listed = ", ".join('"%s.gltf"' % name for name in names)
    with open(os.path.join(folder, "project.cfg"), "w", encoding="utf-8") as file:
        file.write('[project]\nname="Stability"\nscenes=["sphere.gltf"]\nstability_scenes=[%s]\n' % listed)
    return names, failed
