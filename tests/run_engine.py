#!/usr/bin/env python3
"""Runs the engine's tests in several processes at once, each with a slice of them in a shuffled order. There are more slices
than processes, so that no process idles long while the last slice runs.

    run_engine.py PROGRAM [--processes N] [-- TEST_OPTION...]

A program for Windows (NAME.exe) runs under Wine; each message of the validation layers is one failure there.
The shuffled order is the same in every run. No test may depend on another. The last line is the sum of all slices: "N passed,
N failed, N skipped"; a slice that ends without its own such line counts as one failure.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

SLICES_PER_PROCESS = 6
COUNT = re.compile(r"passing the current filters: (\d+)")
VALIDATION_MESSAGE = re.compile(r"^(?:VUID|SYNC-HAZARD)-.*", re.MULTILINE)
SUMMARY = re.compile(r"(?m)^(\d+) passed, (\d+) failed, (\d+) skipped$")
ORDER = ("--order-by=rand", "--rand-seed=1")


def prepare(program):
    """Return the command that starts the program, and its environment (None: this one)."""
    if not program.endswith(".exe"):
        return [program], None
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "platforms"))
    import platforms

    return platforms.prepare("windows.x86_64", [os.path.abspath(program)], graphics=platforms.VALIDATION)


def count_tests(start, environment, options):
    result = subprocess.run([*start, "--count", *options], env=environment, capture_output=True, text=True, check=False)
    found = COUNT.search(result.stdout)
    if not found:
        raise SystemExit("ERROR: %s --count ended with %d and printed no number of tests: %s" % (start[-1], result.returncode, result.stdout + result.stderr))
    return int(found.group(1))


def split(count, parts):
    """Return the first and last test of each slice, from 1; empty slices are skipped."""
    bounds = [count * part // parts for part in range(parts + 1)]
    return [(low + 1, high) for low, high in zip(bounds, bounds[1:]) if high > low]


def run_slice(start, environment, options, first, last):
    """Return (exit code, output)."""
    command = [*start, *ORDER, "--first=%d" % first, "--last=%d" % last, *options]
    with tempfile.TemporaryFile("w+", errors="replace") as log:
        code = subprocess.run(command, env=environment, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
        log.seek(0)
        return code, log.read()


def add_up(outputs, counts_messages=False):
    """Return [passed, failed, skipped] of all slices. outputs: (exit code, output) of each slice. counts_messages: whether messages of
    the validation layers are failures that the program does not count itself."""
    totals = [0, 0, 0]
    for code, output in outputs:
        found = SUMMARY.findall(output)
        counts = [int(number) for number in found[-1]] if found else [0, 1, 0]
        if not found or (code != 0 and counts[1] == 0):
            print("FAILED: a slice ended with %d%s" % (code, "" if found else " and without its summary"))
            counts[1] = max(counts[1], 1)
        for message in VALIDATION_MESSAGE.findall(output) if counts_messages else ():
            print("FAILED: the validation layers report", message)
            counts[1] += 1
        totals = [total + number for total, number in zip(totals, counts)]
    return totals


def main():
    parser = argparse.ArgumentParser(description="Runs the engine's tests in several processes.")
    parser.add_argument("program")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    parser.add_argument("options", nargs="*", help="options for the program, after --")
    arguments = parser.parse_args()
    if arguments.processes < 1:
        parser.error("--processes is %d, must be at least 1" % arguments.processes)
    start, environment = prepare(arguments.program)
    slices = split(count_tests(start, environment, arguments.options), SLICES_PER_PROCESS * arguments.processes)
    outputs = []
    with ThreadPoolExecutor(arguments.processes) as pool:
        for code, output in pool.map(lambda bounds: run_slice(start, environment, arguments.options, *bounds), slices):
            # Only the final sum may look like a summary line.
            print(SUMMARY.sub(r"slice: \g<0>", output), flush=True)
            outputs.append((code, output))
    passed, failed, skipped = add_up(outputs, counts_messages=environment is not None)
    print("%d passed, %d failed, %d skipped" % (passed, failed, skipped))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
