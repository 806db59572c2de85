"""The editor's main workflow: open a scene, choose a soft shadow for a light, drag its size, compare it with the reference,
save, run the game. test_editor.py tests it, and doc/make_editor_images.py takes screenshots of it.
"""

import os
import signal
import time

from command_line_case import find_technique
from editor_case import LIGHT, load
from display_case import TIMEOUT_S

REFERENCE_RAYS = 256  # per pixel, enough for a meaningful error
MAX_SOFT_MAE = 0.02  # penumbra MAE of the default technique


def make_hard(case):
    """Save the scene with a hard shadow for its light, with which the workflow starts."""
    scene = load(case.scene)
    case.find_light(scene)["extras"]["shadow_technique"] = find_technique("is_fallback")
    case.save(scene)


def find_game(scene):
    """Return the id of the process that runs the scene, or None."""
    for name in os.listdir("/proc"):
        try:
            with open("/proc/%s/cmdline" % name, "rb") as file:
                words = file.read().split(b"\0")
        except OSError:
            continue
        # The shell that starts the game has the same words.
        if b"run" in words and scene.encode() in words and not words[0].endswith(b"sh"):
            return int(name)
    return None


def wait_until(condition):
    """Wait for a condition, for at most TIMEOUT_S; the caller checks whether it holds."""
    end = time.monotonic() + TIMEOUT_S
    while not condition() and time.monotonic() < end:
        time.sleep(0.05)


def run_story(case, take_screenshot):
    """Run the workflow. case: an EditorCase. take_screenshot(name) is called at each state that the documentation shows."""
    make_hard(case)
    size = case.find_light(load(case.scene))["extras"]["light_size"]
    case.open_editor()
    case.select_light()
    case.click("penumbra")  # no lines over the shadow
    hard = case.capture_viewport()
    take_screenshot("editor_hard")

    technique = find_technique("is_default")
    case.choose("property shadow_technique", technique)
    case.wait_for(lambda state: state["is_changed"])
    soft = case.capture_viewport()
    case.assertGreater(case.compute_changed_fraction(hard, soft), 0.005)
    case.drag("property light_size", 3)
    case.assertGreater(case.compute_changed_fraction(soft, case.capture_viewport()), 0.002)
    plain = case.capture_viewport()
    case.click("penumbra")
    case.assertGreater(case.compute_changed_fraction(plain, case.capture_viewport()), 0.002)
    take_screenshot("editor")

    case.click("penumbra")
    case.click("tab Error")
    error = case.wait_for(lambda state: state["error"]["rays"] >= REFERENCE_RAYS)["error"]
    case.assertEqual(error["light"], LIGHT)
    case.assertLess(error["penumbra_mae"], MAX_SOFT_MAE)
    case.choose("against", find_technique("is_fallback"))
    # The line is between the images of the two techniques.
    case.wait_for(lambda state: "line" in state["items"])
    case.rest()
    take_screenshot("editor_error")
    case.choose("against", "one technique")

    case.press("key", "ctrl+s")
    case.wait_for(lambda state: not state["is_changed"] and state["status"].startswith("Saved"))
    extras = case.find_light(load(case.scene))["extras"]
    case.assertEqual(extras["shadow_technique"], technique)
    case.assertGreater(extras["light_size"], size)

    case.press("key", "F5")
    wait_until(lambda: find_game(case.scene) is not None)
    game = find_game(case.scene)
    case.assertIsNotNone(game, "the game did not start")
    case.press("search", "--sync", "--pid", str(game))  # waits for its window
    time.sleep(3.0)  # it draws frames
    take_screenshot("editor_game")
    case.assertEqual(find_game(case.scene), game, "the game ended by itself")
    os.kill(game, signal.SIGTERM)
    wait_until(lambda: find_game(case.scene) is None)
    case.focus(case.process)
    case.finish()
