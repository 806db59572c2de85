"""Godot's editor with the add-on, on a system that the add-on has no library for: one line states which systems it has one for."""

import os
import shutil
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "demo_project"))
import godot_project  # noqa: E402

FOLDER = os.path.join(ROOT, "build", "godot_missing")
LIBRARIES = """[libraries]
macos = "res://addons/gnomon/bin/libgnomon.macos.dylib"
"""


class MissingLibrary(unittest.TestCase):
    def test_the_plugin_logs_one_line_of_its_own(self):
        shutil.rmtree(FOLDER, ignore_errors=True)
        addon = os.path.join(FOLDER, "addons", "gnomon")
        shutil.copytree(os.path.join(godot_project.PROJECT, "addons", "gnomon"), addon, ignore=shutil.ignore_patterns("bin"))
        path = os.path.join(addon, "gnomon.gdextension")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text[: text.index("[libraries]")] + LIBRARIES)
        with open(os.path.join(FOLDER, "project.godot"), "w", encoding="utf-8") as file:
            file.write('config_version=5\n[editor_plugins]\nenabled=PackedStringArray("res://addons/gnomon/plugin.cfg")\n')
        os.makedirs(os.path.join(FOLDER, ".godot"))
        with open(os.path.join(FOLDER, ".godot", "extension_list.cfg"), "w", encoding="utf-8") as file:
            file.write("res://addons/gnomon/gnomon.gdextension\n")
        code, output = godot_project.start_godot(["--headless", "--editor", "--quit", "--path", FOLDER])
        self.assertEqual(code, 0, output)
        lines = [line for line in godot_project.find_messages(output) if "Gnomon: " in line]
        self.assertEqual(len(lines), 1, output)
        self.assertRegex(lines[0], "its library did not load on Linux \\w+\\. It is built for Windows x86_64, Linux x86_64 and Linux arm64,")
        # Those of Godot itself, about the extension.
        others = [line for line in godot_project.find_messages(output) if line not in lines]
        self.assertTrue(all("extension" in line.lower() for line in others), others)


if __name__ == "__main__":
    unittest.main()
