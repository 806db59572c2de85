#!/usr/bin/env python3
"""Drives the editor of $GODOT with the add-on (editor/driver.gd), and runs the scene that it saved: as a game, as an exported
game where $GODOT_TEMPLATE names a release template, and without the add-on. What the editor's viewport and the game show is
compared with the traced reference.

Last line: N passed, N failed, N skipped.
"""

import math
import os
import re
import shutil
import sys

import addon_project
import godot_images
import godot_project
import measure_godot

FOLDER = os.path.join(addon_project.ROOT, "build", "godot_editor")
SOURCES = os.path.join(addon_project.ROOT, "tests", "godot", "editor")
NODES = [".", "WorldEnvironment", "Ground", "Box", "Camera", "Light", "Light/GnomonShadow3D"]
# Messages of an editor that a script quits, that runs without desktop services, or without settings.
EDITOR_HARMLESS = re.compile(r"absolute paths from outside the active scene tree|text-to-speech|speech-dispatcher|libspeechd|D-Bus|dbus|Blender|SDK|editor_settings")
PRESET = """[preset.0]
name="Linux"
platform="Linux"
runnable=true
export_filter="all_resources"
include_filter=""
exclude_filter=""
export_path="exported/game"
[preset.0.options]
custom_template/release="%s"
binary_format/embed_pck=false
binary_format/architecture="x86_64"
"""
EXPORTED = os.path.join(FOLDER, "exported")
MAX_RMSE = 0.006
SAMPLES = 1024  # of the light, in the reference
MIN_LIGHT = 0.02  # pixels where the light adds less are not compared
# Messages about the missing add-on.
MISSING = re.compile(r"GnomonShadow3D|gnomon\.gdextension|addons/gnomon")


def write_project():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    shutil.copytree(os.path.join(godot_project.PROJECT, "addons"), os.path.join(FOLDER, "addons"))
    driver = os.path.join(FOLDER, "addons", "editor_test")
    os.makedirs(driver)
    shutil.copy(os.path.join(godot_project.PROJECT, "study", "gltf_export.gd"), FOLDER)
    for name in os.listdir(SOURCES):
        shutil.copy(os.path.join(SOURCES, name), driver if name in ("plugin.cfg", "driver.gd") else FOLDER)
    with open(os.path.join(FOLDER, "project.godot"), "w", encoding="utf-8") as file:
        file.write(
            'config_version=5\n[application]\nconfig/name="Editor test"\nconfig/features=PackedStringArray("4.6", "Forward Plus")\n'
            "[rendering]\ngnomon/gradual_compilation=false\n"  # the game's image is stored after a few frames
            '[editor_plugins]\nenabled=PackedStringArray("res://addons/gnomon/plugin.cfg", "res://addons/editor_test/plugin.cfg")\n'
        )
    godot_project.prepare(FOLDER)


def run_editor():
    """Run the editor. Return (its output, names of passed checks, failures)."""
    arguments = ["--editor", "--path", FOLDER] + godot_project.DEVICE_OPTIONS
    code, output = godot_project.start_godot(arguments + ["--resolution", "1200x900"])
    print(output)
    failures = re.findall(r"^FAIL (.*)$", output, re.MULTILINE)
    failures += ["the editor ended with %d" % code] if code != 0 else []
    failures += ["the editor logged " + line for line in godot_project.find_messages(output) if not EDITOR_HARMLESS.search(line)]
    return output, re.findall(r"^PASS (.*)$", output, re.MULTILINE), failures


def run_game(name):
    """Run the saved scene and return its output."""
    output = godot_project.run("res://game.tscn", [name, FOLDER], 320, FOLDER)
    print(output)
    return output


def find_nodes(output):
    return re.findall(r"^NODE (.*)$", output, re.MULTILINE)


def measure(name, output):
    """Return the RMSE in the penumbra of the images that LightImages stored as NAME, against the reference. Infinite if none."""
    size = re.search(r"^SIZE %s (\d+) (\d+)$" % name, output, re.MULTILINE)
    if size is None:
        return math.inf
    width, height = map(int, size.groups())
    stem = os.path.join(FOLDER, name)
    shadow, lit, dark = (godot_images.load_rows("%s_%s.f32" % (stem, part), width)[0] for part in ("shadow", "lit", "dark"))
    visibilities = [(s - d) / (l - d) if l - d > MIN_LIGHT else -1.0 for s, l, d in zip(shadow, lit, dark)]
    godot_images.save_gray_png(stem + "_visibility.png", visibilities, width)
    reference = measure_godot.trace_reference(stem + ".gltf", "Light", stem + "_reference", (width, height), SAMPLES, "ViewCamera")
    rmse = measure_godot.compute_rmse(reference, visibilities, reference.find_penumbra())
    print("%s: RMSE %.4f over %d x %d pixels" % (name, rmse, width, height))
    return rmse


def export_game():
    """Export the game and return what Godot logged."""
    with open(os.path.join(FOLDER, "project.godot"), "a", encoding="utf-8") as file:
        file.write('[application]\nrun/main_scene="res://game.tscn"\n')  # only now, because the editor would open it
    os.makedirs(EXPORTED)
    open(os.path.join(EXPORTED, ".gdignore"), "w").close()
    with open(os.path.join(FOLDER, "export_presets.cfg"), "w", encoding="utf-8") as file:
        file.write(PRESET % os.environ["GODOT_TEMPLATE"])
    path = os.path.join(EXPORTED, "game")
    return godot_project.find_messages(godot_project.run_godot(["--headless", "--path", FOLDER, "--export-release", "Linux", path]))


def read_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def main():
    write_project()
    output, passed, failures = run_editor()

    def check(name, holds, what=""):
        if holds:
            passed.append(name)
        else:
            failures.append("%s: %s" % (name, what))

    def check_rmse(name, printed):
        rmse = measure(name, printed)
        check("the %s shows the reference's shadow" % name, rmse <= MAX_RMSE, "RMSE %.4f, at most %.4f" % (rmse, MAX_RMSE))

    check_rmse("view", output)
    output = run_game("game")
    check("the game has all nodes", find_nodes(output) == NODES, find_nodes(output))
    messages = godot_project.find_messages(output)
    check("the game logs nothing", not messages, messages)
    check_rmse("game", output)
    skipped = 0
    if os.environ.get("GODOT_TEMPLATE"):
        messages = export_game()
        code, output = godot_project.start_game(os.path.join(EXPORTED, "game"), ["--resolution", "320x320", "--", "exported", FOLDER])
        messages += godot_project.find_messages(output)
        check("the exported game logs nothing", code == 0 and not messages, [code] + messages)
        same = read_bytes(os.path.join(FOLDER, "exported.png")) == read_bytes(os.path.join(FOLDER, "game.png"))
        check("the exported game shows the same", same, "exported.png and game.png differ")
    else:
        print("SKIPPED: $GODOT_TEMPLATE names no release template, no game is exported")
        skipped = 2  # the checks of the exported game
    shutil.rmtree(os.path.join(FOLDER, "addons"))
    os.remove(os.path.join(FOLDER, ".godot", "extension_list.cfg"))
    output = run_game("without")
    messages = godot_project.find_messages(output)
    check("without the add-on no node is lost", find_nodes(output) == NODES, find_nodes(output))
    check("without the add-on only its absence is logged", all(MISSING.search(line) for line in messages), messages)
    return addon_project.report(passed, failures, skipped)


if __name__ == "__main__":
    sys.exit(main())
