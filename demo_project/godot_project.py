"""Runs Godot on the demo's Godot project."""

import os
import re
import shutil
import signal
import subprocess

PROJECT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "godot")
TIMEOUT_S = 3600  # only for hangs: the longest run takes up to half of this on a slow machine
DEVICE_OPTIONS = ["--rendering-method", "forward_plus", "--rendering-driver", "vulkan", "--audio-driver", "Dummy"]
# Messages to ignore. Godot's SPIR-V optimizer logs the first about shaders that it then returns unchanged. The second is a race
# of Godot's threads, each of which changes the working directory of the process for a moment (Godot issue 115321).
HARMLESS = re.compile(r"is not supported yet\.$|Parameter \"getcwd\(real_current_dir_name, \d+\)\" is null\.$")


def prepare(project=PROJECT):
    """Make the project's folder .godot from scratch: register the add-on's library and the scripts' classes with Godot,
    as opening the project in the editor does.

    The list of extensions is written here, because Godot 4.6 crashes if it finds an add-on's library for the first time during an
    import without a window (Godot issue 111048).
    """
    shutil.rmtree(os.path.join(project, ".godot"), ignore_errors=True)
    os.makedirs(os.path.join(project, ".godot"))
    with open(os.path.join(project, ".godot", "extension_list.cfg"), "w", encoding="utf-8") as file:
        file.write("res://addons/gnomon/gnomon.gdextension\n")
    run_godot(["--headless", "--path", project, "--import"])


def start_godot(arguments, variables={}):
    """Run $GODOT to its end, with additional environment variables; return (exit code, output). 124: it timed out.

    $GODOT_DISPLAY is "virtual" unless it is set. With it, the $GODOT and $GODOT_RUN of install_godot.sh start Debian's Godot in an X
    display of its own; another Godot ignores it.
    """
    return _start([os.environ["GODOT"]] + arguments, variables)


def start_game(path, arguments):
    """Run a game that Godot exported to its end, with DEVICE_OPTIONS; return what start_godot returns."""
    runner = os.environ.get("GODOT_RUN")
    return _start(([runner] if runner else []) + [path] + DEVICE_OPTIONS + arguments, {})


def _start(command, variables):
    environment = dict(os.environ, **variables)
    environment.setdefault("GODOT_DISPLAY", "virtual")
    # A process session of its own, so that a timeout also ends what the command started: the display and Godot.
    process = subprocess.Popen(
        command,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
    )
    try:
        output, _errors = process.communicate(timeout=TIMEOUT_S)
        return process.returncode, output
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _errors = process.communicate()
        return 124, output + "\nFAILED: did not end within %d s" % TIMEOUT_S
    except BaseException:
        os.killpg(process.pid, signal.SIGKILL)
        raise


def run_godot(arguments):
    """Run Godot and return its output. Exits with an error if Godot fails or times out."""
    code, output = start_godot(arguments)
    if code != 0:
        raise SystemExit("ERROR: %s ended with %d\n%s" % (" ".join(arguments), code, output))
    return output


def get_version():
    """Return Godot's version, such as "4.6.3.stable.debian"."""
    return run_godot(["--version"]).strip().splitlines()[-1]


def run(scene, options, size, project=PROJECT):
    """Run a scene of the project in a square window of size pixels, with the options of the scene; return its output."""
    arguments = ["--path", project] + DEVICE_OPTIONS
    arguments += ["--disable-vsync", "--resolution", "%dx%d" % (size, size), scene, "--"]
    return run_godot(arguments + options)


def find_messages(output):
    """Return the lines in which Godot or a script logged a warning or an error, without harmless ones."""
    lines = [line for line in output.splitlines() if re.match(r"(WARNING|ERROR|SCRIPT ERROR|USER \w+): ", line)]
    return [line for line in lines if not HARMLESS.search(line)]
