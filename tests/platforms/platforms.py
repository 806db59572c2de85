"""The platforms of the add-on for tests, and how to run their programs here: as they are, under Wine, or under QEMU."""

import atexit
import functools
import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ADDON = os.path.join(ROOT, "demo_project", "godot", "addons", "gnomon")
LIBRARIES = {
    "linux.x86_64": "libgnomon.linux.x86_64.so",
    "windows.x86_64": "libgnomon.windows.x86_64.dll",
    "linux.arm64": "libgnomon.linux.arm64.so",
}
WINE = "/usr/lib/wine/wine64"  # Debian has it outside of PATH
WINE_SERVER = "/usr/lib/wine/wineserver64"
WINE_FOLDER = os.path.join(ROOT, "build", "wine")  # its registry and drive C:, made at the first start
TIMEOUT_S = 120  # only for hangs; the first start of Wine takes up to 20 s


def get_library(platform):
    """Return the path of the add-on's library."""
    return os.path.join(ADDON, "bin", LIBRARIES[platform])


def get_program(name, platform):
    """Return the path of a test program."""
    return os.path.join(ROOT, "bin", "%s.%s%s" % (name, platform, ".exe" if platform.startswith("windows") else ""))


def start(platform, command):
    """Start a program of the platform, with pipes. Arguments that are paths must be absolute."""
    environment = None
    if platform.startswith("windows"):
        environment = prepare_wine()
        command = [WINE] + command
    elif platform == "linux.arm64":
        command = ["qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"] + command
    return subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


@functools.lru_cache(maxsize=None)
def prepare_wine():
    """Start Wine, which makes WINE_FOLDER if it is absent. Return the environment in which it runs programs."""
    environment = dict(os.environ)
    # Without the overrides Wine offers to install .NET and a browser, in windows.
    environment.update(WINEPREFIX=WINE_FOLDER, WINEDEBUG="-all", WINEDLLOVERRIDES="mscoree,mshtml=")
    environment.pop("DISPLAY", None)
    os.makedirs(WINE_FOLDER, exist_ok=True)
    # The server stays until the tests end. Otherwise each program would start it and its services, which inherit the program's
    # pipes and keep them open for seconds after the program has ended.
    subprocess.run([WINE_SERVER, "--persistent"], env=environment, check=True)
    atexit.register(subprocess.run, [WINE_SERVER, "--kill"], env=environment)
    done = subprocess.run([WINE, "wineboot"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=TIMEOUT_S)
    if done.returncode != 0:
        raise RuntimeError("wineboot ended with %d in %s. Remove that folder and try again." % (done.returncode, WINE_FOLDER))
    return environment


def run(platform, command):
    """Run a program of the platform. Return (exit code, what it printed, what it printed on stderr), as bytes."""
    process = start(platform, command)
    try:
        output, errors = process.communicate(timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        output, errors = process.communicate()
        return 124, output, errors
    return process.returncode, output, errors
