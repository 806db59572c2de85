"""The command line of scripts that make random scenes from a seed."""

import argparse
import os
import random

from gltf_writer import save_files

FOLDER = os.path.dirname(os.path.abspath(__file__))
DEFAULT_SEED = 1


class SeededScenes:
    """The scenes that one script can make. scenes: name -> (function of a random generator and a count, default count).

    counted: what the count is the number of, for the help. max_count: the largest allowed count.
    """

    def __init__(self, scenes, counted, max_count):
        self.scenes = scenes
        self.counted = counted
        self.max_count = max_count

    def build(self, name, seed=DEFAULT_SEED, count=None):
        """Return the scene as a gltf_writer.Document."""
        build, default_count = self.scenes[name]
        return build(random.Random(seed), default_count if count is None else count)

    def build_files(self, name, seed=DEFAULT_SEED, count=None):
        """Return file name -> bytes."""
        return self.build(name, seed, count).build_files(name)

    def run(self, description):
        """Write the scenes that the command line selects. description: of the script, for --help."""
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("--scenes", default=",".join(self.scenes), help="comma-separated (default: %(default)s)")
        parser.add_argument("--seed", type=int, default=DEFAULT_SEED, help="of the random numbers (default: %(default)s)")
        parser.add_argument("--count", type=int, help="%s, 1..%d (default: the scene's)" % (self.counted, self.max_count))
        parser.add_argument("--out", default=FOLDER, help="folder to write to (default: next to this file)")
        arguments = parser.parse_args()
        names = [name for name in arguments.scenes.split(",") if name]
        unknown = [name for name in names if name not in self.scenes]
        if unknown or not names:
            parser.error("--scenes is %r, must be of: %s" % (arguments.scenes, ", ".join(self.scenes)))
        if arguments.count is not None and not 1 <= arguments.count <= self.max_count:
            parser.error("--count is %d, must be 1..%d" % (arguments.count, self.max_count))
        for name in names:
            save_files(self.build_files(name, arguments.seed, arguments.count), arguments.out)
            print(os.path.join(arguments.out, name + ".gltf"))
