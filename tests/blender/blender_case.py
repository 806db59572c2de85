"""Base class and functions of the tests with Blender: run Blender and the add-on, and read the files they write.

The program is `blender`, or $BLENDER.
"""

import hashlib
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "command_line"))
from command_line_case import LIGHTS, ROOT, run  # noqa: E402

BLENDER = shutil.which(os.environ.get("BLENDER", "blender"))
ADDON = os.path.join(ROOT, "demo_project", "blender", "gnomon_shadows.py")
INSIDE = os.path.join(HERE, "inside_blender.py")
TIMEOUT_S = 120
SIZE = ("--size", "64x64")


def run_blender(folder, *arguments, **environment):
    """Run Blender and return the finished process. Its configuration is below `folder`. It needs no display."""
    # Debian's Blender loads libraries such as numpy from the first python3 in PATH, which must not be pyenv's or a venv's.
    path = os.pathsep.join(("/usr/bin", os.environ.get("PATH", "")))
    variables = {**os.environ, "HOME": folder, "TMPDIR": folder, "PATH": path, **environment}
    for name in ("CONFIG", "SCRIPTS", "DATAFILES"):
        variables["BLENDER_USER_" + name] = os.path.join(folder, "user", name.lower())
        os.makedirs(variables["BLENDER_USER_" + name], exist_ok=True)
    if "DISPLAY" not in environment:
        variables.pop("DISPLAY", None)
    command = [BLENDER, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, env=variables, check=False)


def load_gltf(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] == b"glTF":  # a GLB file: 12 bytes of header, then length, type and data of the JSON chunk
        length = struct.unpack("<I", data[12:16])[0]
        data = data[20 : 20 + length]
    return json.loads(data)


def find_lights(scene):
    """Return node name -> (extras of the node, light). If a name occurs twice, the last node counts."""
    found = {}
    for node in scene["nodes"]:
        index = node.get("extensions", {}).get(LIGHTS, {}).get("light")
        if index is not None:
            found[node["name"]] = (node.get("extras", {}), scene["extensions"][LIGHTS]["lights"][index])
    return found


@unittest.skipUnless(BLENDER, "Blender is not installed")
class BlenderTest(unittest.TestCase):
    """All tests of a class share a folder, so that Blender, which is slow, writes each scene only once."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def call(cls, command, name, *, mode=("-b",), environment=None, **arguments):
        """Run a command of inside_blender.py. Return (path it wrote, finished process)."""
        out = cls.path(name)
        options = (*mode, "--factory-startup", "--python-exit-code", "1", "-P", INSIDE)
        result = run_blender(cls.folder, *options, "--", command, out, json.dumps(arguments), **(environment or {}))
        if result.returncode != 0 or not os.path.exists(out):
            raise AssertionError("%s ended with %d: %s" % (command, result.returncode, result.stdout + result.stderr))
        return out, result

    @classmethod
    def call_for_json(cls, command, name, **arguments):
        with open(cls.call(command, name, **arguments)[0], encoding="utf-8") as file:
            return json.load(file)

    @classmethod
    def build(cls, name, **arguments):
        """Save a scene of inside_blender.py as a .blend file and return its path. arguments: those of save_blend()."""
        return cls.call("save_blend", name, **arguments)[0]

    @classmethod
    def export(cls, blend, name, *options):
        """Run the add-on's export command, as doc/blender.md describes it."""
        return run_blender(cls.folder, "-b", blend, "-P", ADDON, "--", "--export", cls.path(name), *options)

    @classmethod
    def make(cls, name, **arguments):
        """Build a scene, export it, and return the file's path."""
        blend = cls.build(name + ".blend", **arguments)
        result = cls.export(blend, name)
        if result.returncode != 0:
            raise AssertionError(result.stdout + result.stderr)
        return cls.path(name)

    def run_gnomon(self, command, scene, *arguments):
        """Run the program and return the SHA-256 of the file that it wrote. The same command writes the same bytes."""
        out = self.path("out.exr" if command == "visibility" else "out.png")
        option = "--out" if command == "visibility" else "--capture"
        more = () if command == "visibility" else ("--headless",)
        result = run(command, scene, option, out, *SIZE, *more, *arguments, DISPLAY=None)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("ERROR", result.stderr)
        with open(out, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()

    def hash_mask(self, scene, technique, light, *settings):
        """Compute a light's mask and return the SHA-256 of its file."""
        pairs = [word for setting in settings for word in ("--set", setting)]
        return self.run_gnomon("visibility", scene, "--technique", technique, "--light", light, *pairs)
