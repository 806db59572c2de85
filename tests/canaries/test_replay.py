#!/usr/bin/env python3
"""Runs the replay of fuzz inputs (tests/fuzz/replay.cpp) on replay_failures.cpp, which fails in
another way for each input. It is a failure if the replay misses one or reports a good input.

    test_replay.py SUFFIX        of bin/canary_replay.SUFFIX, as scons names it: release_address_undefined

The last line is "N passed, N failed, N skipped".
"""

import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FAILURES = ("overflow", "undefined", "exception", "assertion", "leak", "slow", "large")
GOOD = ("documented", "fine")  # unknown words, which are refused with the documented Error


def main():
    if len(sys.argv) != 2:
        print("ERROR: usage: test_replay.py SUFFIX", file=sys.stderr)
        return 2
    program = os.path.join(ROOT, "bin", "canary_replay." + sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        for word in FAILURES + GOOD:
            with open(os.path.join(folder, word), "w", encoding="utf-8") as file:
                file.write(word)
        command = [program, "--limit-s", "2", folder]
        result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
        reported = [line for line in result.stdout.splitlines() if line.startswith("FAILED: ")]
        failed = 0
        for word in FAILURES + GOOD:
            is_reported = any(line.startswith("FAILED: %s: " % os.path.join(folder, word)) for line in reported)
            if is_reported != (word in FAILURES):
                failed += 1
                print("FAILED: the replay %s %s" % ("reports" if is_reported else "does not report", word))
        summary = "%d passed, %d failed, 0 skipped" % (len(GOOD), len(FAILURES))
        if result.returncode != 1 or result.stdout.splitlines()[-1:] != [summary]:
            failed += 1
            found = (result.returncode, result.stdout.splitlines()[-1:])
            print("FAILED: (exit code, last line) is %s, must be %s" % (found, (1, [summary])))
        empty = os.path.join(folder, "empty")
        os.mkdir(empty)
        if subprocess.run([program, empty], capture_output=True, check=False, timeout=120).returncode != 2:
            failed += 1
            print("FAILED: the replay takes an empty corpus for a good one")
    count = len(FAILURES) + len(GOOD) + 2  # the words, the summary and the empty corpus
    print("%d passed, %d failed, 0 skipped" % (count - failed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
