#!/usr/bin/env python3
"""Drives the editor of $GODOT with the add-on (editor/driver.gd), runs the scene that it saved, and that without the add-on.

Last line: N passed, N failed, N skipped.
"""

import os
import re
import shutil
import sys

import addon_project
import godot_project

FOLDER = os.path.join(addon_project.ROOT, "build", "godot_editor")
SOURCES = os.path.join(addon_project.ROOT, "tests", "godot", "editor")
NODES = [".", "Ground", "Box", "Camera", "Light", "Light/GnomonShadow3D"]
# Of an editor that a script quits, or that runs without what a desktop has, and of a scene whose extension is missing.
EDITOR_HARMLESS = re.compile(r"absolute paths from outside the active scene tree|text-to-speech|speech-dispatcher|libspeechd|D-Bus|dbus|Blender|SDK|editor_settings")
MISSING = re.compile(r"GnomonShadow3D|gnomon\.gdextension|addons/gnomon")


def write_project():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    shutil.copytree(os.path.join(godot_project.PROJECT, "addons"), os.path.join(FOLDER, "addons"))
    driver = os.path.join(FOLDER, "addons", "editor_test")
    os.makedirs(driver)
    for name in os.listdir(SOURCES):
        shutil.copy(os.path.join(SOURCES, name), driver if name in ("plugin.cfg", "driver.gd") else FOLDER)
    with open(os.path.join(FOLDER, "project.godot"), "w", encoding="utf-8") as file:
        file.write(
            'config_version=5\n[application]\nconfig/name="Editor test"\nconfig/features=PackedStringArray("4.6", "Forward Plus")\n'
            '[editor_plugins]\nenabled=PackedStringArray("res://addons/gnomon/plugin.cfg", "res://addons/editor_test/plugin.cfg")\n'
        )
    godot_project.prepare(FOLDER)


def run_editor():
    """Names of what passed, and what failed."""
    arguments = ["--editor", "--path", FOLDER, "--rendering-method", "forward_plus", "--rendering-driver", "vulkan"]
    code, output = godot_project.start_godot(arguments + ["--audio-driver", "Dummy", "--resolution", "1200x900"])
    print(output)
    failures = re.findall(r"^FAIL (.*)$", output, re.MULTILINE)
    failures += ["the editor ended with %d" % code] if code != 0 else []
    failures += ["the editor logged " + line for line in godot_project.find_messages(output) if not EDITOR_HARMLESS.search(line)]
    return re.findall(r"^PASS (.*)$", output, re.MULTILINE), failures


def run_game(name):
    """Runs the saved scene. Its nodes, and what Godot logged."""
    output = godot_project.run("res://game.tscn", [name], 320, FOLDER)
    print(output)
    return re.findall(r"^NODE (.*)$", output, re.MULTILINE), godot_project.find_messages(output)


def main():
    write_project()
    passed, failures = run_editor()

    def check(name, holds, what=""):
        if holds:
            passed.append(name)
        else:
            failures.append("%s: %s" % (name, what))

    nodes, messages = run_game("game")
    check("the game has all nodes", nodes == NODES, nodes)
    check("the game logs nothing", not messages, messages)
    shutil.rmtree(os.path.join(FOLDER, "addons"))
    os.remove(os.path.join(FOLDER, ".godot", "extension_list.cfg"))
    nodes, messages = run_game("without")
    check("without the add-on no node is lost", nodes == NODES, nodes)
    check("without the add-on only that is logged", all(MISSING.search(line) for line in messages), messages)
    return addon_project.report(passed, failures)


if __name__ == "__main__":
    sys.exit(main())
