#!/usr/bin/env python3
"""Runs unittest files. The last line is "N passed, N failed, N skipped", as of every test script here. Before it are the longest tests.

    run_unittest.py FILE.py... [-k PATTERN]
"""

import argparse
import importlib.util
import os
import sys
import time
import unittest

LONGEST_COUNT = 8


class CountingResult(unittest.TextTestResult):
    """Prints one line per test and collects the failed tests. A test with several failed subtests counts once."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self.failed = set()
        self.times_s = []  # (seconds, name)

    def startTest(self, test):
        super().startTest(test)
        self.begin_s = time.monotonic()

    def stopTest(self, test):
        super().stopTest(test)
        self.times_s.append((time.monotonic() - self.begin_s, test.id()))

    def addFailure(self, test, error):
        super().addFailure(test, error)
        self.failed.add(test.id())

    def addError(self, test, error):
        super().addError(test, error)
        self.failed.add(test.id())

    def addSubTest(self, test, subtest, error):
        super().addSubTest(test, subtest, error)
        if error is not None:
            self.failed.add(test.id())

    def addUnexpectedSuccess(self, test):
        super().addUnexpectedSuccess(test)
        self.failed.add(test.id())


def load_file(path, pattern):
    name = os.path.splitext(os.path.basename(path))[0]
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    loader = unittest.TestLoader()
    if pattern:
        loader.testNamePatterns = ["*%s*" % pattern]
    return loader.loadTestsFromModule(module)


def main():
    parser = argparse.ArgumentParser(description="Runs unittest files.")
    parser.add_argument("files", nargs="+", metavar="FILE.py")
    parser.add_argument("-k", dest="pattern", help="only tests whose name contains this")
    arguments = parser.parse_args()
    sys.dont_write_bytecode = True
    suite = unittest.TestSuite(load_file(path, arguments.pattern) for path in arguments.files)
    sys.stdout.flush()
    result = unittest.TextTestRunner(verbosity=2, resultclass=CountingResult).run(suite)
    failed, skipped = len(result.failed), len(result.skipped)
    # Not below 0: a setUpClass that fails or skips is counted, but its tests have not run.
    passed = max(0, result.testsRun - failed - skipped)
    sys.stderr.flush()
    for seconds, name in sorted(result.times_s, reverse=True)[:LONGEST_COUNT]:
        print("%6.1f s %s" % (seconds, name))
    print("%d passed, %d failed, %d skipped" % (passed, failed, skipped), flush=True)
    return 1 if failed or result.testsRun == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
