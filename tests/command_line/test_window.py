"""`gnomon run` in a real window under Xvfb: frames, keys, resize, validation."""

import os
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import THREE_LIGHTS, read_png_size, run  # noqa: E402
from display_case import DisplayTest  # noqa: E402

FRAMES = "12"
WINDOW_NAME = "Gnomon"


class WindowTest(DisplayTest):
    def inputs(self):
        return super().inputs() + ("window.png", "headless.png")

    def crop(self, name):
        """The part of a picture that the text does not cover, as raw bytes."""
        command = ["convert", self.path(name), "-crop", "256x100+100+150", "+repage", "-depth", "8", "rgb:-"]
        return subprocess.run(command, capture_output=True, check=True).stdout

    def test_the_window_shows_what_a_headless_run_draws(self):
        size = ("--size", "400x260")
        process = self.start("run", THREE_LIGHTS, *size, "--frames", FRAMES, "--capture", self.path("window.png"), "--validation")
        time.sleep(0.5)
        self.press("search", "--sync", "--name", WINDOW_NAME, "key", "F1")  # text off
        self.finish(process)
        self.assertEqual(read_png_size(self.path("window.png")), (400, 260))
        result = run("run", THREE_LIGHTS, "--headless", *size, "--capture", self.path("headless.png"))
        self.assertEqual(result.returncode, 0, result.stderr)
        shown, drawn = self.crop("window.png"), self.crop("headless.png")
        self.assertEqual(len(shown), len(drawn))
        # The window's camera is made of angles: pixels on edges may differ, no more.
        different = sum(abs(a - b) > 8 for a, b in zip(shown, drawn))
        self.assertLess(different, len(drawn) // 100)
        self.assertGreater(len(set(drawn)), 30)

    def test_keys_change_technique_and_view_and_escape_ends(self):
        process = self.start("run", THREE_LIGHTS, "--size", "320x240", "--validation")
        self.press("search", "--sync", "--name", WINDOW_NAME)
        for key in ("t", "t", "v", "plus", "minus", "w", "F1", "F1"):
            self.press("search", "--name", WINDOW_NAME, "key", key)
            time.sleep(0.2)
        self.press("search", "--name", WINDOW_NAME, "windowsize", "500", "380")
        time.sleep(1.0)
        self.press("search", "--name", WINDOW_NAME, "windowsize", "200", "150")
        time.sleep(1.0)
        self.assertIsNone(process.poll(), "still running")
        self.press("search", "--name", WINDOW_NAME, "key", "Escape")
        self.finish(process)


if __name__ == "__main__":
    unittest.main()
