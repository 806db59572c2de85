"""Tests the portable bundle, unpacked in root folders that have only a shell with a few tools and the C library; one has a Vulkan driver.

Needs the right to chroot (root). The bundle is made with references of two scenes at 64 x 64.
"""

import json
import os
import shutil
import subprocess
import tarfile
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon"))
TOOLS = ("sh", "dirname", "mkdir", "cat", "rm", "getconf")
DRIVER_FOLDER = "/usr/share/vulkan/icd.d"
MAX_MIB = 60  # as in make_bundle.sh


def list_libraries(path):
    """Return the libraries that a program or library needs, the loader included."""
    lines = subprocess.run(["ldd", path], capture_output=True, text=True, check=True).stdout.splitlines()
    words = [word for line in lines for word in line.split() if word.startswith("/")]
    return sorted(set(words))


def copy_into(root, path):
    target = root + path
    if not os.path.exists(target):
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copy(os.path.realpath(path), target)


def make_root(root, has_driver):
    """Make a root folder with the shell's tools and, if has_driver, Mesa's software driver."""
    files = []
    for tool in TOOLS:
        path = shutil.which(tool)
        files += [path, *list_libraries(path)]
    # Parts of the C library that the program needs; the bundle does not contain the C library.
    files += [path for path in list_libraries(PROGRAM) if "/libm." in path or "/libdl." in path or "/libpthread." in path]
    if has_driver:
        for name in os.listdir(DRIVER_FOLDER):
            if not name.startswith("lvp"):
                continue
            manifest = os.path.join(DRIVER_FOLDER, name)
            with open(manifest, encoding="utf-8") as file:
                driver = json.load(file)["ICD"]["library_path"]
            if not driver.startswith("/"):
                found = subprocess.run(["ldconfig", "-p"], capture_output=True, text=True, check=True).stdout.splitlines()
                driver = next(line.split()[-1] for line in found if line.split() and line.split()[0] == driver)
            files += [manifest, driver, *list_libraries(driver)]
    for name in ("bin", "lib", "lib64"):  # symbolic links into /usr, as in Debian
        os.makedirs(os.path.join(root, "usr", name))
        os.symlink("usr/" + name, os.path.join(root, name))
    for path in files:
        copy_into(root, path)
    for name in ("proc", "tmp", "dev"):
        os.makedirs(os.path.join(root, name), exist_ok=True)


@unittest.skipUnless(os.geteuid() == 0, "chroot needs root")
class BundleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.archive = os.path.join(cls.folder.name, "bundle.tar.xz")
        subprocess.run(
            [os.path.join(ROOT, "tests", "benchmark", "make_bundle.sh"), "--quick", "--program", PROGRAM, "--out", cls.archive],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        cls.roots = {}
        for name, has_driver in (("driver", True), ("bare", False)):
            root = os.path.join(cls.folder.name, name)
            make_root(root, has_driver)
            with tarfile.open(cls.archive) as archive:
                archive.extractall(root)
            cls.roots[name] = root

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_in(self, root, *command):
        script = 'cd /gnomon-linux-x86_64 && exec "$@"'
        words = ["/usr/sbin/chroot", self.roots[root], shutil.which("sh"), "-c", script, "sh", *command]
        environment = {"PATH": "/usr/bin:/bin", "HOME": "/tmp"}
        return subprocess.run(words, capture_output=True, text=True, env=environment, timeout=600, check=False)

    def test_it_is_small_and_has_licences(self):
        self.assertLess(os.path.getsize(self.archive), MAX_MIB << 20)
        licences = os.listdir(os.path.join(self.roots["bare"], "gnomon-linux-x86_64", "licences"))
        for library in ("libembree3", "libstdc++6", "libvulkan1"):
            self.assertTrue(any(name.startswith(library) for name in licences), (library, licences))
        self.assertIn("gnomon.txt", licences)

    def test_it_measures_the_same_errors_as_the_packed_program(self):
        result = self.run_in("driver", "./measure.sh", "--scenes", "sphere,contact_box", "--size", "64x64", "--out", "/tmp/out")
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(os.path.join(self.roots["driver"], "tmp/out/results.json"), encoding="utf-8") as file:
            report = json.load(file)["report"]
        own = os.path.join(self.folder.name, "own")
        subprocess.run(
            [PROGRAM, "report", os.path.join(ROOT, "demo_project"), "--scenes", "sphere,contact_box", "--sizes", "own", "--settings", "default",
             "--size", "64x64", "--scaling", "none", "--change", "none", "--stability", "none", "--frames", "1", "--out", own],
            capture_output=True, check=True,
        )  # fmt: skip
        with open(os.path.join(own, "report.json"), encoding="utf-8") as file:
            expected = json.load(file)
        self.assertGreater(len(expected["cells"]), 10)
        self.assertEqual([cell["error"] for cell in report["cells"]], [cell["error"] for cell in expected["cells"]])

    def test_without_a_driver_it_ends_with_one_clear_line(self):
        result = self.run_in("bare", "./gnomon", "info")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn("Vulkan", result.stderr)

    def test_on_another_c_library_it_ends_with_one_clear_line(self):
        program = os.path.join(self.roots["bare"], "gnomon-linux-x86_64", "bin", "gnomon")
        os.rename(program, program + ".real")
        try:
            with open(program, "w", encoding="utf-8") as file:
                file.write("#!/bin/sh\necho \"version GLIBC_2.36 not found\" >&2\nexit 1\n")
            os.chmod(program, 0o755)
            result = self.run_in("bare", "./gnomon", "info")
        finally:
            os.rename(program + ".real", program)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn("glibc 2.36", result.stderr)

    def test_a_wrong_option_ends_with_2(self):
        self.assertEqual(self.run_in("bare", "./measure.sh", "--gone").returncode, 2)


if __name__ == "__main__":
    unittest.main()
