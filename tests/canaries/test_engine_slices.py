"""Tests of run_engine.py: every test is in exactly one slice, and failures in any slice are reported."""

import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

import run_engine  # noqa: E402


class SliceTest(unittest.TestCase):
    def test_every_test_is_in_one_slice(self):
        for count in (1, 2, 7, 579):  # fewer tests than slices, and many more
            for parts in (1, 2, 3, 8):
                with self.subTest(count=count, parts=parts):
                    numbers = [n for first, last in run_engine.split(count, parts) for n in range(first, last + 1)]
                    self.assertEqual(numbers, list(range(1, count + 1)))

    def test_failures_crashes_and_bad_exit_codes_are_added_up(self):
        # (exit code, output) of each slice; the sum is [passed, failed, skipped].
        good = (0, "text\n3 passed, 0 failed, 1 skipped\n")
        self.assertEqual(run_engine.add_up([good, good]), [6, 0, 2])
        self.assertEqual(run_engine.add_up([good, (1, "1 passed, 2 failed, 0 skipped\n")]), [4, 2, 1])
        self.assertEqual(run_engine.add_up([good, (-11, "half a line")]), [3, 1, 1])
        self.assertEqual(run_engine.add_up([good, (3, "2 passed, 0 failed, 0 skipped\n")]), [5, 1, 1])

    def test_messages_of_the_validation_layers_count_as_failures(self):
        output = "text\n3 passed, 0 failed, 0 skipped\n"
        message = "SYNC-HAZARD-WRITE-AFTER-WRITE(ERROR / SPEC): msgNum: 1\n"
        self.assertEqual(run_engine.add_up([(0, message + output)]), [3, 0, 0])  # the program itself counts them
        self.assertEqual(run_engine.add_up([(0, output), (0, message + output)], counts_messages=True), [6, 1, 0])

    def test_a_program_that_prints_no_number_of_tests_is_refused(self):
        with tempfile.NamedTemporaryFile("w", suffix=".sh", delete=False) as script:
            script.write("#!/bin/sh\necho nothing\n")
        os.chmod(script.name, 0o755)
        try:
            with self.assertRaises(SystemExit):
                run_engine.count_tests([script.name], None, [])
        finally:
            os.remove(script.name)


if __name__ == "__main__":
    unittest.main()
