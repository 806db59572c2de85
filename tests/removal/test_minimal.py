#!/usr/bin/env python3
"""Tests builds with disabled modules: the smallest game, which loads a scene and draws it headless, without editor,
report and window, and programs that lack the report or parts of it.

    test_minimal.py --plan           queries scons for what it would build and from which files; compiles nothing
    test_minimal.py [--jobs N]       builds them in a copy of the tree and runs them
    test_minimal.py --write-sizes    builds only the smallest game, and writes the table of sizes in doc/getting_started.md

Modules are disabled by module_<name>_enabled=no.
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
PAGE = os.path.join(ROOT, "doc", "getting_started.md")
# What a game needs; its one technique is the registry's default.
ENGINE = ("core", "rendering_device", "rendering_device_vulkan", "scene", "mesh_tools", "render_graph")
ENGINE += ("shadows", "renderer", "gltf_scene", "main")
ABSENT_COMMANDS = {"edit": "editor", "visibility": "masks", "compare": "masks", "report": "error_report"}
PROGRAM = "bin/gnomon"
SCENE = os.path.join("demo_project", "scenes", "sphere.gltf")
SMALL_REPORT = ("report", SCENE, "--size", "16x16", "--samples", "4", "--scaling", "none", "--out", "report")
# (Modules that are disabled together, arguments that are refused then, module that the refusal names, arguments that work.)
PARTIAL_BUILDS = (
    (("stability_report",), (*SMALL_REPORT, "--stability", "quick"), "stability_report", SMALL_REPORT),
    (("stability_report",), (*SMALL_REPORT, "--sweeps", "scale"), "stability_report", SMALL_REPORT),
    (("animation_report", "stability_report"), (*SMALL_REPORT, "--change", "quick"), "animation_report", SMALL_REPORT),
    (("animation_report", "stability_report", "error_report"), SMALL_REPORT, "error_report", ("compare", "mask.exr", "mask.exr")),
    (
        ("animation_report", "stability_report", "error_report", "masks", "editor"),
        ("visibility", SCENE),
        "masks",
        ("techniques",),
    ),
)

sys.path.insert(0, os.path.join(ROOT, "tests", "layers"))
sys.path.insert(0, os.path.join(ROOT, "tests", "removal"))
sys.path.insert(0, os.path.join(ROOT, "modules"))
import modules_builders  # noqa: E402
import test_layers  # noqa: E402
import test_removal  # noqa: E402


def find_default_technique():
    """Return (module, id) of the technique with the highest default_rank."""
    best = (0, "", "")
    for module, (ids, _) in test_layers.Tree(ROOT).find_techniques().items():
        with open(os.path.join(ROOT, "modules", module, "register_types.cpp"), encoding="utf-8") as file:
            ranks = [int(rank) for rank in re.findall(r"default_rank\s*=\s*(\d+)", file.read())]
        best = max(best, (max(ranks, default=0), module, min(ids, default="")))
    if not best[1]:
        raise SystemExit("ERROR: no technique has a default_rank; this test needs one.")
    return best[1], best[2]


def list_options(technique_module):
    """Return (enabled modules, scons options that disable all but the engine and one technique)."""
    enabled = ENGINE + (technique_module,)
    names = [module.name for module in modules_builders.find_modules(os.path.join(ROOT, "modules"))]
    return enabled, ["module_%s_enabled=no" % name for name in names if name not in enabled]


def run(command, folder):
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=3600)


class Results:
    """Counts checks. Prints those that fail, with the end of the program's output."""

    def __init__(self):
        self.passed = 0
        self.failed = 0

    def check(self, is_good, what, output=""):
        self.passed += bool(is_good)
        self.failed += not is_good
        if not is_good:
            print("FAILED: minimal build: %s" % what)
            print("\n".join("    " + line for line in output.splitlines()[-20:]), flush=True)
        return is_good


def check_plan(results):
    """Check that the program's dependency tree has only files of the enabled modules, headers included."""
    module, _ = find_default_technique()
    enabled, options = list_options(module)
    command = ["scons", "-n", "-Q", "compiledb=no", "tests=no", "--tree=all,prune", PROGRAM]
    planned = run(command + options, ROOT)
    results.check(planned.returncode == 0, "scons plans it", planned.stdout + planned.stderr)

    def find_modules(text):
        return set(re.findall(r"(?<![\w/.])(?:build/\w+/)?modules/(\w+)/", text))

    used = find_modules(planned.stdout)
    results.check(used == set(enabled), "its modules are %s, expected %s" % (sorted(used), sorted(enabled)))
    # Canary: the full program has more modules, and the same query finds them.
    whole = find_modules(run(command, ROOT).stdout)
    results.check(whole > set(enabled) and "editor" in whole, "the whole program has more modules, found %s" % sorted(whole))


def check_partial_plans(results):
    """Check that scons plans no file of a disabled module."""
    for modules in sorted({modules for modules, *_ in PARTIAL_BUILDS}):
        command = ["scons", "-n", "-Q", "compiledb=no", "tests=no", "--tree=all,prune", PROGRAM]
        planned = run(command + ["module_%s_enabled=no" % module for module in modules], ROOT)
        output = planned.stdout + planned.stderr
        results.check(planned.returncode == 0, "scons plans it without %s" % ", ".join(modules), output)
        for module in modules:
            found = re.search(r"(?m)^.*modules/%s/.*$" % module, planned.stdout)
            results.check(not found, "nothing of %s is in it" % module, found.group() if found else "")


