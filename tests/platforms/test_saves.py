"""save_file_atomically on every platform: processes that end at each step of a save, and what they leave.

bin/save_steps.* saves a file and ends at the step that its argument names (`scons platform_programs`).
modules/core/tests/test_atomic_save_posix.cpp tests more, on Linux.
"""

import functools
import os
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import platforms  # noqa: E402

SIZE_MB = 2.5  # written in three chunks
STEP_COUNT = 6  # created, three chunks, synced, renamed
PREFIX = "gnömon ❤ "  # of every name that save_steps saves
ENDING = ".gnomon_part"
OLD, NEW = "a", "b"


def on_each_platform(test):
    """Run a test for each platform, in an empty folder."""

    @functools.wraps(test)
    def run(self):
        for platform in platforms.LIBRARIES:
            with self.subTest(platform), tempfile.TemporaryDirectory() as folder:
                self.folder = folder
                self.path = os.path.join(folder, PREFIX + "scene")
                test(self, platform)

    return run


class Saves(unittest.TestCase):
    def make_command(self, platform, name, letter, *options):
        program = platforms.get_program("save_steps", platform)
        return [program, self.folder, name, letter, str(SIZE_MB), *map(str, options)]

    def save(self, platform, letter, *options, name="scene"):
        """Return (exit code, output without white space around it, stderr)."""
        code, output, errors = platforms.run(platform, self.make_command(platform, name, letter, *options))
        return code, output.decode().strip(), errors.decode(errors="replace")

    def load(self):
        """Return the letter of which the saved file is full; None: there is no file. Fails if it is incomplete or mixed."""
        if not os.path.exists(self.path):
            return None
        with open(self.path, encoding="ascii") as file:
            content = file.read()
        self.assertEqual(len(content), int(SIZE_MB * (1 << 20)))
        self.assertEqual(content, content[0] * len(content))
        return content[0]

    def list_unfinished(self):
        return [name for name in os.listdir(self.folder) if name.endswith(ENDING)]

    @on_each_platform
    def test_a_save_replaces_the_file(self, platform):
        for letter in (OLD, NEW):
            self.assertEqual(self.save(platform, letter), (0, "%d steps" % STEP_COUNT, ""))
            self.assertEqual(self.load(), letter)
        self.assertEqual(self.list_unfinished(), [])

    @on_each_platform
    def test_a_process_that_ends_at_any_step_leaves_the_old_or_the_new_file(self, platform):
        self.save(platform, OLD)
        for step in range(1, STEP_COUNT + 1):
            self.assertEqual(self.save(platform, NEW, "end", step)[0], 3)
            self.assertEqual(self.load(), NEW if step == STEP_COUNT else OLD)
            # That of the process before was removed.
            self.assertEqual(len(self.list_unfinished()), 0 if step == STEP_COUNT else 1)
        self.save(platform, OLD)
        self.assertEqual((self.load(), self.list_unfinished()), (OLD, []))

    @on_each_platform
    def test_a_process_does_not_remove_the_unfinished_file_of_a_running_one(self, platform):
        first = platforms.start(platform, self.make_command(platform, "scene", OLD, "wait", 2))
        self.assertEqual(first.stdout.readline().strip(), b"waiting")
        self.assertEqual(self.save(platform, NEW)[0], 0)
        self.assertEqual((self.load(), len(self.list_unfinished())), (NEW, 1))
        output, errors = first.communicate(b"\n", timeout=platforms.TIMEOUT_S)
        self.assertEqual((first.returncode, errors), (0, b""), output)
        self.assertEqual((self.load(), self.list_unfinished()), (OLD, []))

    @on_each_platform
    def test_the_unfinished_file_of_a_process_that_is_killed_stays_until_the_next_save(self, platform):
        # Windows removes a file that is open when it is closed. So if the second process did not respect the lock, the file would
        # disappear with the first.
        first = platforms.start(platform, self.make_command(platform, "scene", OLD, "wait", 2))
        self.assertEqual(first.stdout.readline().strip(), b"waiting")
        self.assertEqual(self.save(platform, NEW)[0], 0)
        first.kill()
        first.communicate(timeout=platforms.TIMEOUT_S)
        self.assertEqual((self.load(), len(self.list_unfinished())), (NEW, 1))
        self.save(platform, OLD)
        self.assertEqual((self.load(), self.list_unfinished()), (OLD, []))

    @on_each_platform
    def test_processes_that_save_the_same_file_at_the_same_time_leave_one_of_theirs(self, platform):
        running = [platforms.start(platform, self.make_command(platform, "scene", letter)) for letter in "abcd"]
        for process in running:
            _, errors = process.communicate(timeout=platforms.TIMEOUT_S)
            self.assertEqual((process.returncode, errors), (0, b""))
        self.assertIn(self.load(), "abcd")
        self.assertEqual(self.list_unfinished(), [])

    @on_each_platform
    def test_a_file_that_another_program_reads_is_replaced_at_the_latest_when_it_is_closed(self, platform):
        self.save(platform, OLD)
        program = platforms.get_program("save_steps", platform)
        reader = platforms.start(platform, [program, self.folder, "scene", "hold"])
        self.assertEqual(reader.stdout.readline().strip(), b"waiting")
        code, _, errors = self.save(platform, NEW)
        if platform.startswith("windows"):  # where a file that is open cannot be replaced
            self.assertEqual((code, self.load()), (1, OLD))
            self.assertRegex(errors, "scene.*Close the programs that have it open, or choose another location\\.")
        else:
            self.assertEqual((code, self.load()), (0, NEW))
        self.assertEqual(self.list_unfinished(), [])
        saver = platforms.start(platform, self.make_command(platform, "scene", NEW))
        time.sleep(0.2)  # Windows: while the save tries again, for a second
        reader.communicate(b"\n", timeout=platforms.TIMEOUT_S)
        _, errors = saver.communicate(timeout=platforms.TIMEOUT_S)
        self.assertEqual((saver.returncode, errors, self.load()), (0, b"", NEW))

    @on_each_platform
    def test_a_name_of_255_bytes_is_saved_and_a_longer_one_is_an_error(self, platform):
        self.assertEqual(self.save(platform, NEW, name="long")[0], 0)
        code, _, errors = self.save(platform, NEW, name="too_long")
        self.assertEqual(code, 1)
        self.assertRegex(errors, "^ERROR: Cannot write .*Choose another location\\.\\s*$")
        self.assertEqual(self.list_unfinished(), [])

    @on_each_platform
    def test_a_missing_folder_is_an_error_with_the_path_and_the_next_step(self, platform):
        command = self.make_command(platform, "scene", NEW)
        command[1] = os.path.join(self.folder, "missing")
        code, _, errors = platforms.run(platform, command)
        self.assertEqual(code, 1)
        self.assertRegex(errors.decode(), "missing.*gnömon ❤ scene.*The folder must exist and be writable\\.")


if __name__ == "__main__":
    unittest.main()
