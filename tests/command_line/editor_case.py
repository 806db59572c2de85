"""Drives `gnomon edit` as a user does, with mouse and keys under Xvfb.

The positions of widgets and the editor's state are read from the file of --items.
"""

import json
import os
import shutil
import subprocess
import time
import unittest

from command_line_case import ROOT, load_json
from display_case import TIMEOUT_S, DisplayTest

LIGHT = "Spot"
IDLE_MOUSE_PX = ("1100", "17")  # x and y in pixels: in the tool bar, where no widget reacts to the mouse
DRAG_STEPS = 12
SETTLED_FRAMES = 4  # after which a widget that opens has its size and position
CLICK_DELAY_S = "0.15"  # seconds between clicks: faster ones are double clicks


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


@unittest.skipUnless("editor" in [item["name"] for item in load_json("modules", "--json")], "this build has no editor")
class EditorCase(DisplayTest):
    def setUp(self):
        super().setUp()
        self.project = self.path("project")
        shutil.copytree(os.path.join(ROOT, "demo_project"), self.project, ignore=shutil.ignore_patterns("out", "third_party"))
        # A path. In CommandLineTest, self.scene is the content of a file.
        self.scene = os.path.join(self.project, "scenes", "three_lights.gltf")
        self.items = self.path("items.json")

    validation_arguments = ("--validation",)  # empty in subclasses that measure or show times

    def open_editor(self, *arguments, project=None, **options):
        """Start the editor and wait until it shows an image. project: a path, "" for none. options: as for start()."""
        if os.path.exists(self.items):
            os.remove(self.items)
        named = [self.project if project is None else project] if project != "" else []
        self.process = self.start("edit", *named, "--items", self.items, *self.validation_arguments, *arguments, **options)
        self.wait_for(lambda state: state["images"] >= 1)

    def get_state(self):
        """Return what the editor wrote to --items, see EditorContext::describe_items."""
        try:
            return load(self.items)
        except (OSError, ValueError):  # not written yet
            error = {"light": "", "refusal": "", "is_tracing": False, "rays": 0, "penumbra_mae": -1.0}
            return {"items": {}, "selected": "", "status": "", "is_changed": False, "is_resting": False, "frame": 0,
                    "images": 0, "answers_ms": [], "error": error}  # fmt: skip

    def wait_for(self, matches, at_most_s=TIMEOUT_S):
        """Wait for a state that matches and return it. The test fails if there is none within at_most_s seconds."""
        end = time.monotonic() + at_most_s
        while time.monotonic() < end:
            state = self.get_state()
            if matches(state):
                return state
            if self.process.poll() is not None:
                self.fail("the editor ended: %s" % self.process.communicate()[1])
            time.sleep(0.05)
        self.fail("the editor did not reach the expected state: %s" % json.dumps(self.get_state()))

    def wait_frames(self, count=2, matches=lambda state: True):
        """Wait for `count` more frames and a state that matches. Input takes effect within two frames."""
        frame = self.get_state()["frame"]
        return self.wait_for(lambda state: state["frame"] > frame + count and matches(state))

    def find_middle(self, name):
        """Wait for a widget that no longer moves and return the x and y of its middle, as text."""
        bounds, before = self.wait_for(lambda state: name in state["items"])["items"][name], None
        while bounds != before:  # a widget that opens still moves
            before, bounds = bounds, self.wait_frames(SETTLED_FRAMES, lambda state: name in state["items"])["items"][name]
        left, top, right, bottom = bounds
        return str(int((left + right) / 2)), str(int((top + bottom) / 2))

    def press_button(self, name):
        """Move the mouse to a widget and press its left button, without releasing it."""
        self.press("mousemove", *self.find_middle(name))
        self.wait_frames()  # the editor finds out a frame later what is under the mouse
        self.press("sleep", CLICK_DELAY_S, "mousedown", "1")
        self.wait_frames()

    def click(self, name):
        self.press_button(name)
        self.press("sleep", CLICK_DELAY_S, "mouseup", "1")

    def drag(self, name, step_px):
        """Drag a widget to the right, in DRAG_STEPS steps of step_px pixels."""
        self.press_button(name)
        for _ in range(DRAG_STEPS):
            self.press("mousemove_relative", "--", str(step_px), "0", "sleep", "0.02")
        self.wait_frames()
        self.press("mouseup", "1")

    def rest(self):
        """Wait until the editor is idle and shows the final image at full resolution."""
        self.wait_frames(matches=lambda state: state["is_resting"])

    def capture_viewport(self, begin=0.0, end=1.0):
        """Return the viewport between two fractions of its width as raw bytes, without hover effects."""
        self.press("mousemove", *IDLE_MOUSE_PX, "sleep", "0.1")
        self.rest()
        left, top, right, bottom = (int(value) for value in self.get_state()["items"]["viewport"])
        left, right = int(left + begin * (right - left)), int(left + end * (right - left))
        command = ["import", "-silent", "-window", "root", "-crop", "%dx%d+%d+%d" % (right - left, bottom - top, left, top)]
        environment = {**os.environ, "DISPLAY": self.display}
        return subprocess.run([*command, "+repage", "-depth", "8", "rgb:-"], env=environment, capture_output=True, check=True).stdout

    def compute_changed_fraction(self, one, other):
        """Return the fraction of the bytes of two images that differ by more than 8 of 255.

        Tests require less than 0.001 of an unchanged viewport. Their lower limits for changes
        depend on how many pixels change.
        """
        self.assertEqual(len(one), len(other))
        return sum(abs(a - b) > 8 for a, b in zip(one, other)) / len(one)

    def finish(self):
        self.press("key", "ctrl+q")
        _, errors = self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(self.process.returncode, 0, errors)
        self.assertNotIn("VUID", errors)
        self.assertNotIn("SYNC-HAZARD", errors)

    def select_light(self):
        self.click("node " + LIGHT)
        self.wait_for(lambda state: state["selected"] == LIGHT)

    def choose(self, name, choice):
        self.click(name)
        self.click("choice " + choice)

    def save(self, scene):
        """Overwrite the scene file, as another program would."""
        with open(self.scene, "w", encoding="utf-8") as file:
            json.dump(scene, file)

    def find_light(self, scene):
        lights = scene["extensions"]["KHR_lights_punctual"]["lights"]
        return next(light for light in lights if light["name"] == LIGHT)
