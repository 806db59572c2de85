"""The commands of doc/add_a_technique.md make a technique that works, in a copy of the tree."""

import filecmp
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGE = os.path.join(ROOT, "doc", "add_a_technique.md")
SCENE = os.path.join("demo_project", "scenes", "sphere.gltf")
TIMEOUT_S = 600

for name in ("layers", "removal"):
    sys.path.insert(0, os.path.join(ROOT, "tests", name))
import test_layers  # noqa: E402
import test_removal  # noqa: E402


def find_commands(text):
    """Return the page's ```sh blocks, in order, as one script."""
    return "\n".join(re.findall(r"(?ms)^```sh\n(.*?)^```$", text))


def find_copy(commands):
    """Return (module that the page copies, module that it makes, id of the new technique)."""
    old_module, new_module, new_id = re.search(r"cp -r modules/(\w+) modules/(shadow_(\w+))", commands).groups()
    return old_module, new_module, new_id


class AddATechniqueTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(PAGE, encoding="utf-8") as file:
            cls.commands = find_commands(file.read())
        cls.module, cls.new_module, cls.new_id = find_copy(cls.commands)
        techniques = test_layers.Tree(ROOT).find_techniques()
        if cls.module not in techniques:
            raise unittest.SkipTest("modules/%s was deleted" % cls.module)
        (cls.old_id,) = techniques[cls.module][0]
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.target = cls.folder.name
        test_removal.copy_tree(cls.target)
        result = cls.run_in_copy("bash", "-euc", cls.commands)
        if result.returncode != 0:
            raise AssertionError("the page's commands ended with %d:\n%s" % (result.returncode, result.stdout[-4000:]))
        cls.output = result.stdout

    @classmethod
    def run_in_copy(cls, *command):
        return subprocess.run(
            command,
            cwd=cls.target,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=TIMEOUT_S,
            check=False,
        )

    def load_technique(self, technique_id):
        listed = json.loads(self.run_in_copy("bin/gnomon", "techniques", "--json").stdout)
        return next(item for item in listed if item["id"] == technique_id)

    def save_mask(self, technique_id, name, *settings):
        """Compute a mask. Return (its path, finished process)."""
        file_name = os.path.join("build", name)
        options = [word for setting in settings for word in ("--set", setting)]
        command = ("bin/gnomon", "visibility", SCENE, "--technique", technique_id, "--out", file_name)
        result = self.run_in_copy(*command, "--size", "64x64", *options)
        return os.path.join(self.target, file_name), result

    def test_the_commands_list_the_new_technique(self):
        self.assertRegex(self.output, r"(?m)^%s$" % self.new_id)

    def test_its_properties_are_those_of_the_template_under_its_own_name(self):
        old, new = self.load_technique(self.old_id), self.load_technique(self.new_id)
        renamed = [{**item, "name": item["name"].replace(self.old_id, self.new_id, 1)} for item in old["properties"]]
        self.assertEqual(new["properties"], renamed)
        self.assertGreater(len(renamed), 0)

    def test_its_mask_equals_the_template_s_byte_for_byte(self):
        # The page's commands computed both masks.
        paths = [os.path.join(self.target, "build", name + ".exr") for name in (self.old_id, self.new_id)]
        self.assertTrue(filecmp.cmp(*paths, shallow=False))

    def test_its_properties_can_be_set_and_are_checked(self):
        plain, _ = self.save_mask(self.new_id, "plain.exr")
        changed, _ = self.save_mask(self.new_id, "changed.exr", self.new_id + "_strength=0.5")
        expected, _ = self.save_mask(self.old_id, "expected.exr", self.old_id + "_strength=0.5")
        self.assertFalse(filecmp.cmp(plain, changed, shallow=False))
        self.assertTrue(filecmp.cmp(expected, changed, shallow=False))
        # The maximum is 1.
        _, refused = self.save_mask(self.new_id, "refused.exr", self.new_id + "_strength=2")
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn(self.new_id + "_strength", refused.stdout)

    def test_no_name_of_the_template_is_left_in_it(self):
        (old_class,) = test_layers.Tree(self.target).find_techniques()[self.module][1]
        left = re.compile(r"%s|%s|%s" % (old_class, self.module, self.module.upper()))
        for folder in ("modules/" + self.new_module, "shaders/" + self.new_module):
            for name in os.listdir(os.path.join(self.target, folder)):
                path = os.path.join(self.target, folder, name)
                if os.path.isfile(path):
                    self.assertNotIn(self.module, name)
                    with open(path, encoding="utf-8") as file:
                        self.assertIsNone(left.search(file.read()), path)

    def test_the_rules_on_layers_and_names_hold(self):
        result = self.run_in_copy(sys.executable, "tests/layers/test_layers.py")
        self.assertEqual(result.returncode, 0, result.stdout)


class CanaryTest(unittest.TestCase):
    def test_only_sh_blocks_are_commands(self):
        page = "a\n```sh\none\n```\n    two\n```cpp\nthree\n```\n```sh\nfour\n```\n"
        self.assertEqual(find_commands(page).split(), ["one", "four"])

    def test_a_failing_command_stops_the_script(self):
        result = subprocess.run(["bash", "-euc", "false\ntrue"], check=False)
        self.assertNotEqual(result.returncode, 0)
