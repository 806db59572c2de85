#!/usr/bin/env python3
"""Replays the committed corpus of every fuzz target.

    replay_corpus.py SUFFIX        of bin/replay_<target>.SUFFIX, as scons names it: release_address_undefined

A target that is not built is skipped with a message. A target without a corpus fails. The last line is
"N passed, N failed, N skipped" and counts inputs; a skipped target, or one that fails as a whole, counts as one.
"""

import os
import re
import subprocess
import sys

import fuzz_targets


def main():
    if len(sys.argv) != 2:
        print("ERROR: usage: replay_corpus.py SUFFIX", file=sys.stderr)
        return 2
    totals = [0, 0, 0]  # passed, failed, skipped
    for target in fuzz_targets.find_targets():
        program = os.path.join(fuzz_targets.ROOT, "bin", "replay_%s.%s" % (target.name, sys.argv[1]))
        if not os.path.isfile(program):
            print("%s: %s is not built" % (target.name, os.path.relpath(program, fuzz_targets.ROOT)))
            totals[2] += 1
            continue
        if not os.path.isdir(target.corpus):
            print("FAILED: %s: there is no corpus %s" % (target.name, target.corpus))
            totals[1] += 1
            continue
        result = subprocess.run([program, target.corpus], stdout=subprocess.PIPE, text=True, check=False)
        lines = result.stdout.splitlines() or [""]
        counts = re.fullmatch(r"(\d+) passed, (\d+) failed, (\d+) skipped", lines[-1])
        for line in lines if not counts else lines[:-1]:
            print(line)
        print("%s: %s" % (target.name, lines[-1] if counts else "ended with %d" % result.returncode))
        if not counts or (result.returncode != 0) != (counts.group(2) != "0"):
            print("FAILED: %s ended with %d" % (os.path.basename(program), result.returncode))
            totals[1] += 1
        if counts:
            totals = [total + int(count) for total, count in zip(totals, counts.groups())]
    print("%d passed, %d failed, %d skipped" % tuple(totals))
    return 1 if totals[1] or not totals[0] else 0


if __name__ == "__main__":
    sys.exit(main())
