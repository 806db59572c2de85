"""A display without a screen, for tests that look at windows and press keys."""

import os
import subprocess

from command_line_case import GNOMON, CommandLineTest

TIMEOUT_S = 120


class DisplayTest(CommandLineTest):
    @classmethod
    def setUpClass(cls):
        read_end, write_end = os.pipe()
        cls.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1400x900x24", "-nolisten", "tcp"],
            pass_fds=[write_end],
            stderr=subprocess.DEVNULL,
        )
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            cls.display = ":" + pipe.readline().strip()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait(TIMEOUT_S)

    def start(self, *arguments, **options):
        """The program, with the arguments, on the display. options: of subprocess.Popen."""
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
        environment = {**os.environ, "DISPLAY": self.display}
        subprocess.run(["xdotool", *command], env=environment, check=True, timeout=TIMEOUT_S, stdout=subprocess.DEVNULL)

    def finish(self, process):
        _, errors = process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(process.returncode, 0, errors)
