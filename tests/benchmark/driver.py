"""Functions that the benchmarks share: run the program, format tables, and write them between the markers of a page."""

import datetime
import json
import os
import re
import subprocess
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon"))
PAGE = os.path.join(ROOT, "doc", "benchmarks.md")
SCENES = os.path.join(ROOT, "demo_project", "scenes")
TIMEOUT_S = 3600


def run(command, folder=ROOT, **options):
    """Run a command and return its stdout. Exits if the command fails."""
    result = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, timeout=TIMEOUT_S, **options
    )
    if result.returncode != 0:
        raise SystemExit("ERROR: %s ended with %d: %s" % (" ".join(command), result.returncode, result.stderr.strip()))
    return result.stdout


def run_gnomon(*arguments):
    """Run bin/gnomon, or $GNOMON, and return its stdout."""
    return run([PROGRAM, *map(str, arguments)])


def format_row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def format_table(header, rows):
    return [format_row(*header), format_row(*("---" for _ in header))] + [format_row(*row) for row in rows]


def format_yes_no(is_met):
    return "yes" if is_met else "no"


def describe_processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        found = re.search(r"^model name\s*:\s*(.+)$", file.read(), re.MULTILINE)
    return found.group(1) if found else "unknown processor"


def describe_machine(load=None):
    """Describe date, processor, device and driver in one line. load: load average before a measurement of times began."""
    device, driver = "unknown", "unknown"
    with tempfile.TemporaryDirectory() as folder:
        times = os.path.join(folder, "time.json")
        run([PROGRAM, "visibility", os.path.join(SCENES, "sphere.gltf"), "--technique", "shadow_map", "--size", "16x16",
             "--out", os.path.join(folder, "mask.exr"), "--time", times])  # fmt: skip
        with open(times, encoding="utf-8") as file:
            result = json.load(file)
        device, driver = result["device"], result["driver"]
    machine = "%s: %s, %d cores; %s, %s." % (
        datetime.date.today().isoformat(), describe_processor(), os.cpu_count() or 1, device, driver)  # fmt: skip
    if load is None:
        return machine
    other_work = " - if other work ran at the same time, the times are too long" if load > 1.5 else ""
    return "%s Load when it began: %.1f%s." % (machine, load, other_work)


def publish_tables(tables, measured, writes):
    """Print tables (name -> lines), each followed by `measured`, which describes the machine. Write them into the page if `writes`."""
    for name, lines in tables.items():
        lines += ["", measured]
        print("\n%s\n%s" % (name, "\n".join(lines)), flush=True)
        if writes:
            write_table(name, lines)


def write_table(name, lines, page=PAGE):
    """Replace the text between the page's two markers of that name."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    begin, end = "<!-- begin %s -->" % name, "<!-- end %s -->" % name
    if begin not in text or end not in text:
        raise SystemExit("ERROR: %s has no markers %s and %s. Add them where the table belongs." % (page, begin, end))
    before, rest = text.split(begin, 1)
    after = rest.split(end, 1)[1]
    with open(page, "w", encoding="utf-8") as file:
        file.write(before + begin + "\n" + "\n".join(lines) + "\n" + end + after)