def check_partial_programs(target, jobs, results):
    """Build each of PARTIAL_BUILDS in the folder `target`, and check what works and what is refused."""
    for modules, refused, named, working in PARTIAL_BUILDS:
        print("minimal: build without %s" % ", ".join(modules), flush=True)
        built = build(target, jobs, ["module_%s_enabled=no" % module for module in modules])
        if not results.check(built.returncode == 0, "it builds without %s" % ", ".join(modules), built.stdout + built.stderr):
            continue
        if "mask.exr" in working:
            technique = find_default_technique()[1]
            drawn = run([PROGRAM, "visibility", SCENE, "--technique", technique, "--out", "mask.exr"], target)
            results.check(drawn.returncode == 0, "visibility works without %s" % ", ".join(modules), drawn.stderr)
        done = run([PROGRAM, *working], target)
        results.check(done.returncode == 0, "`%s` works" % " ".join(working), done.stderr)
        if working == SMALL_REPORT:
            with open(os.path.join(target, "report", "report.json"), encoding="utf-8") as file:
                results.check("stability" not in json.load(file), "a report has no stability part")
        absent = run([PROGRAM, *refused], target)
        results.check(
            absent.returncode == 2 and "module_%s_enabled=yes" % named in absent.stderr,
            "`%s` names the module %s" % (" ".join(refused), named),
            absent.stderr,
        )


def build(target, jobs, options):
    return run(["scons", "-Q", "-j%d" % jobs, "compiledb=no", "tests=no", PROGRAM] + options, target)


def get_stripped_size(program, folder):
    stripped = os.path.join(folder, "stripped")
    subprocess.run(["strip", "-o", stripped, program], check=True)
    return os.path.getsize(stripped)


def check_program(target, technique, results):
    """Check the smallest game: it draws with its technique, and refuses what its disabled modules would do."""
    image = os.path.join(target, "image.png")
    arguments = ["run", SCENE, "--headless", "--size", "64x64", "--capture", image, "--plan"]
    drawn = run([PROGRAM] + arguments, target)
    # A PNG of this size in one colour has about 200 bytes.
    results.check(drawn.returncode == 0 and os.path.getsize(image) > 500, "it draws a scene", drawn.stdout + drawn.stderr)
    results.check("resolve: runs" in drawn.stdout, "its technique runs", drawn.stdout)
    listed = run([PROGRAM, "techniques"], target).stdout
    results.check(re.findall(r"(?m)^(\w+)(?: \(default\))?$", listed)[:1] == [technique], "it has one technique", listed)
    for command, module in ABSENT_COMMANDS.items():
        absent = run([PROGRAM, command, SCENE], target)
        results.check(
            absent.returncode == 2 and "module_%s_enabled=yes" % module in absent.stderr,
            "`%s` names the module %s" % (command, module),
            absent.stderr,
        )
    windowed = run([PROGRAM, "run", SCENE], target)
    results.check(windowed.returncode == 1 and "--headless" in windowed.stderr, "a window is refused", windowed.stderr)
    libraries = run(["ldd", PROGRAM], target).stdout
    for name in ("glfw", "OpenEXR", "embree"):
        results.check(name not in libraries, "it does not load %s" % name, libraries)


def count_libraries(program, folder):
    return len(run(["ldd", program], folder).stdout.splitlines())


def write_sizes(rows):
    lines = ["| build | modules | program | without debug symbols | shared libraries |", "|---|---|---|---|---|"]
    for name, module_count, size, stripped, libraries in rows:
        lines.append("| %s | %d | %.1f MB | %.2f MB | %d |" % (name, module_count, size / 1e6, stripped / 1e6, libraries))
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    pattern = re.compile(r"(<!-- begin sizes -->\n).*?(<!-- end sizes -->)", re.DOTALL)
    if not pattern.search(text):
        raise SystemExit("ERROR: %s has no table of sizes." % PAGE)
    text = pattern.sub(lambda match: match.group(1) + "\n".join(lines) + "\n" + match.group(2), text)
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(text)


def check_build(results, jobs, writes_sizes):
    module, technique = find_default_technique()
    enabled, options = list_options(module)
    with tempfile.TemporaryDirectory() as target:
        test_removal.copy_tree(target)
        if not writes_sizes:
            # First, because these programs reuse objects that are built already.
            check_partial_programs(target, jobs, results)
        print("minimal: build", flush=True)
        # Objects of other builds stay in the folder. The program is linked only from those that it needs.
        built = build(target, jobs, options)
        if not results.check(built.returncode == 0, "it builds", built.stdout + built.stderr):
            return
        check_program(target, technique, results)
        if not writes_sizes:
            return
        program = os.path.join(target, PROGRAM)
        rows = [("a game", len(enabled), os.path.getsize(program), get_stripped_size(program, target))]
        rows[0] += (count_libraries(program, target),)
        whole = os.path.join(ROOT, PROGRAM)
        all_modules = modules_builders.find_modules(os.path.join(ROOT, "modules"))
        sizes = os.path.getsize(whole), get_stripped_size(whole, target)
        rows.insert(0, ("everything", len(all_modules), *sizes, count_libraries(whole, target)))
        write_sizes(rows)
        print("wrote the sizes into %s" % PAGE)


def main():
    parser = argparse.ArgumentParser(description="Tests builds with disabled modules.")
    parser.add_argument("--plan", action="store_true", help="compile nothing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="build jobs (default: one per core)")
    parser.add_argument("--write-sizes", action="store_true", help="write the table of sizes in doc/getting_started.md")
    arguments = parser.parse_args()
    if shutil.which("scons") is None:
        raise SystemExit("ERROR: scons is missing. Install it, or run tests/run_tests.sh, which does.")
    results = Results()
    if arguments.plan:
        check_plan(results)
        check_partial_plans(results)
    else:
        check_build(results, arguments.jobs, arguments.write_sizes)
    print("%d passed, %d failed, 0 skipped" % (results.passed, results.failed))
    return 1 if results.failed else 0


if __name__ == "__main__":
    sys.exit(main())
