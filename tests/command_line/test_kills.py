"""Programs that are killed while they write, at random times and as soon as a file appears: nothing is lost or left.

GNOMON_KILL_COUNT, which tests/run_tests.sh --full sets, controls the number of kills. Without it
each program is killed a few times, the editor not at all.
"""

import glob
import os
import random
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_report_page import check_page  # noqa: E402
from command_line_case import GNOMON, SCENES, full_run_only, find_technique, run  # noqa: E402
from editor_case import EditorCase, load  # noqa: E402
from report_case import PROJECT, QUICK, ReportCase, drop_times, get_record_path, load_report, stop_after  # noqa: E402

SEED = 20100901  # of the random numbers; any number
TIMEOUT_S = 180
MAX_DELAY_S = 1.5  # about as long as the programs run
REPORT = ("--scenes", "contact_box,sphere", "--sizes", "0.2,0.8", *QUICK)
UNFINISHED = ".*.gnomon_part"  # see modules/core/files.h


def get_kill_count(default, divisor=1):
    value = os.environ.get("GNOMON_KILL_COUNT")
    return max(int(value) // divisor, 1) if value else default


def list_unfinished(folder):
    return glob.glob(os.path.join(folder, "**", UNFINISHED), recursive=True)


def kill_at_random(process, folders, generator, max_skipped=3, stop=None):
    """Kill a process: with probability 1/2 when it begins to write a file in one of the folders, else at a random time.

    max_skipped: how many files it may begin before that, at most. stop: a file at which the process hangs, or None.
    Return True if it was killed, False if it had ended before.
    """
    delay_s = generator.uniform(0, MAX_DELAY_S)
    waits_for_file = generator.random() < 0.5
    skipped_count = generator.randrange(max_skipped + 1)  # files that it may begin first
    seen = {path for folder in folders for path in list_unfinished(folder)}
    end = time.monotonic() + (TIMEOUT_S if waits_for_file else delay_s)
    while process.poll() is None and time.monotonic() < end:
        begun = {path for folder in folders for path in list_unfinished(folder)} - seen if waits_for_file else set()
        seen |= begun
        skipped_count -= len(begun)
        if skipped_count < 0 or (waits_for_file and stop and os.path.exists(stop)):
            time.sleep(generator.choice((0, 0, 0.001)))  # kills at once or a little later
            break
        time.sleep(0 if begun else 0.001)
    process.send_signal(signal.SIGKILL)
    return process.wait(TIMEOUT_S) == -signal.SIGKILL


class KilledReports(ReportCase):
    def test_a_report_that_is_killed_again_and_again_ends_as_one_that_was_not(self):
        generator = random.Random(SEED)
        techniques = ("--techniques", self.report_techniques())
        whole = self.load_done("whole", run("report", PROJECT, "--out", self.path("whole"), *REPORT, *techniques))
        records = [cell["record"] for cell in load_report(self.path("whole"))["cells"]]
        cache = self.path("cache")
        killed_count = left_count = done_count = 0
        for index in range(get_kill_count(3)):
            out = self.path("report_%d" % done_count)
            arguments = ["report", PROJECT, "--out", out, *REPORT, *techniques, "--resume"]
            left = [path for path in (get_record_path(out, record) for record in records) if not os.path.exists(path)]
            # The run hangs before its end, so that it is killed however fast it is, unless only its last record is left.
            stop = generator.choice(left[:-1]) if len(left) > 1 else None
            environment = {**os.environ, "GNOMON_CACHE_DIR": cache, **(stop_after(stop) if stop else {})}
            with self.subTest(kill=index, seed=SEED):
                process = subprocess.Popen(
                    [GNOMON, *arguments], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
                )
                was_killed = kill_at_random(process, (out, cache), generator, stop=stop)
                self.assertTrue(was_killed or stop is None, "it ended although its device should hang")
                errors = process.stderr.read()
                process.stderr.close()
                self.assertNotIn("damaged", errors)
                self.assertNotIn("ERROR", errors)
                killed_count += was_killed
                left_count += len(list_unfinished(out))
                self.assertLessEqual(len(list_unfinished(out)), 3, "unfinished files accumulate")
                if not was_killed:  # it had finished: go on with a new report in another folder
                    self.assert_same(out, whole)
                    done_count += 1
        result = run("report", PROJECT, "--out", self.path("report_%d" % done_count), *REPORT, *techniques, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("damaged", result.stderr)
        self.assert_same(self.path("report_%d" % done_count), whole)
        self.assertEqual(check_page(self.path("report_%d/index.html" % done_count)), [])
        self.assertGreater(killed_count, 0)
        print("killed %d times, %d unfinished files, %d reports ended before" % (killed_count, left_count, done_count))

    def assert_same(self, out, whole):
        report = load_report(out)
        self.assertEqual(drop_times(report)["configurations"], drop_times(whole)["configurations"])
        self.assertEqual(drop_times(report)["cells"], drop_times(whole)["cells"])
        self.assertEqual(list_unfinished(out), [])

    def test_a_cache_whose_writers_are_killed_is_whole_and_stays_small(self):
        generator = random.Random(SEED + 1)
        environment = {**os.environ, "GNOMON_CACHE_DIR": self.path("cache")}
        for index in range(get_kill_count(4)):
            command = self.make_trace_command(16 + index)
            with self.subTest(kill=index, seed=SEED):
                process = subprocess.Popen(
                    [GNOMON, *command], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
                )
                kill_at_random(process, (self.path("cache"),), generator)
                errors = process.stderr.read()
                process.stderr.close()
                self.assertNotIn("damaged", errors)
                self.assertNotIn("ERROR", errors)
                self.assertLessEqual(len(list_unfinished(self.path("cache"))), 1)
        result = run(*self.make_trace_command(15), GNOMON_CACHE_DIR=self.path("cache"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("damaged", result.stderr)
        self.assertEqual(list_unfinished(self.path("cache")), [])

    def make_trace_command(self, sample_count):
        """Return a command that traces a reference; each sample count has its own cache entry."""
        reference = find_technique("is_reference")
        settings = ("--set", "%s_samples=%d" % (reference, sample_count))
        scene = os.path.join(SCENES, "sphere.gltf")
        return ["visibility", scene, "--technique", reference, "--size", "128x128", "--out", self.path("m.exr"), *settings]


@full_run_only  # test_editor_document.cpp tests a kill after each step of saving
class KilledEditor(EditorCase):
    def test_an_editor_that_is_killed_while_it_saves_leaves_the_scene_before_or_after(self):
        generator = random.Random(SEED + 2)
        folder = os.path.dirname(self.scene)
        sizes = [self.get_size()]
        for index in range(get_kill_count(default=1, divisor=20)):
            with self.subTest(kill=index, seed=SEED):
                self.open_editor()
                if "button Discard" in self.get_state()["items"]:
                    self.click("button Discard")
                self.select_light()
                self.drag("property light_size", 1)
                self.wait_for(lambda state: state["is_changed"])
                self.press("key", "ctrl+s")
                kill_at_random(self.process, (folder,), generator, max_skipped=0)  # it does not end by itself
                self.process.communicate()
                self.assertGreaterEqual(self.get_size(), sizes[-1])
                sizes.append(self.get_size())
                self.assertLessEqual(len(list_unfinished(folder)), 1)
        self.open_editor()
        self.press("key", "ctrl+q")
        self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(self.process.returncode, 0)

    def get_size(self):
        return self.find_light(load(self.scene))["extras"]["light_size"]


if __name__ == "__main__":
    unittest.main()
