#!/usr/bin/env python3
"""Plays small games (tests/godot/games) inside $GODOT and compares frames of them with those of Godot's own shadows.

Arguments are names of games; none: all. Each game has checks of its images (runner.gd), and these of its run: Godot ends without an error,
logs only the expected warnings, and does not grow. Images are in build/godot_games/images. Last line: N passed, N failed, N skipped.
"""

import os
import re
import sys
import time

import addon_project
import godot_project

FOLDER = os.path.join(addon_project.ROOT, "build", "godot_games")
SOURCES = os.path.join(addon_project.ROOT, "tests", "godot", "games")
GAMES = ("platformer", "city", "third_person", "particles", "forest")
SIZE = "240x135"
IMAGE_CHECKS = 9  # in runner.gd
FRAMES = 300  # in runner.gd
MOST_MESSAGES = 3  # of one game
# Warnings that each game causes: parts of their texts.
EXPECTED = {
    "third_person": ("has a shader with a light() of its own",),
    "particles": ("is transparent or drawn without depth", "the mesh of a GPUParticles3D", "the mesh of a CPUParticles3D"),
}
COUNTS = ("objects", "nodes", "orphan nodes", "resources", "bytes of static memory", "bytes of textures", "bytes of buffers")
# Largest growth of each count from frame 100 to the last, in which a leak would happen 200 times. Physics and scripts hold a few objects more
# or less. Meshes in view and lists of edges are others in other frames, and freed memory of the device stays in pools. The comparison just
# before the last frame holds memory for some 60 frames (112 KiB of static memory); 900 more frames without one have equal counts.
ALLOWED_GROWTH = (4, 0, 0, 0, 256 << 10, 1 << 20, 1 << 20)


def find_unexpected(game, output):
    """Return a text for each message in the log that the game does not cause by its content, and one if there are too many."""
    messages = godot_project.find_messages(output)
    expected = EXPECTED.get(game, ())
    failures = ["Godot logged " + line for line in messages if not any(text in line for text in expected)]
    if len(messages) > MOST_MESSAGES:
        failures.append("%d messages were logged, more than %d" % (len(messages), MOST_MESSAGES))
    return failures


def find_growth(output):
    """Return a text for each count that is higher at the end than after the first 100 frames."""
    reports = [tuple(map(int, line.split()[1:])) for line in re.findall(r"^GROWTH .*$", output, re.MULTILINE)]
    if not reports or reports[-1][0] != FRAMES:
        return ["there are no counts of frame %d" % FRAMES]
    (first_frame, *first), (last_frame, *last) = reports[0], reports[-1]
    grown = []
    for index, name in enumerate(COUNTS):
        if last[index] > first[index] + ALLOWED_GROWTH[index]:
            grown.append("%d %s after %d frames, %d after %d" % (first[index], name, first_frame, last[index], last_frame))
    return grown


def play(game):
    """Return (names of passed checks, texts of failed ones)."""
    images = os.path.join(FOLDER, "images")
    start = time.monotonic()
    arguments = ["--path", FOLDER] + godot_project.DEVICE_OPTIONS
    arguments += ["--disable-vsync", "--fixed-fps", "30", "--resolution", SIZE, "res://tests/games.tscn", "--", game, images]
    code, output = godot_project.start_godot(arguments)
    print(output)
    print("%s: %.0f s" % (game, time.monotonic() - start))
    passed = re.findall(r"^PASS (\w+)$", output, re.MULTILINE)
    failures = re.findall(r"^FAIL (.*)$", output, re.MULTILINE)
    results = {
        "ends": ["Godot ended with %d" % code] * int(code != 0),
        "plays": ["%d of %d checks of images have a result" % (len(passed + failures), IMAGE_CHECKS)] * int(len(passed + failures) != IMAGE_CHECKS),
        "log": find_unexpected(game, output),
        "growth": find_growth(output),
    }
    passed += [name for name, texts in results.items() if not texts]
    failures += ["%s: %s" % (name, text) for name, texts in results.items() for text in texts]
    return passed, ["%s, %s" % (game, text) for text in failures]


def main():
    games = sys.argv[1:] or GAMES
    unknown = [game for game in games if game not in GAMES]
    if unknown:
        raise SystemExit("ERROR: no game is named %s. Games: %s." % (", ".join(unknown), ", ".join(GAMES)))
    addon_project.write(FOLDER, SOURCES)
    os.makedirs(os.path.join(FOLDER, "images"))
    open(os.path.join(FOLDER, "images", ".gdignore"), "w").close()  # keeps Godot from importing them
    all_passed, all_failures = [], []
    for game in games:
        passed, failures = play(game)
        all_passed += passed
        all_failures += failures
    return addon_project.report(all_passed, all_failures)


if __name__ == "__main__":
    sys.exit(main())
