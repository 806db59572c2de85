#!/usr/bin/env python3
"""Draws the images of the Godot add-on's store page with $GODOT, and writes them to doc/images/godot_store_*.jpg.

    scons godot=yes tests=no
    demo_project/make_store_images.py

Without $GODOT it takes `godot` in PATH, else that of demo_project/install_godot.sh. Arguments are the images to draw, such as thumbnail;
none: all. Afterwards compare the images with their captions in doc/godot_store.md.
"""

import os
import re
import shutil
import sys

import godot_project

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROJECT = os.path.join(ROOT, "build", "godot_store")
OUT = os.path.join(PROJECT, "out")
INSTALLED = os.path.join(ROOT, "build", "godot_program", "godot")
NAMES = ("thumbnail", "details", "room", "editor")
MAIN_SCENE = re.compile(r"(?m)^run/main_scene=.*\n")
PLUGIN = '[plugin]\nname="Store editor"\ndescription=""\nauthor=""\nversion=""\nscript="editor.gd"\n'


def write_project():
    """Write the demo's project with the scripts of demo_project/store from scratch."""
    shutil.rmtree(PROJECT, ignore_errors=True)
    shutil.copytree(godot_project.PROJECT, PROJECT, ignore=shutil.ignore_patterns(".godot", "out"))
    shutil.copytree(os.path.join(ROOT, "demo_project", "store"), os.path.join(PROJECT, "store"))
    os.makedirs(OUT)
    open(os.path.join(OUT, ".gdignore"), "w").close()  # nothing for Godot to import
    godot_project.prepare(PROJECT)


def draw(only):
    """Return what Godot printed while it drew the images of store_images.gd; only: the name of one, or "" for all."""
    return godot_project.run_godot(
        ["--path", PROJECT] + godot_project.DEVICE_OPTIONS + ["res://store/store_images.tscn", "--", "out=" + OUT, "only=" + only]
    )


def photograph_editor():
    """Return what Godot printed while its editor drew its image. Needs the scene that the thumbnail's run saves."""
    folder = os.path.join(PROJECT, "addons", "store_editor")
    os.makedirs(folder)
    shutil.move(os.path.join(PROJECT, "store", "editor.gd"), folder)
    with open(os.path.join(folder, "plugin.cfg"), "w", encoding="utf-8") as file:
        file.write(PLUGIN)
    path = os.path.join(PROJECT, "project.godot")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    enabled = '"res://addons/gnomon/plugin.cfg"'
    with open(path, "w", encoding="utf-8") as file:
        # Without a main scene, which the editor would open.
        file.write(MAIN_SCENE.sub("", text).replace(enabled, enabled + ', "res://addons/store_editor/plugin.cfg"'))
    return godot_project.run_godot(["--editor", "--path", PROJECT] + godot_project.DEVICE_OPTIONS)


def main():
    requested = sys.argv[1:] or list(NAMES)
    unknown = set(requested) - set(NAMES)
    if unknown:
        raise SystemExit("ERROR: no image %s, must be of: %s." % (", ".join(sorted(unknown)), ", ".join(NAMES)))
    os.environ.setdefault("GODOT", shutil.which("godot") or INSTALLED)
    write_project()
    output = "".join(draw(name) for name in NAMES[:-1] if name in requested or (name == "thumbnail" and "editor" in requested))
    if "editor" in requested:
        output += photograph_editor()
    for line in output.splitlines():
        if line.startswith("godot_store_"):
            print(line)
    for name in requested:
        shutil.copy(os.path.join(OUT, "godot_store_%s.jpg" % name), os.path.join(ROOT, "doc", "images"))


if __name__ == "__main__":
    main()
