#!/usr/bin/env python3
"""Runs a scripted session of the editor (tests/command_line/editor_story.py) under Xvfb, and writes its screenshots to
doc/images/editor*.png. Build first: scons.

Afterwards compare the screenshots with doc/editor.md, which shows them.
"""

import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "tests", "command_line"))
import editor_story  # noqa: E402
from editor_case import EditorCase  # noqa: E402

WINDOW = "1280x720+0+0"  # size and position of the editor's window in pixels
COLORS = 256  # so that a screenshot stays small in the repository


class Photographer(EditorCase):
    validation_arguments = ()  # Vulkan validation would distort the frame times in the screenshots

    def runTest(self):
        editor_story.run_story(self, self.take)

    def take(self, name):
        path = os.path.join(ROOT, "doc", "images", name + ".png")
        # `import` is ImageMagick's program for screenshots.
        command = ["import", "-silent", "-window", "root", "-crop", WINDOW, "+repage", "+dither", "-colors", str(COLORS)]
        subprocess.run([*command, "PNG8:" + path], env={**os.environ, "DISPLAY": self.display}, check=True)
        print("%s: %d bytes" % (os.path.relpath(path, ROOT), os.path.getsize(path)))


if __name__ == "__main__":
    import unittest

    unittest.main(argv=[sys.argv[0], "Photographer"])
