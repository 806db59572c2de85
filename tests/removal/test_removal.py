#!/usr/bin/env python3
"""Deletes a technique's module, shaders and golden images, or the module of a report part, in a copy of the tree, which must
still build and pass its tests.

    test_removal.py [--all] [--module NAME] [--jobs N]

Without --all and --module the technique with the fewest bytes of C++ source files and all report parts are removed together,
since each build takes minutes. --all removes every module that registers a technique or a report part, in turn. Mask filters
count as techniques here.
The copy includes the build folder, so that mainly the link has to be repeated.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TIMEOUT_S = 3600

sys.path.insert(0, os.path.join(ROOT, "tests", "layers"))
import test_layers  # noqa: E402


def find_smallest(techniques):
    """Return the module with the fewest bytes of .cpp files."""

    def measure(module):
        folder = os.path.join(ROOT, "modules", module)
        return sum(os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder) if name.endswith(".cpp"))

    return min(sorted(techniques), key=measure, default="")


def copy_tree(target):
    """Copy the tracked files in their current state, and build/release, with their modification times."""
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, check=True).stdout.decode()
    for name in names.split("\0"):
        source = os.path.join(ROOT, name)
        if name and os.path.isfile(source):
            os.makedirs(os.path.dirname(os.path.join(target, name)), exist_ok=True)
            shutil.copy2(source, os.path.join(target, name))
    if os.path.isdir(os.path.join(ROOT, "build", "release")):
        shutil.copytree(os.path.join(ROOT, "build", "release"), os.path.join(target, "build", "release"))


def find_report_parts(tree):
    """Return module -> ids, which are empty, for the modules that register report parts."""
    paths = {name: "modules/%s/register_types.cpp" % name for name in tree.configs}
    return {name: set() for name, path in paths.items() if path in tree.files and "ReportPartRegistry::add" in tree.get_text(path)}


def remove_module(target, module, ids):
    """Delete what belongs to a module. ids: of its techniques."""
    shutil.rmtree(os.path.join(target, "modules", module))
    for folder in ("shaders/" + module, "build/release/modules/" + module, "build/release/shaders/" + module):
        shutil.rmtree(os.path.join(target, folder), ignore_errors=True)
    golden = os.path.join(target, "tests", "golden")
    for folder, _, names in os.walk(golden):
        for name in names:
            if name.split(".")[0] in ids and name.endswith(".png"):
                os.remove(os.path.join(folder, name))
    limits = os.path.join(golden, "accuracy.json")
    with open(limits, encoding="utf-8") as file:
        content = json.load(file)
    for case in content["cases"] + content["hard_cases"]:
        case["results"] = [result for result in case["results"] if result["id"] not in ids]
    with open(limits, "w", encoding="utf-8") as file:
        json.dump(content, file)


def run(target, what, command):
    """Run a command. Return whether it ends with 0, and print the end of its output otherwise."""
    result = subprocess.run(
        command, cwd=target, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, timeout=TIMEOUT_S
    )
    if result.returncode != 0:
        print("FAILED: %s: %s ended with %d" % (what, " ".join(command), result.returncode))
        lines = result.stdout.splitlines()
        failed = [line for line in lines[:-30] if "ERROR" in line or "FAILED" in line]
        print("\n".join("    " + line for line in failed[:30] + lines[-30:]), flush=True)
    return result.returncode == 0


def build_exclude_options(tree):
    """Return doctest's options that skip tests which the removal of a technique or report part cannot affect: those of
    other techniques, since techniques never depend on each other (tests/layers), and of modules below the technique registry.
    """
    unaffected = set(tree.find_techniques())
    unaffected |= {name for name, config in tree.configs.items() if config["layer"] < tree.configs["shadows"]["layer"]}
    return [
        "--source-file-exclude=" + ",".join("*modules/%s/tests/*" % name for name in sorted(unaffected)),
        "--test-case-exclude=*without*every technique*",  # devices that lack a feature
    ]


def test_modules(tree, removed, jobs):
    """Return (passed, failed) of a tree without some modules. removed: module -> ids of its techniques."""
    what = "without " + ", ".join(sorted(removed))
    ids = set().union(*removed.values())
    with tempfile.TemporaryDirectory() as target:
        copy_tree(target)
        for module in removed:
            remove_module(target, module, removed[module])
        print("removal: %s: build" % what, flush=True)
        if not run(target, what, ["scons", "-Q", "-j%d" % jobs, "compiledb=no"]):
            return 0, 1
        results = [
            run(target, what, [sys.executable, "tests/layers/test_layers.py"]),
            run(target, what, [sys.executable, "tests/run_engine.py", "bin/gnomon_tests", "--", *build_exclude_options(tree)]),
        ]
        listed = subprocess.run(["bin/gnomon", "techniques"], cwd=target, capture_output=True, text=True, check=False)
        still_there = [name for name in ids if re.search(r"(?m)^\W*%s\b" % name, listed.stdout)]
        if listed.returncode != 0 or still_there:
            print("FAILED: %s: `gnomon techniques` ended with %d and lists %s" % (what, listed.returncode, still_there))
        results.append(listed.returncode == 0 and not still_there)
    return 1 + results.count(True), results.count(False)


def main():
    parser = argparse.ArgumentParser(description="Removes techniques and report parts and checks that nothing misses them.")
    parser.add_argument("--all", action="store_true", help="every module of a technique or report part, in turn")
    parser.add_argument("--module", help="this module only")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="build jobs (default: one per core)")
    arguments = parser.parse_args()
    tree = test_layers.Tree(ROOT)
    techniques = {name: ids for name, (ids, _) in tree.find_techniques().items()}
    parts = find_report_parts(tree)
    removable = techniques | parts
    if arguments.module and arguments.module not in removable:
        parser.error("%s registers no technique or report part. Those that do: %s" % (arguments.module, ", ".join(sorted(removable))))
    requested = [[find_smallest(techniques), *parts]]
    if arguments.all or arguments.module:
        requested = [[module] for module in ([arguments.module] if arguments.module else sorted(removable))]
    passed = failed = 0
    for modules in requested:
        group_passed, group_failed = test_modules(tree, {module: removable[module] for module in modules}, arguments.jobs)
        passed += group_passed
        failed += group_failed
    print("%d passed, %d failed, 0 skipped" % (passed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
