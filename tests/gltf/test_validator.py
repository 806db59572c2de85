"""Khronos's gltf-validator finds no new errors in files that Gnomon reads and saves, and none in its generated scenes."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "stability"))
sys.path.insert(0, os.path.join(ROOT, "demo_project", "scenes"))
from make_large_meshes import fetch_packages  # noqa: E402
import make_foliage_scenes  # noqa: E402
import make_scenes  # noqa: E402
from gltf_writer import save_files  # noqa: E402

TESTS = os.path.join(ROOT, "bin", "gnomon_tests")
# name: (version, SHA-256)
PACKAGE = {"gltf-validator": ("2.0.0-dev.3.10", "4e03dbdc3bc0d1342afd5d2d7ae341a7e3474502ccb872b02dbbaddaee0fdec6")}
MIN_FILE_COUNT = 30  # samples that are saved; 36 with assimp-testmodels 5.2.5
# Prints {path: [[code, pointer], ...]} of the errors of each file that is named.
SCRIPT = """
const fs = require("fs"), path = require("path"), validator = require("./gltf-validator");
(async () => {
    const found = {};
    for (const file of process.argv.slice(2)) {
        const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
            uri: path.basename(file),
            maxIssues: 0,
            externalResourceFunction: uri => new Promise((resolve, reject) => {
                const side_file = path.resolve(path.dirname(file), decodeURIComponent(uri));
                fs.readFile(side_file, (error, data) => error ? reject(error.toString()) : resolve(new Uint8Array(data)));
            }),
        }).catch(error => ({issues: {messages: [{code: "UNREADABLE", severity: 0, pointer: String(error)}]}}));
        found[file] = report.issues.messages.filter(issue => issue.severity === 0).map(issue => [issue.code, issue.pointer]);
    }
    console.log(JSON.stringify(found));
})();
"""


class Validator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = cls.holder.name
        fetch_packages(cls.folder, PACKAGE)
        with open(os.path.join(cls.folder, "validate.js"), "w", encoding="utf-8") as file:
            file.write(SCRIPT)

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    def validate(self, paths):
        result = subprocess.run(["node", "validate.js", *paths], cwd=self.folder, capture_output=True, text=True, check=False, timeout=600)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_saved_samples_have_no_new_errors(self):
        saved = os.path.join(self.folder, "saved")
        os.makedirs(saved)
        arguments = ["--test-case=*each file of assimp-testmodels loads and saves*"]
        environment = {**os.environ, "GNOMON_SAVED_FOLDER": saved}
        result = subprocess.run([TESTS, *arguments], env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout)
        pairs = {}  # saved file -> the file that it was read from, whose path is in the .txt next to it
        for name in os.listdir(saved):
            if name.endswith(".txt"):
                with open(os.path.join(saved, name), encoding="utf-8") as file:
                    pairs[os.path.join(saved, name[:-4] + ".glb")] = file.read()
        self.assertGreaterEqual(len(pairs), MIN_FILE_COUNT)
        found = self.validate(sorted({*pairs, *pairs.values()}))
        for written, source in pairs.items():
            with self.subTest(source):
                codes = [code for code, _pointer in found[source]]
                for code, pointer in found[written]:
                    self.assertIn(code, codes, "%s is new at %s" % (code, pointer))
                self.assertLessEqual(len(found[written]), len(found[source]))

    def test_generated_scenes_are_valid(self):
        save_files(make_scenes.build_all_files(), self.folder)
        for name in make_foliage_scenes.SCENES:
            save_files(make_foliage_scenes.build_scene_files(name, count=20), self.folder)  # leaves of a tree
        paths = [os.path.join(self.folder, name) for name in sorted(os.listdir(self.folder)) if name.endswith(".gltf")]
        self.assertGreater(len(paths), 10)
        for path, issues in self.validate(paths).items():
            with self.subTest(os.path.basename(path)):
                self.assertEqual(issues, [])


if __name__ == "__main__":
    unittest.main()
