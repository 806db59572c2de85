"""A virtual display (Xvfb) for tests."""

import os
import subprocess


def start(width, height):
    """Start a display of that size in pixels. Return (its process, to be terminated; its name, the value of $DISPLAY)."""
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "%dx%dx24" % (width, height), "-nolisten", "tcp", "-noreset"],
        pass_fds=[write_end],
        stderr=subprocess.DEVNULL,
    )
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        return server, ":" + pipe.readline().strip()
