#!/usr/bin/env python3
"""Runs the fuzz targets that `scons fuzz=yes` has built.

    run_fuzz.py [--seconds N] [--jobs N] [--limit-s N] [TARGET]...

Each target runs for N seconds (default: $FUZZ_SECONDS, else 600), as many at once as there are jobs (default: one per
core). An input may take as long as the limit (default: 10 s; set more if other programs use the cores). New
inputs are stored in build/fuzz/<target>/corpus, with which the next run continues, and findings (crash-*, leak-*,
timeout-*, oom-*) in build/fuzz/<target>/findings, next to the log. A target passes when it ran and has no new finding.
The last line is "N passed, N failed, N skipped".
"""

import argparse
import concurrent.futures
import os
import subprocess
import sys

import fuzz_targets

MAX_INPUT_BYTES = 1 << 16
LIMIT_S = 10  # of one input, unless --limit-s is given
MEMORY_MIB = 2048
GRACE_S = 120  # a target that runs so much longer than its time is killed


def run_target(target, seconds, limit_s):
    """Return (has passed, what to print)."""
    program = os.path.join(fuzz_targets.ROOT, "bin", "fuzz_" + target.name)
    if not os.path.isfile(program):
        return False, "FAILED: %s: bin/fuzz_%s is not built. Run: scons fuzz=yes" % (target.name, target.name)
    folder = os.path.join(fuzz_targets.ROOT, "build", "fuzz", target.name)
    learned, findings = os.path.join(folder, "corpus"), os.path.join(folder, "findings")
    os.makedirs(learned, exist_ok=True)
    os.makedirs(findings, exist_ok=True)
    before = set(os.listdir(findings))
    command = [program, learned, target.corpus, "-max_total_time=%d" % seconds, "-max_len=%d" % MAX_INPUT_BYTES]
    command += ["-timeout=%d" % limit_s, "-report_slow_units=%d" % limit_s]
    command += ["-rss_limit_mb=%d" % MEMORY_MIB, "-malloc_limit_mb=%d" % (MEMORY_MIB // 2)]
    command += ["-artifact_prefix=%s/" % findings, "-print_final_stats=1"]
    if target.dictionary:
        command.append("-dict=" + target.dictionary)
    log = os.path.join(folder, "log.txt")
    with open(log, "wb") as output:
        try:
            status = subprocess.run(
                command, stdout=output, stderr=subprocess.STDOUT, check=False, timeout=seconds + GRACE_S
            ).returncode
        except subprocess.TimeoutExpired:
            status = "a timeout after %d s" % (seconds + GRACE_S)
    with open(log, encoding="utf-8", errors="replace") as file:
        lines = file.read().splitlines()
    runs = [line.split()[-1] for line in lines if line.startswith("stat::number_of_executed_units")]
    covered = [line.split("cov: ")[1].split()[0] for line in lines if " cov: " in line]
    new = sorted(set(os.listdir(findings)) - before)
    summary = "%s: %s runs, %s edges" % (target.name, runs[-1] if runs else "?", covered[-1] if covered else "?")
    if status == 0 and not new and runs and runs[-1] != "0":
        return True, summary
    summary += "\nFAILED: %s ended with %s; log: %s" % (target.name, status, log)
    return False, summary + "".join("\n    finding: %s" % os.path.join(findings, name) for name in new)


def main():
    parser = argparse.ArgumentParser(description="Runs the fuzz targets.")
    parser.add_argument("--seconds", type=int, default=int(os.environ.get("FUZZ_SECONDS", "600")))
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--limit-s", type=int, default=LIMIT_S)
    parser.add_argument("targets", nargs="*", metavar="TARGET")
    arguments = parser.parse_args()
    targets = fuzz_targets.find_targets()
    unknown = sorted(set(arguments.targets) - {target.name for target in targets})
    if unknown:
        names = ", ".join(target.name for target in targets)
        parser.error("there is no target %s; targets: %s" % (", ".join(unknown), names))
    if min(arguments.seconds, arguments.jobs, arguments.limit_s) < 1:
        numbers = (arguments.seconds, arguments.jobs, arguments.limit_s)
        parser.error("--seconds is %d, --jobs %d, --limit-s %d; each must be at least 1" % numbers)
    requested = [target for target in targets if not arguments.targets or target.name in arguments.targets]
    passed = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        runs = pool.map(lambda target: run_target(target, arguments.seconds, arguments.limit_s), requested)
        for has_passed, summary in runs:
            passed += has_passed
            print(summary, flush=True)
    print("%d passed, %d failed, 0 skipped" % (passed, len(requested) - passed))
    return 0 if passed == len(requested) else 1


if __name__ == "__main__":
    sys.exit(main())
