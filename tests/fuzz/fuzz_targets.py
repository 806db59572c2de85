"""Where fuzz targets and their corpora are."""

import glob
import os
from collections import namedtuple

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ENDING = "_fuzz.cpp"
# dictionary: words for libFuzzer, or None.
Target = namedtuple("Target", "name corpus dictionary")


def find_targets():
    """All targets of the tree, whether built or not; the corpus is next to the source."""
    found = []
    for pattern in ("tests/fuzz/*", "modules/*/tests/*"):
        for path in sorted(glob.glob(os.path.join(ROOT, pattern + ENDING))):
            folder, file = os.path.split(path)
            name = file[: -len(ENDING)]
            words = os.path.join(folder, name + ".dict")
            found.append(Target(name, os.path.join(folder, "corpus", name), words if os.path.isfile(words) else None))
    return found
