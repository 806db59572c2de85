"""The program for Windows under Wine, next to the same program on Linux: masks, reports, paths and messages.

Both draw with the same driver of Linux (llvmpipe), so their masks should be equal. Build first: scons; scons platform=windows
godot=no bin/gnomon.exe. GNOMON_ALL_MASKS=yes compares masks of every technique, light and scene of MASK_SCENES; otherwise those of the first scene.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)), os.path.join(ROOT, "tests", "benchmark")]
import platforms  # noqa: E402
from library_file import LibraryFile  # noqa: E402
from mask_file import load_mask  # noqa: E402

SCENES = os.path.join(ROOT, "demo_project", "scenes")
MASK_SCENES = ("three_lights", "leaf", "kitbash")  # each with a spot light, an omni light and a sun of these names
LIGHTS = ("Spot", "Omni", "Sun")
SIZE = "128x128"
ODD_NAME = "gnömon ❤ 한국"
# The reference may differ by one of its 1024 rays, in one pixel of 1,000: Embree is built for SSE2 there, which rounds products.
REFERENCE_STEP = 1 / 1024
REFERENCE_SHARE = 0.001
REPORT_OPTIONS = ("--size", "64x64", "--samples", "256", "--scaling", "none", "--stability", "none", "--change", "none")
REPORT_OPTIONS += ("--settings", "default", "--frames", "1")


class ProgramCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def run_on(self, platform, *arguments, **environment):
        """Return (exit code, output, stderr) of the program for a platform. Each has a cache of its own."""
        environment.setdefault("GNOMON_CACHE_DIR", self.path("cache " + platform))
        code, output, errors = platforms.run(platform, [platforms.get_main_program(platform), *arguments], graphics=environment)
        return code, output.decode().replace("\r\n", "\n"), errors.decode(errors="replace").replace("\r\n", "\n")

    def run_well(self, platform, *arguments, **environment):
        """Return the output. Fails if the program does."""
        code, output, errors = self.run_on(platform, *arguments, **environment)
        self.assertEqual(code, 0, errors)
        return output

    def draw_mask(self, platform, technique, light, scene):
        path = self.path(platform + ".exr")
        self.run_well(platform, "visibility", os.path.join(SCENES, scene + ".gltf"), "--technique", technique, "--light", light, "--size", SIZE, "--out", path)
        return load_mask(path)

    def list_techniques(self):
        """Return all techniques as the program lists them. Both programs must list the same, with the same properties."""
        listed = [json.loads(self.run_well(platform, "techniques", "--json")) for platform in platforms.PROGRAMS]
        self.assertEqual(listed[0], listed[1])
        return listed[0]


class Masks(ProgramCase):
    def test_masks_equal_those_of_linux(self):
        scenes = MASK_SCENES if os.environ.get("GNOMON_ALL_MASKS") == "yes" else MASK_SCENES[:1]
        for technique in self.list_techniques():
            for scene in scenes:
                for light in LIGHTS:
                    with self.subTest(technique=technique["id"], scene=scene, light=light):
                        masks = [self.draw_mask(platform, technique["id"], light, scene) for platform in platforms.PROGRAMS]
                        self.assertEqual(masks[0].receiver, masks[1].receiver)
                        steps = [abs(a - b) for a, b in zip(masks[0].visibility, masks[1].visibility) if a != b]
                        self.assertLessEqual(max(steps, default=0), REFERENCE_STEP if technique["is_reference"] else 0)
                        self.assertLessEqual(len(steps), REFERENCE_SHARE * len(masks[0].visibility))


class Reports(ProgramCase):
    def test_errors_equal_those_of_linux(self):
        """`report` of two scenes: the same cells, with errors that are equal to four digits."""
        errors = []
        for platform in platforms.PROGRAMS:
            out = self.path("report " + platform)
            self.run_well(platform, "report", os.path.join(ROOT, "demo_project"), "--scenes", "contact_box,sphere", *REPORT_OPTIONS, "--out", out)
            with open(os.path.join(out, "report.json"), encoding="utf-8") as file:
                cells = json.load(file)["cells"]
            self.assertGreater(len(cells), 20)
            errors.append([[cell[key] for key in ("configuration", "technique", "status")] + [self.round_all(cell["error"])] for cell in cells])
            self.assertTrue(os.path.exists(os.path.join(out, "index.html")))
        self.assertEqual(errors[0], errors[1])

    def round_all(self, value):
        """Round the numbers of a report's JSON to four digits after the point."""
        if isinstance(value, dict):
            return {name: self.round_all(item) for name, item in value.items()}
        if isinstance(value, list):
            return [self.round_all(item) for item in value]
        return round(value, 4) if isinstance(value, float) else value


