#!/usr/bin/env python3
"""Measures how quickly the editor starts and responds, and writes the table of doc/benchmarks.md.

    measure_editor.py [--write]

The editor runs under Xvfb at 1280 x 720 pixels, without validation. Without --write the table is only printed. Build first: scons.
"""

import argparse
import os
import statistics
import sys
import tempfile
import time

import driver
from driver import format_yes_no, describe_machine, format_table, publish_tables

sys.path.insert(0, os.path.join(driver.ROOT, "tests", "command_line"))
from editor_case import EditorCase  # noqa: E402

START_COUNT = 5
START_GOAL_S = 2.0
DRAG_COUNT = 4  # mouse drags, of DRAG_STEPS steps each (editor_case.py)


class EditorBenchmark(EditorCase):
    validation_arguments = ()

    def runTest(self):  # unittest needs it to create an instance
        pass

    def start_once(self):
        """Start and close the editor. Return the seconds from the command to the first frame."""
        before = time.monotonic()
        self.open_editor()
        seconds = time.monotonic() - before
        self.rest()
        self.finish()
        return seconds

    def drag_size(self, is_traced=False):
        """Drag a light's size. Return the duration in ms of each frame that changed the scene since the editor started."""
        for _ in range(DRAG_COUNT):
            if is_traced:  # the first round of the reference, with 16 rays per pixel, is done
                self.wait_for(lambda state: state["error"]["is_tracing"] and state["error"]["rays"] >= 16)
            self.drag("property light_size", 2)
            self.rest()
        times = self.get_state()["answers_ms"]
        while self.get_state()["is_changed"]:
            self.press("key", "ctrl+z", "sleep", "0.3")
        return times

    def measure(self):
        with tempfile.TemporaryDirectory() as cache:
            os.environ["GNOMON_CACHE_DIR"] = cache
            cold = self.start_once()
            warm = statistics.median(self.start_once() for _ in range(START_COUNT))
            self.open_editor()
            self.select_light()
            alone = self.drag_size()
            self.click("tab Error")
            count = len(self.get_state()["answers_ms"])
            traced = self.drag_size(is_traced=True)[count:]
            self.finish()
        return cold, warm, alone, traced


def percentile(values, fraction):
    return sorted(values)[min(int(fraction * len(values)), len(values) - 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the table into doc/benchmarks.md")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    EditorBenchmark.setUpClass()
    benchmark = EditorBenchmark()
    try:
        benchmark.setUp()
        cold, warm, alone, traced = benchmark.measure()
    finally:
        benchmark.doCleanups()
        EditorBenchmark.tearDownClass()
    middle = statistics.median
    rows = [
        ("start to the first frame, nothing cached", "%.2f s" % cold, "", ""),
        ("the same, pipelines cached, median of %d" % START_COUNT, "%.2f s" % warm, "< 2 s", format_yes_no(warm < START_GOAL_S)),
        ("a dragged size is seen after, median of %d" % len(alone), "%.0f ms" % middle(alone), "", ""),
        ("90th percentile", "%.0f ms" % percentile(alone, 0.9), "", ""),
        ("a dragged size while the reference is traced, median of %d" % len(traced), "%.0f ms" % middle(traced), "", ""),
        ("its ratio to the one without", "%.2f" % (middle(traced) / middle(alone)), "", ""),
    ]
    table = format_table(("three_lights, three soft shadows", "", "goal", "met"), rows)
    publish_tables({"editor": table}, describe_machine(load), options.write)


if __name__ == "__main__":
    main()
