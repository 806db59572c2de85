"""The add-on's libraries need what every system has, export the entry point only, and are all in the zip.

`scons addon_zip=yes` builds them.
"""

import configparser
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from library_file import LibraryFile  # noqa: E402
from platforms import ADDON, LIBRARIES, ROOT, get_library  # noqa: E402

ENTRY = "gnomon_addon_init"
ZIP = os.path.join(ROOT, "bin", "gnomon_godot_addon.zip")
# All of them are part of the system. The third of Linux is the dynamic linker, which has the addresses of thread-local data.
ALLOWED_IMPORTS = {
    "linux.x86_64": {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"},
    "windows.x86_64": {"KERNEL32.dll", "msvcrt.dll"},
    "linux.arm64": {"libc.so.6", "libm.so.6", "ld-linux-aarch64.so.1"},
}
MAX_LIBRARY_BYTES = 16 << 20
# A library as compilers build it without the project's flags: it needs the compiler's own libraries, and exports more.
CARELESS_SOURCE = """
#include <iostream>
#include <string>
#ifdef _WIN32
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED
#endif
extern "C" EXPORTED int gnomon_addon_init() { std::cout << std::string(); return 1; }
extern "C" EXPORTED int forgotten() { return 2; }
"""
COMPILERS = {
    "linux.x86_64": ["g++", "-fPIC"],
    "windows.x86_64": ["x86_64-w64-mingw32-g++-posix"],
    "linux.arm64": ["aarch64-linux-gnu-g++", "-fPIC"],
}
# The entries of HEADERS in modules/platform_builders.py, whose code is in the libraries -> what the notices call them.
NOTICES = {"glm": "OpenGL Mathematics", "nlohmann": "JSON for Modern C++", "spirv_cross": "SPIRV-Cross", "xxhash.h": "xxHash"}


def read(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


def find_faults(platform, path):
    """Return a line for each property that a library for the platform must not have."""
    library = LibraryFile(path)
    faults = ["needs " + name for name in sorted(library.imports - ALLOWED_IMPORTS[platform])]
    faults += ["exports " + name for name in sorted(library.exports - {ENTRY})]
    if ENTRY not in library.exports:
        faults.append("does not export " + ENTRY)
    if library.machine != platform.split(".")[1]:
        faults.append("is for " + library.machine)
    if ".debug_info" in library.sections:
        faults.append("has debug information")
    return faults


class Libraries(unittest.TestCase):
    def test_they_need_what_every_system_has_and_export_the_entry_point_only(self):
        for platform in LIBRARIES:
            with self.subTest(platform):
                self.assertEqual(find_faults(platform, get_library(platform)), [])
                self.assertLess(os.path.getsize(get_library(platform)), MAX_LIBRARY_BYTES)

    def test_the_debug_information_is_next_to_them(self):
        for platform in LIBRARIES:
            with self.subTest(platform):
                path = get_library(platform)
                self.assertIn(".debug_info", LibraryFile(path + ".debug").sections)
                self.assertIn(".gnu_debuglink", LibraryFile(path).sections)

    def test_a_library_built_without_the_flags_is_noticed(self):
        for platform, compiler in COMPILERS.items():
            with self.subTest(platform), tempfile.TemporaryDirectory() as folder:
                source = os.path.join(folder, "careless.cpp")
                library = os.path.join(folder, LIBRARIES[platform])
                with open(source, "w", encoding="utf-8") as file:
                    file.write(CARELESS_SOURCE)
                subprocess.run([*compiler, "-g", "-shared", source, "-o", library], check=True)
                faults = find_faults(platform, library)
                self.assertIn("exports forgotten", faults)
                self.assertIn("has debug information", faults)
                self.assertTrue([fault for fault in faults if fault.startswith("needs libstdc++")], faults)

    def test_a_library_of_another_processor_is_noticed(self):
        self.assertIn("is for arm64", find_faults("linux.x86_64", get_library("linux.arm64")))


class Package(unittest.TestCase):
    def test_the_extension_lists_one_library_for_each_platform(self):
        config = configparser.ConfigParser()
        config.read(os.path.join(ADDON, "gnomon.gdextension"))
        listed = {name: path.strip('"') for name, path in config["libraries"].items()}
        self.assertEqual(listed, {name: "res://addons/gnomon/bin/" + file for name, file in LIBRARIES.items()})
        self.assertEqual(dict(config["configuration"]), {
            "entry_symbol": '"%s"' % ENTRY, "compatibility_minimum": '"4.5"', "reloadable": "false"})  # fmt: skip

    def test_the_zip_has_what_the_extension_lists_with_licence_and_notices(self):
        with zipfile.ZipFile(ZIP) as archive:
            names = set(archive.namelist())
            for platform, file in LIBRARIES.items():
                with self.subTest(platform), open(get_library(platform), "rb") as library:
                    self.assertEqual(archive.read("addons/gnomon/bin/" + file), library.read())
        expected = {"addons/gnomon/" + name for name in (
            "LICENSE", "README.md", "THIRD_PARTY_NOTICES.md", "gnomon.gdextension", "plugin.cfg", "plugin.gd")}  # fmt: skip
        self.assertLessEqual(expected, names)
        self.assertTrue(all(name.startswith("addons/gnomon/") for name in names))
        self.assertFalse([name for name in names if name.endswith(".debug")])

    def test_every_file_that_the_extension_or_the_plugin_names_is_in_the_zip(self):
        with zipfile.ZipFile(ZIP) as archive:
            names = archive.namelist()
            extension = archive.read("addons/gnomon/gnomon.gdextension").decode()
            plugin = archive.read("addons/gnomon/plugin.cfg").decode()
        named = re.findall(r'"res://([^"]+)"', extension)
        named += ["addons/gnomon/" + name for name in re.findall(r'^script="(.+)"$', plugin, re.MULTILINE)]
        self.assertEqual(len(named), len(LIBRARIES) + 2)  # the icon and the plugin's script
        self.assertEqual([name for name in named if name not in names], [])
        self.assertEqual(len(set(names)), len(names))

    def test_the_zip_has_the_licence_with_year_and_holder_and_a_notice_of_each_project_whose_code_it_contains(self):
        with zipfile.ZipFile(ZIP) as archive:
            licence = archive.read("addons/gnomon/LICENSE").decode()
            notices = archive.read("addons/gnomon/THIRD_PARTY_NOTICES.md").decode()
        self.assertEqual(licence, read("LICENSE"))
        self.assertRegex(licence, r"(?m)^Copyright \(c\) 20\d\d \S")
        headers = re.search(r"(?m)^HEADERS = \((.*)\)$", read("modules", "platform_builders.py")).group(1)
        self.assertEqual(sorted(re.findall(r'"(.+?)"', headers)), sorted(NOTICES))
        self.assertEqual([name for name in NOTICES.values() if name not in notices], [])

    def test_the_page_for_the_store_states_the_versions_of_the_zip(self):
        page = read("doc", "godot_store.md")
        stated = dict(re.findall(r"(?m)^\| (.+?) \| (.+?) \|$", page))
        with zipfile.ZipFile(ZIP) as archive:
            plugin = archive.read("addons/gnomon/plugin.cfg").decode()
            extension = archive.read("addons/gnomon/gnomon.gdextension").decode()
        self.assertIn('version="%s"' % stated["Version"], plugin)
        self.assertIn('compatibility_minimum = "%s"' % stated["Minimum Godot version"], extension)
        self.assertIn("### Changelog of %s\n" % stated["Version"], page)

    def test_every_script_and_shader_in_the_zip_has_an_identifier_of_its_own(self):
        with zipfile.ZipFile(ZIP) as archive:
            names = [name for name in archive.namelist() if name.endswith((".gd", ".gdextension", ".gdshaderinc"))]
            identifiers = [archive.read(name + ".uid").decode().strip() for name in names]
        self.assertGreater(len(names), 3)
        self.assertTrue(all(identifier.startswith("uid://") for identifier in identifiers), identifiers)
        self.assertEqual(len(set(identifiers)), len(names))


if __name__ == "__main__":
    unittest.main()