class Paths(ProgramCase):
    def test_paths_of_any_language_open_and_save(self):
        folder = self.path(ODD_NAME + " 1")
        os.mkdir(folder)
        for name in ("contact_box.gltf", "contact_box.bin"):
            shutil.copy(os.path.join(SCENES, name), folder)
        scene = os.path.join(folder, ODD_NAME + ".gltf")
        os.rename(os.path.join(folder, "contact_box.gltf"), scene)
        os.rename(os.path.join(folder, "contact_box.bin"), os.path.join(folder, ODD_NAME + ".bin"))
        with open(scene, encoding="utf-8") as file:
            document = json.load(file)
        document["buffers"][0]["uri"] = ODD_NAME + ".bin"
        with open(scene, "w", encoding="utf-8") as file:
            json.dump(document, file, ensure_ascii=False)
        with open(os.path.join(folder, "project.cfg"), "w", encoding="utf-8") as file:
            file.write('[project]\nname="%s"\nscenes=["%s.gltf"]\n' % (ODD_NAME, ODD_NAME))
        mask, image, report = (os.path.join(folder, ODD_NAME + ending) for ending in (".exr", ".png", " report"))
        cache = self.path(ODD_NAME + " cache")
        run = lambda *arguments: self.run_well("windows.x86_64", *arguments, GNOMON_CACHE_DIR=cache)  # noqa: E731
        run("visibility", folder, "--technique", self.list_techniques()[0]["id"], "--size", "64x64", "--out", mask)
        self.assertEqual(load_mask(mask).width, 64)
        run("run", scene, "--headless", "--size", "64x64", "--capture", image)
        with open(image, "rb") as file:
            self.assertTrue(file.read().startswith(b"\x89PNG"))
        self.assertEqual(json.loads(run("compare", mask, mask))["receiver"]["mae"], 0)
        run("report", folder, *REPORT_OPTIONS, "--out", report)
        with open(os.path.join(report, "report.json"), encoding="utf-8") as file:
            self.assertIn(ODD_NAME, json.dumps(json.load(file), ensure_ascii=False))
        self.assertTrue(os.listdir(cache))
        code, _, errors = self.run_on("windows.x86_64", "visibility", self.path(ODD_NAME + ".gltf"), "--out", mask, "--technique", "x")
        self.assertEqual(code, 1)
        self.assertIn(ODD_NAME + ".gltf", errors)
        self.assertNotIn("\\\\", errors)

    def test_a_path_of_more_than_260_letters_opens_and_saves(self):
        folder = self.path(*["a_long_folder_name_%d" % index for index in range(16)])
        self.assertGreater(len(folder), 300)
        os.makedirs(folder)
        for name in ("contact_box.gltf", "contact_box.bin"):
            shutil.copy(os.path.join(SCENES, name), folder)
        image = os.path.join(folder, "image.png")
        self.run_well("windows.x86_64", "run", os.path.join(folder, "contact_box.gltf"), "--headless", "--size", "64x64", "--capture", image)
        self.assertTrue(os.path.exists(image))

    def test_the_cache_is_in_the_user_s_local_folder(self):
        output = self.run_well("windows.x86_64", "info", GNOMON_CACHE_DIR="")
        self.assertRegex(output, r"Cache: C:\\users\\[^\\]+\\AppData\\Local\\gnomon\\cache\n")
        self.assertNotIn("CPU: unknown", output)


class Messages(ProgramCase):
    def test_needs_only_libraries_of_every_windows(self):
        """Vulkan's loader is not among them: it is loaded when it is first used."""
        program = LibraryFile(platforms.get_main_program("windows.x86_64"))
        self.assertEqual(program.imports, {"KERNEL32.dll", "ADVAPI32.dll", "msvcrt.dll"})

    def test_help_equals_that_of_linux_without_its_window(self):
        commands = json.loads(self.run_well("windows.x86_64", "modules", "--json"))
        self.assertNotIn("desktop", [item["name"] for item in commands])
        for command in ("visibility", "compare", "info"):
            helps = [self.run_well(platform, command, "--help") for platform in platforms.PROGRAMS]
            self.assertEqual(helps[0], helps[1])

    def test_bad_input_has_the_exit_code_and_the_message_of_linux(self):
        for arguments in (["visibility"], ["run", "missing.gltf", "--headless"], ["compare", "a.exr", "b.exr"]):
            with self.subTest(arguments):
                results = [self.run_on(platform, *arguments) for platform in platforms.PROGRAMS]
                self.assertNotEqual(results[0][0], 0)
                self.assertEqual(results[0], results[1])

    def test_a_system_without_vulkan_gets_a_message(self):
        code, _, errors = self.run_on("windows.x86_64", "info", WINEDLLOVERRIDES="mscoree,mshtml,vulkan-1=")
        self.assertEqual(code, 1, errors)
        self.assertIn("vulkan-1.dll", errors)
        self.assertIn("driver", errors)


class Bundle(ProgramCase):
    def test_the_packed_program_measures(self):
        """The archive of make_bundle.sh --windows, unpacked into a folder with an odd name."""
        archive = self.path("bundle.zip")
        subprocess.run([os.path.join(ROOT, "tests", "benchmark", "make_bundle.sh"), "--windows", "--out", archive], stdout=subprocess.DEVNULL, check=True)
        with zipfile.ZipFile(archive) as file:
            file.extractall(self.path(ODD_NAME))
        folder = self.path(ODD_NAME, "gnomon-windows-x86_64")
        for name in ("gnomon", "embree", "libpng1.6", "openexr"):
            self.assertGreater(os.path.getsize(os.path.join(folder, "licences", name + ".txt")), 500)
        script = "Z:" + os.path.join(folder, "measure.cmd").replace("/", "\\")
        command, environment = platforms.prepare("windows.x86_64", ["cmd", "/c", script], graphics={"SCENES": "sphere", "SIZE": "64x64"})
        environment.pop("GNOMON_CACHE_DIR", None)  # the script's own is next to it
        done = subprocess.run(command, env=environment, capture_output=True, timeout=platforms.TIMEOUT_S, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(os.path.join(folder, "results", "results.json"), encoding="utf-8") as file:
            results = json.load(file)
        self.assertIn("devices", results["info"])
        self.assertGreater(len(results["report"]["cells"]), 8)
        self.assertTrue(os.listdir(os.path.join(folder, "references")))


if __name__ == "__main__":
    unittest.main()
