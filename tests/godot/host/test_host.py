"""The add-on's library does the same on every platform: bin/godot_host.* loads it, uses it, and prints what it saw.

`scons addon_zip=yes bin/gnomon_godot_addon.zip platform_programs` builds the libraries and the hosts.
"""

import difflib
import os
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.path.insert(0, os.path.join(ROOT, "tests", "platforms"))
import platforms  # noqa: E402

NATIVE = "linux.x86_64"


def run_host(platform, library=None, results=()):
    """Return (exit code, output, stderr) of the host that loads the library; None: the add-on's.

    results: "Class.method=text", what Godot's methods return.
    """
    program = platforms.get_program("godot_host", platform)
    code, output, errors = platforms.run(platform, [program, library or platforms.get_library(platform), *results])
    return code, output.decode(), errors.decode(errors="replace")


class Host(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = {platform: run_host(platform) for platform in platforms.LIBRARIES}

    def test_the_library_is_loaded_used_and_unloaded(self):
        for platform, (code, output, errors) in self.results.items():
            with self.subTest(platform):
                self.assertEqual((code, errors), (0, ""), output[-2000:])
                for line in ("entry: succeeded", "initialize: 2", "initialize: 3", "class: GnomonShadow3D, a Node3D",
                             "class: GnomonServer, a Object", "deinitialize: 2", "unregistered: GnomonShadow3D",
                             "unloaded: 0 objects and 0 values are left"):  # fmt: skip
                    self.assertIn(line, output.splitlines())
                self.assertNotIn("unknown function", output)

    def test_every_property_is_set_and_refuses_values_out_of_range(self):
        _, output, _ = self.results[NATIVE]
        lines = output.splitlines()
        properties = [line for line in lines if line.startswith("property: ")]
        values = [line for line in lines if line.startswith("value: ")]
        self.assertEqual(len(values), len(properties))
        for line in values:
            given, found = line.split(", is set to ")[1].split(", is ")
            self.assertEqual(given, found.split(", usage ")[0])
            self.assertNotIn("was %s, is set" % given, line)
        ranges = [line for line in properties if ", hint 1 " in line]
        choices = [line for line in properties if ", hint 2 " in line]
        refused = [line for line in lines if line.startswith("error: ") and "must be" in line]
        self.assertEqual(len(refused), 2 * len(ranges) + len(choices) + 1)  # 1: that of the thread
        self.assertTrue(all("gnömon" in line or "is 1" in line or "is -1" in line for line in refused), refused)

    def test_all_platforms_print_the_same(self):
        expected = self.results[NATIVE][1].splitlines()
        self.assertGreater(len(expected), 100)
        for platform, (_, output, _) in self.results.items():
            lines = difflib.unified_diff(expected, output.splitlines(), NATIVE, platform, lineterm="")
            self.assertEqual("\n".join(lines), "")

    def test_a_driver_that_the_addon_was_never_run_with_is_named_once(self):
        for driver, setting in (("d3d12", "driver.windows"), ("metal", "driver.macos")):
            results = ("RenderingServer.get_current_rendering_method=forward_plus",
                       "RenderingServer.get_current_rendering_driver_name=" + driver)  # fmt: skip
            for platform in platforms.LIBRARIES:
                with self.subTest(platform, driver=driver):
                    code, output, errors = run_host(platform, results=results)
                    self.assertEqual((code, errors), (0, ""), output[-2000:])
                    lines = [line for line in output.splitlines() if "Godot's own shadows" in line]
                    self.assertEqual(len(lines), 1, output)
                    self.assertIn("Godot draws with %s" % driver, lines[0])
                    self.assertIn("rendering/rendering_device/%s to vulkan" % setting, lines[0])
                    self.assertIn("rendering/gnomon/other_drivers", lines[0])

    def test_a_library_that_is_missing_or_has_no_entry_is_an_error(self):
        for platform in platforms.LIBRARIES:
            with self.subTest(platform):
                code, output, errors = run_host(platform, os.path.join(platforms.ROOT, "bin", "missing"))
                self.assertEqual((code, output), (1, ""))
                self.assertIn("ERROR: ", errors)


if __name__ == "__main__":
    unittest.main()
