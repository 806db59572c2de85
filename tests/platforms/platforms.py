"""The platforms of the add-on for tests, and how to run their programs here: as they are, under Wine, or under QEMU."""

import atexit
import functools
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests"))
import virtual_display  # noqa: E402

ADDON = os.path.join(ROOT, "demo_project", "godot", "addons", "gnomon")
LIBRARIES = {
    "linux.x86_64": "libgnomon.linux.x86_64.so",
    "windows.x86_64": "libgnomon.windows.x86_64.dll",
    "linux.arm64": "libgnomon.linux.arm64.so",
}
WINE = "/usr/lib/wine/wine64"  # Debian has it outside of PATH
WINE_SERVER = "/usr/lib/wine/wineserver64"
DRIVER = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"
WINE_FOLDER = os.environ.get("GNOMON_WINE_FOLDER", os.path.join(ROOT, "build", "wine"))  # its registry and drive C:, made at the first start
TIMEOUT_S = 120  # only for hangs; the first start of Wine takes up to 20 s
# Lets the validation layers of Linux' Vulkan loader check what a program for Windows does, which cannot load them itself.
VALIDATION = {
    "GNOMON_TEST_VALIDATION": "external",
    "VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation",
    "VK_LAYER_ENABLES": "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT",
}
PROGRAMS = ("linux.x86_64", "windows.x86_64")  # platforms of the program, bin/gnomon


def get_library(platform):
    """Return the path of the add-on's library."""
    return os.path.join(ADDON, "bin", LIBRARIES[platform])


def get_main_program(platform):
    """Return the path of the program, which is built for PROGRAMS."""
    return os.path.join(ROOT, "bin", "gnomon" + (".exe" if platform.startswith("windows") else ""))


def get_program(name, platform):
    """Return the path of a test program, which is built for all platforms."""
    return os.path.join(ROOT, "bin", "%s.%s%s" % (name, platform, ".exe" if platform.startswith("windows") else ""))


def start(platform, command, graphics=None):
    """Start a program of the platform, with pipes. See prepare()."""
    command, environment = prepare(platform, command, graphics)
    return subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def prepare(platform, command, graphics=None):
    """Return the command that runs a program of the platform here, and its environment. Arguments that are paths must be absolute.
    graphics: environment variables of a program that draws; None: it does not draw."""
    environment = None
    if graphics is not None:
        driver = {"VK_DRIVER_FILES": DRIVER, "VK_ICD_FILENAMES": DRIVER}  # the same on every platform
        environment = {**(prepare_wine() if platform.startswith("windows") else os.environ), **driver, **graphics}
    if platform.startswith("windows"):
        environment = environment or prepare_wine()
        command = [WINE] + command
    elif platform == "linux.arm64":
        command = ["qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"] + command
    return command, environment


@functools.lru_cache(maxsize=None)
def prepare_wine():
    """Start Wine, which makes WINE_FOLDER if it is absent. Return the environment in which it runs programs."""
    environment = dict(os.environ)
    # Without the overrides Wine offers to install .NET and a browser, in windows.
    environment.update(WINEPREFIX=WINE_FOLDER, WINEDEBUG="-all", WINEDLLOVERRIDES="mscoree,mshtml=")
    # A display before Wine starts, which asks for it once. Its Vulkan does not work without one.
    server, environment["DISPLAY"] = virtual_display.start(1280, 1024)
    atexit.register(server.terminate)
    os.makedirs(WINE_FOLDER, exist_ok=True)
    # The server stays until the tests end. Otherwise each program would start it and its services, which inherit the program's
    # pipes and keep them open for seconds after the program has ended.
    subprocess.run([WINE_SERVER, "--persistent"], env=environment, check=True)
    atexit.register(subprocess.run, [WINE_SERVER, "--kill"], env=environment)
    done = subprocess.run([WINE, "wineboot"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=TIMEOUT_S)
    if done.returncode != 0:
        raise RuntimeError("wineboot ended with %d in %s. Remove that folder and try again." % (done.returncode, WINE_FOLDER))
    return environment


def run(platform, command, graphics=None):
    """Run a program of the platform, see start. Return (exit code, what it printed, what it printed on stderr), as bytes."""
    process = start(platform, command, graphics)
    try:
        output, errors = process.communicate(timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        output, errors = process.communicate()
        return 124, output, errors
    return process.returncode, output, errors
