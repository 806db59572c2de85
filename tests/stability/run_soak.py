#!/usr/bin/env python3
"""Runs the soak test (test_soak_posix.cpp) over thousands of frames of randomly changing scenes.

    run_soak.py PROGRAM [--frames N] [--seed N]

PROGRAM is bin/gnomon_tests. A frame that takes longer than 60 s fails the test, and the seed is printed whenever it
fails. The last line is "N passed, N failed, N skipped".
"""

import argparse
import os
import queue
import subprocess
import sys
import threading
import time

FRAME_LIMIT_S = 60
TEST = "*[Soak]*"
# The test draws every frame three times and rounds the number of frames down to a multiple of
# three, so at most two frames are missing. This limit is looser.
MAX_MISSING_TRIPLES = 10


def follow(stream, lines):
    for line in stream:
        lines.put(line.rstrip("\n"))
    lines.put(None)


def run(program, frame_count, seed):
    """Return whether the test passed. Prints the test's output except its frames and its summary."""
    environment = {**os.environ, "GNOMON_SOAK_FRAMES": str(frame_count), "GNOMON_SOAK_SEED": str(seed)}
    process = subprocess.Popen(
        [program, "--test-case=" + TEST], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )
    lines = queue.Queue()
    threading.Thread(target=follow, args=(process.stdout, lines), daemon=True).start()
    drawn_count, begin = 0, time.monotonic()
    has_run = False
    while True:
        try:
            line = lines.get(timeout=FRAME_LIMIT_S)
        except queue.Empty:
            process.kill()
            print("FAILED: frame %d of seed %d takes longer than %d s" % (drawn_count, seed, FRAME_LIMIT_S))
            return False
        if line is None:
            break
        if line.startswith("frame "):
            drawn_count += 1
        else:
            has_run |= line == "1 passed, 0 failed, 0 skipped"  # TEST selects one test case
            if not line.endswith("skipped"):
                print(line, flush=True)
    code = process.wait()
    print("%d frames of seed %d in %.0f s" % (drawn_count, seed, time.monotonic() - begin))
    if code != 0 or not has_run or drawn_count < frame_count - 3 * MAX_MISSING_TRIPLES:
        print("FAILED: the test ended with %d after %d of %d frames of seed %d" % (code, drawn_count, frame_count, seed))
        return False
    return True


def main():
    parser = argparse.ArgumentParser(description="Runs the soak test over many frames.")
    parser.add_argument("program")
    parser.add_argument("--frames", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=20100901)
    arguments = parser.parse_args()
    if arguments.frames < 2 or arguments.seed < 1:
        parser.error("--frames is %d, --seed is %d; they must be at least 2 and 1" % (arguments.frames, arguments.seed))
    passed = run(arguments.program, arguments.frames, arguments.seed)
    print("%d passed, %d failed, 0 skipped" % (passed, not passed))
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
