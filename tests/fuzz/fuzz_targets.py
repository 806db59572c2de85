"""Finds the fuzz targets and their corpora."""

import glob
import os
from collections import namedtuple

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ENDING = "_fuzz.cpp"
# dictionary: path of libFuzzer's dictionary, or None.
Target = namedtuple("Target", "name corpus dictionary")


def find_targets():
    """Return all targets of the tree, whether built or not. Their corpus is next to the source."""
    found = []
    for pattern in ("tests/fuzz/*", "modules/*/tests/*"):
        for path in sorted(glob.glob(os.path.join(ROOT, pattern + ENDING))):
            folder, file = os.path.split(path)
            name = file[: -len(ENDING)]
            dictionary_path = os.path.join(folder, name + ".dict")
            found.append(Target(name, os.path.join(folder, "corpus", name), dictionary_path if os.path.isfile(dictionary_path) else None))
    return found
