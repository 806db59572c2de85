"""Base class and functions of the command-line tests: run the program, and make scenes to modify.

The program is bin/gnomon, or $GNOMON. Technique ids come from the program itself.
"""

import copy
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GNOMON = os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon"))
SCENES = os.path.join(ROOT, "demo_project", "scenes")
CONTACT_BOX = os.path.join(SCENES, "contact_box.gltf")
THREE_LIGHTS = os.path.join(SCENES, "three_lights.gltf")
TIMEOUT_S = 180
SMALL = ("--size", "32x32")
LIGHTS = "KHR_lights_punctual"


def full_run_only(test):
    """Decorator of a test or test class that only tests/run_tests.sh --full runs, which sets GNOMON_KILL_COUNT. Other runs do not
    have the test at all, so that it does not count as skipped."""
    return test if "GNOMON_KILL_COUNT" in os.environ else None


def run(*arguments, **environment):
    """Run the program and return the finished process. environment: variables to set, or to remove if None."""
    variables = {**os.environ, **environment}
    variables = {name: value for name, value in variables.items() if value is not None}
    command = [GNOMON, *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, env=variables, check=False)
    if "Incomplete result: " in result.stderr:  # log_fault of modules/core/log.h
        raise AssertionError("%s: %s" % (" ".join(command), result.stderr))
    return result


def load_json(*arguments):
    result = run(*arguments)
    if result.returncode != 0:
        raise AssertionError("%s ended with %d: %s" % (" ".join(map(str, arguments)), result.returncode, result.stderr))
    return json.loads(result.stdout)


def find_technique(flag):
    """Return the id of the technique that has the flag in `techniques --json`: is_default, is_fallback or is_reference."""
    return next(item["id"] for item in load_json("techniques", "--json") if item[flag])


def list_matrix_only():
    """Return the arguments with which a report measures only its matrix: each option for the extent of another part, and "none"."""
    options = re.findall(r"(--\w+) TEXT:{none,quick,full}", run("report", "--help").stdout)
    return [word for option in options for word in (option, "none")]


def read_png_size(path):
    with open(path, "rb") as file:
        data = file.read(24)
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", data[16:24])


class CommandLineTest(unittest.TestCase):
    """Each test has its own folder, and a scene (self.scene) that it may modify and write."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        with open(CONTACT_BOX, encoding="utf-8") as file:
            self.scene = json.load(file)
        shutil.copy(os.path.join(SCENES, "contact_box.bin"), self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data if isinstance(data, bytes) else data.encode("utf-8"))
        return self.path(name)

    def write_scene(self, scene, *replacements):
        """Write the scene as changed.gltf and return its path. For each (old, new) the first old in its text is replaced."""
        text = json.dumps(scene, indent="\t")
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        return self.write("changed.gltf", text)

    def build_glb(self):
        scene = copy.deepcopy(self.scene)
        del scene["buffers"][0]["uri"]
        text = json.dumps(scene).encode("utf-8")
        text += b" " * (-len(text) % 4)
        with open(self.path("contact_box.bin"), "rb") as file:
            binary = file.read()
        # 0x4E4F534A and 0x004E4942: the chunk types "JSON" and "BIN".
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def find_node(self, name):
        return next(node for node in self.scene["nodes"] if node["name"] == name)

    def get_light(self):
        return self.scene["extensions"][LIGHTS]["lights"][0]

    def compute_mask(self, scene, *arguments, **environment):
        """Run `visibility` with a small size and the fallback technique. Return the finished process. The output is mask.exr."""
        return run("visibility", scene, "--technique", self.get_fallback(), "--out", self.path("mask.exr"), *SMALL, *arguments, **environment)

    fallback = None  # queried once for all tests

    def get_fallback(self):
        if CommandLineTest.fallback is None:
            CommandLineTest.fallback = find_technique("is_fallback")
        return CommandLineTest.fallback

    def assert_refused(self, result, *words, code=1, has_outputs=False):
        """Assert the exit code, exactly one ERROR line that contains all the words, and that the
        folder has only files of inputs(), unless the test itself wrote others (has_outputs).
        code: 1: bad input or a failed device, 2: wrong usage.
        """
        lines = result.stderr.splitlines()
        errors = [line for line in lines if line.startswith("ERROR: ")]
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(len(errors), 1, result.stderr)
        for word in words:
            self.assertIn(str(word), errors[0])
        left = [] if has_outputs else [name for name in os.listdir(self.folder) if name not in self.inputs()]
        self.assertEqual(left, [], "left behind")

    def inputs(self):
        """Return the names of files that a test itself may write into its folder."""
        return ("changed.gltf", "contact_box.bin", "broken.gltf", "broken.glb", "notes.txt")

    def assert_mask(self, result, name="mask.exr"):
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path(name), "rb") as file:
            self.assertEqual(file.read(4), b"\x76\x2f\x31\x01", "not an OpenEXR file")
