#!/usr/bin/env python3
"""Runs programs with one deliberate error each; it is a failure if the sanitizer does not report the error.

    test_canaries.py SANITIZERS        as given to scons: address,undefined or thread

The programs are built by `scons sanitize=SANITIZERS canaries`, with the flags of the engine.
"""

import glob
import os
import subprocess
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))
REPORTS = {"address": "AddressSanitizer", "undefined": "runtime error", "thread": "ThreadSanitizer"}


def main():
    if len(sys.argv) != 2 or not set(sys.argv[1].split(",")) <= set(REPORTS):
        print("ERROR: usage: test_canaries.py address,undefined | thread", file=sys.stderr)
        return 2
    sanitizers = sys.argv[1].split(",")
    passed = failed = 0
    for sanitizer in sanitizers:
        sources = glob.glob(os.path.join(FOLDER, sanitizer + "_*.cpp"))
        if not sources:
            failed += 1
            print("FAILED: sanitizer %s has no canary. Add tests/canaries/%s_NAME.cpp" % (sanitizer, sanitizer))
        for source in sorted(sources):
            name = os.path.splitext(os.path.basename(source))[0]
            program = os.path.join(ROOT, "bin", "canary_%s.release_%s" % (name, "_".join(sanitizers)))
            if not os.path.isfile(program):
                failed += 1
                print("FAILED: %s is not built. Run scons sanitize=%s canaries" % (program, sys.argv[1]))
                continue
            result = subprocess.run([program], capture_output=True, text=True, check=False, timeout=120)
            if result.returncode != 0 and REPORTS[sanitizer] in result.stderr:
                passed += 1
            else:
                failed += 1
                code = result.returncode
                print("FAILED: sanitizer %s did not report %s, which ended with %d" % (sanitizer, name, code))
    print("%d passed, %d failed, 0 skipped" % (passed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
