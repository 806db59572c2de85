#!/usr/bin/env python3
"""Writes doc/classes from the properties that the program declares.

    make_classes.py            writes light_3d.md, one page for each technique and mask filter of the build, and index.md
    make_classes.py --check    writes nothing; names each page that is out of date

The program is bin/gnomon, or $GNOMON. Pages of techniques and filters that are not in this build do not change.
Exit code: 0 done, 1 a page is out of date or the program failed.
"""

import argparse
import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
GNOMON = os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon"))
FOLDER = os.path.join(ROOT, "doc", "classes")
NOTE = "<!-- Written by doc/make_classes.py from the declarations in the code; do not edit. -->"
COMMON_HEADING = "every light"  # in the output of `gnomon techniques`, before the properties that all lights have
# "    light_size = 0.1 (0..10000 m): Radius ...", as `gnomon techniques` prints it.
PROPERTY_LINE = re.compile(r"^    (\w+) = (.*?) ?\((.+?)\): (.+)$")
TIMEOUT_S = 60


def run_gnomon(*arguments):
    command = [GNOMON, *arguments]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    except OSError as error:
        raise SystemExit("ERROR: %s: %s. Build it with scons." % (GNOMON, error.strerror)) from error
    except subprocess.TimeoutExpired as error:
        raise SystemExit("ERROR: %s did not end in %d s." % (" ".join(command), TIMEOUT_S)) from error
    if result.returncode != 0:
        raise SystemExit("ERROR: %s ended with %d: %s" % (" ".join(command), result.returncode, result.stderr))
    return result.stdout


def parse_common_properties(text):
    """Return the properties that every light has. They are only in the text output, not in the JSON."""
    lines = text.splitlines()
    if COMMON_HEADING not in lines:
        raise SystemExit('ERROR: `gnomon techniques` printed no section "%s".' % COMMON_HEADING)
    properties = []
    for line in lines[lines.index(COMMON_HEADING) + 1 :]:
        match = PROPERTY_LINE.match(line)
        if not match:
            raise SystemExit("ERROR: `gnomon techniques` printed a line that is no property: %s" % line)
        name, default, allowed, tooltip = match.groups()
        properties.append({"name": name, "default": default, "range": allowed, "tooltip": tooltip})
    return properties


def format_default(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return "%g" % value
    return str(value)


def format_table(properties):
    """Return the lines of a Markdown table. properties: dicts with name, default, range and tooltip."""
    lines = ["| property | default | allowed | meaning |", "|---|---|---|---|"]
    for item in properties:
        default = format_default(item["default"])
        cells = ("`%s`" % item["name"], "`%s`" % default if default else "empty", item["range"], item["tooltip"])
        lines.append("| %s |" % " | ".join(cell.replace("|", "\\|") for cell in cells))
    return lines


def make_page_link(added_id):
    """Return lines with a link to the page that explains the technique or filter; no lines if there is no such page."""
    if os.path.isfile(os.path.join(ROOT, "doc", "techniques", added_id + ".md")):
        return ["", "How it works: [%s](../techniques/%s.md)." % (added_id, added_id)]
    return []


def make_widths(widths):
    """Return lines on the penumbra widths of a light that sets none; no lines if they are the light's size."""
    if all(factor == 1 for factor in widths.values()):
        return []
    texts = ["%.3g R" % factor if factor else "0" for factor in (widths["outer_per_size"], widths["inner_per_size"])]
    return ["", "Penumbra widths that a light does not set are r = %s and t = %s." % tuple(texts)]


def make_properties_page(item):
    """Return the page of a technique or filter. item: its description in the JSON of `gnomon techniques` or `filters`."""
    lines = ["# Properties of `%s`" % item["id"], "", NOTE, "", "%s. Source: %s." % (item["name"], item["source"])]
    lines += make_page_link(item["id"])
    lines += make_widths(item.get("derived_widths", {})) + [""]
    if item["properties"]:
        lines += ["A light stores them in its `extras`; `--set` changes them for one run.", ""]
        lines += format_table(item["properties"])
    else:
        lines.append("The technique adds no properties to a light.")
    if item.get("settings"):
        lines += ["", "## Settings of the technique", ""]
        lines += ["For all lights; the image is the same. In `project.cfg` below `[technique.%s]`, or for one run" % item["id"]]
        lines += ["`--set technique.%s.NAME=value`." % item["id"], ""]
        lines += format_table(item["settings"])
    return "\n".join(lines + ["", "Properties of every light: [Light3D](light_3d.md).", ""])


def make_light_page(properties):
    lines = ["# Properties of every light (Light3D)", "", NOTE, ""]
    lines += ["Every light has these, whatever its technique. A glTF light stores them in its `extras`; see"]
    lines += ["[Scene files](../scene_files.md). `--set` changes them for one run.", ""]
    return "\n".join(lines + format_table(properties) + [""])


def make_index(names):
    """Return index.md. names: those of the pages of techniques and filters, without .md."""
    lines = ["# Properties", "", NOTE, "", "- [Every light](light_3d.md)"]
    lines += ["- [%s](%s.md)" % (name, name) for name in names]
    return "\n".join(lines + [""])


def make_pages():
    """Return the text of every page by its file name."""
    added = json.loads(run_gnomon("techniques", "--json")) + json.loads(run_gnomon("filters", "--json"))
    pages = {item["id"] + ".md": make_properties_page(item) for item in added if not item.get("is_example")}
    pages["light_3d.md"] = make_light_page(parse_common_properties(run_gnomon("techniques")))
    existing = os.listdir(FOLDER) if os.path.isdir(FOLDER) else []
    names = {name for name in [*pages, *existing] if name.endswith(".md")} - {"light_3d.md", "index.md"}
    pages["index.md"] = make_index(sorted(name[: -len(".md")] for name in names))
    return pages


def read_page(name):
    path = os.path.join(FOLDER, name)
    if not os.path.isfile(path):
        return ""
    with open(path, encoding="utf-8") as file:
        return file.read()


def main():
    parser = argparse.ArgumentParser(description="Writes doc/classes from the declared properties.")
    parser.add_argument("--check", action="store_true", help="only name the pages that are out of date")
    arguments = parser.parse_args()
    pages = make_pages()
    stale = sorted(name for name, text in pages.items() if read_page(name) != text)
    if arguments.check:
        for name in stale:
            print("doc/classes/%s is out of date. Run doc/make_classes.py." % name)
        return 1 if stale else 0
    os.makedirs(FOLDER, exist_ok=True)
    for name in stale:
        with open(os.path.join(FOLDER, name), "w", encoding="utf-8") as file:
            file.write(pages[name])
        print("wrote doc/classes/%s" % name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
