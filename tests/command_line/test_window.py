"""`gnomon run` in a real window under Xvfb: frames, keys, resize, validation."""

import os
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from command_line_case import THREE_LIGHTS, read_png_size, run  # noqa: E402
from display_case import TIMEOUT_S, DisplayTest  # noqa: E402

FRAMES = "12"
WINDOW_NAME = "Gnomon"


TEXT_RECT = "200x100+60+60"  # rectangle that the text covers, in ImageMagick's notation
CLEAR_RECT = "200x260+500+0"  # right of the text


class WindowTest(DisplayTest):
    def inputs(self):
        return super().inputs() + ("window.png", "headless.png", "shown.png")

    def crop(self, name, rectangle):
        """Return a rectangle of a screenshot as raw bytes."""
        command = ["convert", self.path(name), "-crop", rectangle, "+repage", "-depth", "8", "rgb:-"]
        return subprocess.run(command, capture_output=True, check=True).stdout

    def draw_headless(self, size):
        result = run("run", THREE_LIGHTS, "--headless", *size, "--capture", self.path("headless.png"))
        self.assertEqual(result.returncode, 0, result.stderr)

    def is_as_headless(self, name, rectangle):
        shown, drawn = self.crop(name, rectangle), self.crop("headless.png", rectangle)
        self.assertEqual(len(shown), len(drawn))
        self.assertGreater(len(set(drawn)), 30)  # it is not a uniform area
        # The window's camera is stored as angles, so pixels on edges may differ slightly.
        return sum(abs(a - b) > 8 for a, b in zip(shown, drawn)) < len(drawn) // 100

    def test_the_last_frame_of_a_window_is_what_a_headless_run_draws(self):
        size = ("--size", "700x260")
        self.finish(self.start("run", THREE_LIGHTS, *size, "--frames", FRAMES, "--capture", self.path("window.png"), "--validation"))
        self.assertEqual(read_png_size(self.path("window.png")), (700, 260))
        self.draw_headless(size)
        self.assertTrue(self.is_as_headless("window.png", CLEAR_RECT))
        self.assertFalse(self.is_as_headless("window.png", TEXT_RECT), "the text is missing")

    def test_the_window_shows_what_a_headless_run_draws_once_its_text_is_off(self):
        size = ("--size", "700x260")
        self.draw_headless(size)
        process = self.start("run", THREE_LIGHTS, *size, "--validation")
        self.press("search", "--sync", "--name", WINDOW_NAME, "windowmove", "0", "0", "key", "F1")
        environment = {**os.environ, "DISPLAY": self.display}
        end = time.monotonic() + TIMEOUT_S
        is_alike = False
        while not is_alike:
            self.assertLess(time.monotonic(), end, "the window does not show the image without text")
            self.assertIsNone(process.poll(), "the window ended")
            subprocess.run(["import", "-silent", "-window", "root", self.path("shown.png")], env=environment, check=True)
            is_alike = self.is_as_headless("shown.png", TEXT_RECT)
        self.assertTrue(self.is_as_headless("shown.png", CLEAR_RECT))
        self.press("search", "--name", WINDOW_NAME, "key", "Escape")
        self.finish(process)

    def test_a_window_that_is_closed_still_writes_its_files(self):
        process = self.start("run", THREE_LIGHTS, "--size", "320x240", "--capture", self.path("closed.png"), "--dot", self.path("closed.dot"))
        self.press("search", "--sync", "--name", WINDOW_NAME, "key", "Escape")
        self.finish(process)
        self.assertEqual(read_png_size(self.path("closed.png")), (320, 240))
        with open(self.path("closed.dot"), encoding="utf-8") as file:
            self.assertIn("digraph", file.read())

    def test_keys_and_resizing_do_not_end_the_window_and_escape_does(self):
        process = self.start("run", THREE_LIGHTS, "--size", "320x240", "--validation")
        self.press("search", "--sync", "--name", WINDOW_NAME)
        for key in ("t", "t", "v", "plus", "minus", "w", "F1", "F1"):
            self.press("search", "--name", WINDOW_NAME, "key", key)
            time.sleep(0.2)
        self.press("search", "--name", WINDOW_NAME, "windowsize", "500", "380")
        time.sleep(1.0)
        self.press("search", "--name", WINDOW_NAME, "windowsize", "200", "150")
        time.sleep(1.0)
        self.assertIsNone(process.poll(), "the window ended")
        self.press("search", "--name", WINDOW_NAME, "key", "Escape")
        self.finish(process)


if __name__ == "__main__":
    unittest.main()
