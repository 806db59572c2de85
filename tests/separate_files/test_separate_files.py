#!/usr/bin/env python3
"""Does every source file compile by itself? `scons` compiles several as one, which hides a missing #include.

    test_separate_files.py [--processes N]

Reads compile_commands.json, which `scons` writes, and checks the syntax of each of its files. The last line is "N passed, N failed,
N skipped", a count of files.
"""

import argparse
import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def check(entry):
    """Return what the compiler prints, or "" if it accepts the file."""
    arguments = shlex.split(entry["command"])
    output = arguments.index("-o")
    arguments[output : output + 2] = ["-fsyntax-only"]
    done = subprocess.run(arguments, cwd=entry["directory"], capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stderr or "ended with %d" % done.returncode


def main():
    parser = argparse.ArgumentParser(description="Checks that every source file compiles by itself.")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()
    with open(os.path.join(ROOT, "compile_commands.json"), encoding="utf-8") as file:
        entries = [entry for entry in json.load(file) if not entry["file"].endswith(".gen.cpp")]
    failed = 0
    with ThreadPoolExecutor(arguments.processes) as pool:
        for entry, messages in zip(entries, pool.map(check, entries)):
            if messages:
                failed += 1
                print("FAILED: %s\n%s" % (entry["file"], messages))
    print("%d passed, %d failed, 0 skipped" % (len(entries) - failed, failed))
    return 1 if failed or not entries else 0


if __name__ == "__main__":
    sys.exit(main())
