#!/usr/bin/env python3
"""Runs the tests of tests/godot/addon, GDScript, inside $GODOT with the add-on of demo_project/godot.

Arguments are names of tests. Warnings and errors that Godot logs fail the run, except those that tests expect. Last line:
N passed, N failed, N skipped.
"""

import re
import sys

import addon_project
import godot_project

# Messages that tests cause: (text that they contain, how often they are logged).
EXPECTED = (
    ("technique is no such technique, must be", 1),
    ("rendering/gnomon/default_technique is nothing, must be", 1),
    ("rendering/gnomon/mask_resolution_scale is ", 2),
    ("penumbra_outer_width is -5, must be", 1),
    ("penumbra_outer_width is nan, must be", 1),
    ("has an orthogonal projection", 1),
    ('RIDs of type "Texture" were leaked', 1),  # a leak of Godot itself, for each reflection probe that was drawn
    ("is cut out by alpha", 1),
    ("in view are no nodes", 1),
    ("is an empty RID", 2),
    ("is no mesh with triangles", 1),
    ("the transform has the value nan", 1),
    ("layers is 0, must be", 1),
    ("is no caster. Add it", 2),
    ("that cover more of the view have it", 1),
    ("moves its vertices in vertex() by", 5),
    ("moves its vertices in a way that is not read", 1),
    ("is transparent or drawn without depth", 1),
    ("the vertices of a SoftBody3D", 1),
    ("is drawn as points", 1),
    ("has a rim", 1),
    ("has toon shading", 1),
    ("Shader compilation failed", 1),
    ("has a shader that does not compile", 1),
    ("has a clear coat", 1),
    ("is anisotropic", 1),
    ("is lit from behind", 1),
    ("has subsurface scattering", 1),
    ("is lit at its vertices", 1),
    ("has a shader with a light() of its own", 1),
)


def find_unexpected(output, is_whole):
    """Return unexpected messages, and expected ones that were logged more or, in a whole run, less often than expected."""
    unexpected = []
    counts = dict.fromkeys((text for text, _count in EXPECTED), 0)
    for line in godot_project.find_messages(output):
        matching = [text for text in counts if text in line]
        for text in matching:
            counts[text] += 1
        if not matching:
            unexpected.append("Godot logged " + line)
    for text, count in EXPECTED:
        if counts[text] > count or (is_whole and counts[text] < count):
            unexpected.append('"%s" was logged %d times, %d are expected' % (text, counts[text], count))
    return unexpected


def main():
    addon_project.write()
    output = godot_project.run("res://tests/suite.tscn", sys.argv[1:], 200, addon_project.FOLDER)
    print(output)
    passed = re.findall(r"^PASS (\w+)$", output, re.MULTILINE)
    failures = re.findall(r"^FAIL (.*)$", output, re.MULTILINE)
    failures += find_unexpected(output, len(sys.argv) == 1)
    return addon_project.report(passed, failures)


if __name__ == "__main__":
    sys.exit(main())
