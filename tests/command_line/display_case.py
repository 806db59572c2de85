"""A virtual display (Xvfb), for tests that look at windows and press keys."""

import os
import subprocess
import sys
import time

from command_line_case import GNOMON, ROOT, CommandLineTest

sys.path.insert(0, os.path.join(ROOT, "tests"))
import virtual_display  # noqa: E402

TIMEOUT_S = 120


class DisplayTest(CommandLineTest):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.display = virtual_display.start(1400, 900)

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait(TIMEOUT_S)

    def start(self, *arguments, **options):
        """Start the program on the display and return its process. options: those of subprocess.Popen."""
        process = subprocess.Popen(
            [GNOMON, *map(str, arguments)],
            env={**os.environ, "DISPLAY": self.display, "GNOMON_CONFIG_DIR": self.path("config")},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            **options,
        )
        self.addCleanup(process.kill)
        return process

    def press(self, *command):
        """Run xdotool commands, such as "key", "ctrl+s"."""
        environment = {**os.environ, "DISPLAY": self.display}
        subprocess.run(["xdotool", *command], env=environment, check=True, timeout=TIMEOUT_S, stdout=subprocess.DEVNULL)

    def focus(self, process):
        """Focus the window, as a window manager would, until it keeps the focus: windows that close meanwhile take it away."""
        environment = {**os.environ, "DISPLAY": self.display}
        pid = str(process.pid)
        find = ["xdotool", "search", "--onlyvisible", "--all", "--pid", pid, "--name", "."]
        check = ["windowfocus", "sleep", "0.5", "getwindowfocus", "getwindowpid"]
        end = time.monotonic() + TIMEOUT_S
        result = None
        while result is None or result.stdout.strip() != pid:
            self.assertLess(time.monotonic(), end, "the window of %s does not keep the focus: %s" % (pid, result))
            result = subprocess.run([*find, *check], env=environment, capture_output=True, text=True, timeout=TIMEOUT_S)

    def finish(self, process):
        _, errors = process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(process.returncode, 0, errors)
