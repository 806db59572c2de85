#!/usr/bin/env python3
"""Rules of doc/coding_style.md on folders, includes and names. Reads files only; no compiler.

    test_layers.py [--root DIR]    checks the tree; one line for each breach
    test_layers.py --self-test     breaks every rule in copies of a small tree and checks that it is noticed

The last line is "N passed, N failed, N skipped", a count of rules, or with --self-test of trees.
"""

import argparse
import fnmatch
import importlib.util
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOP_LEVEL = {"SConstruct", "modules", "shaders", "demo_project", "tests", "doc", "README.md", "LICENSE"}
# A folder below modules/ with these files is a module.
MODULE_FILES = ("register_types.h", "SCsub", "config.py")
CPP = (".h", ".cpp")
SHADERS = (".vert", ".frag", ".geom", ".comp", ".glsl")
SOURCES = CPP + SHADERS + (".py", ".sh")
PROJECT_FOLDERS = ("modules/", "shaders/", "tests/", "demo_project/", "doc/")
# Where a technique may be named, apart from its own module and shader folder.
TECHNIQUE_FOLDERS = ("tests/golden/", "tests/benchmark/", "tests/stability/", "tests/embed/", "tests/drivers/", "demo_project/", "doc/")
WINDOW_OWNERS = ("modules/desktop/", "modules/main/", "modules/editor/")
WITHOUT_DEVICE = ("scene", "mesh_tools")
BACKEND = re.compile(r"rendering_device_\w+")
BACKEND_USERS = ("desktop", "main", "godot_addon")  # may list a backend
NOTED_LINES, REFUSED_LINES = 400, 800
VAGUE_NAMES = re.compile(r"(^|_)(utils?|helpers?|misc|managers?)($|_)")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
# The first literal of a registration is the id.
REGISTRATION = re.compile(
    r"(?:(?:Shadow|MaskFilter)Registry::add\s*\(|ShadowTechniqueInfo|MaskFilterInfo)[\s\w=({]*?\"([a-z0-9_]+)\""
)
REGISTRY = re.compile(r"(?:Shadow|MaskFilter)Registry::add")
PRIVATE_TYPE = re.compile(r"(?:struct|class|enum class|enum|union) (\w+)")
PRIVATE_VALUE = re.compile(r"[\w:<>,&*\s]*?[\s*&>](\w+)(?:\(|\[| = |\{|;)")
CLASS_MADE = re.compile(r"make_unique<\s*(?:gnomon::)?([A-Z]\w+)\s*>")


class Tree:
    """The project's files (relative paths) and modules, read once."""

    def __init__(self, root):
        self.root = root
        self.files = sorted(self._list_files())
        self.texts = {}
        self.configs = {}
        for path in self.files:
            parts = path.split("/")
            if len(parts) == 3 and parts[0] == "modules" and parts[2] == "config.py":
                if all("modules/%s/%s" % (parts[1], name) in self.files for name in MODULE_FILES):
                    self.configs[parts[1]] = self._load_config(parts[1])

    def _list_files(self):
        if os.path.exists(os.path.join(self.root, ".git")):
            command = ["git", "-C", self.root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
            names = subprocess.run(command, capture_output=True, check=True).stdout.decode().split("\0")
            return {name for name in names if name and os.path.isfile(os.path.join(self.root, name))}
        # A copy of the tree that a test made has no .git.
        with open(os.path.join(self.root, ".gitignore"), encoding="utf-8") as file:
            ignored = [line.strip().strip("/") for line in file if line.strip() and not line.startswith("#")]
        found = set()
        for folder, folders, names in os.walk(self.root):
            relative = os.path.relpath(folder, self.root)
            prefix = "" if relative == "." else relative.replace(os.sep, "/") + "/"

            def is_not_ignored(name):
                return not any(fnmatch.fnmatch(prefix + name, p) or fnmatch.fnmatch(name, p) for p in ignored)

            folders[:] = [name for name in folders if is_not_ignored(name)]
            found.update(prefix + name for name in names if is_not_ignored(name))
        return found

    def _load_config(self, name):
        path = os.path.join(self.root, "modules", name, "config.py")
        spec = importlib.util.spec_from_file_location("config_" + name, path)
        config = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(config)
        optional = getattr(config, "get_optional_dependencies", lambda: [])
        return {
            "dependencies": list(config.get_dependencies()) + list(optional()),
            "layer": config.get_layer(),
            "hosts": getattr(config, "get_hosts", lambda: ("program", "godot"))(),
        }

    def get_text(self, path):
        if path not in self.texts:
            with open(os.path.join(self.root, path), encoding="utf-8", errors="replace") as file:
                self.texts[path] = file.read()
        return self.texts[path]

    def get_includes(self, path):
        """Return (line number, opening bracket or quote, included path) of each include."""
        text = self.get_text(path)
        return [(text.count("\n", 0, m.start()) + 1, m.group(1), m.group(2)) for m in INCLUDE.finditer(text)]

    def find_sources(self, suffixes, prefixes=PROJECT_FOLDERS):
        return [
            path
            for path in self.files
            if path.endswith(suffixes) and path.startswith(prefixes) and "/third_party/" not in path
        ]

    def get_module(self, path):
        parts = path.split("/")
        return parts[1] if parts[0] == "modules" and len(parts) > 2 else None

    def find_techniques(self):
        """Return module -> (ids, classes) for the modules whose register_types.cpp registers techniques or mask filters."""
        found = {}
        for name in self.configs:
            path = "modules/%s/register_types.cpp" % name
            if path not in self.files:
                continue
            ids = set(REGISTRATION.findall(self.get_text(path)))
            if REGISTRY.search(self.get_text(path)):
                found[name] = (ids, set(CLASS_MADE.findall(self.get_text(path))))
        return found


def is_generated(name):
    return ".gen." in name


def check_root_relative_includes(tree):
    """An include in quotes is written from the repository's root (shaders: from shaders/)."""
    for path in tree.find_sources(CPP, ("modules/", "tests/")):
        for line, bracket, name in tree.get_includes(path):
            if bracket == "<" or is_generated(name):
                continue
            if name in tree.files or "shaders/" + name in tree.files:
                continue
            yield "%s:%d: include %s is not a path from the repository's root" % (path, line, name)


def check_listed_dependencies(tree):
    """A module includes itself and the modules its config.py lists."""
    for path in tree.find_sources(CPP, ("modules/",)):
        module = tree.get_module(path)
        if module not in tree.configs:
            continue
        allowed = {module, *tree.configs[module]["dependencies"]}
        for line, _, name in tree.get_includes(path):
            included = tree.get_module(name)
            if included is not None and included not in allowed:
                yield "%s:%d: includes %s; modules/%s/config.py does not list %s" % (path, line, name, module, included)


def check_layers(tree):
    """A dependency has a lower layer, so that modules of layer 4 never depend on each other."""
    for name, config in tree.configs.items():
        for dependency in config["dependencies"]:
            if dependency not in tree.configs:
                yield "modules/%s/config.py: lists %s, which is not a module" % (name, dependency)
            elif tree.configs[dependency]["layer"] >= config["layer"]:
                yield "modules/%s/config.py: layer %d lists %s of layer %d" % (
                    name, config["layer"], dependency, tree.configs[dependency]["layer"])  # fmt: skip


def check_vulkan(tree):
    """Only rendering_device_vulkan includes Vulkan's headers.

    The owner of a window needs the handle types, so desktop may include vulkan_handles.h.
    """
    pattern = re.compile(r"(^|/)vulkan[^/]*\.hp*$|^vulkan/")
    for path in tree.find_sources(CPP):
        for line, _, name in tree.get_includes(path):
            if name == "modules/rendering_device_vulkan/vulkan_handles.h" and path.startswith("modules/desktop/"):
                continue
            if pattern.search(name) and not path.startswith("modules/rendering_device_vulkan/"):
                yield "%s:%d: includes %s; only rendering_device_vulkan may" % (path, line, name)


def check_godot(tree):
    """Only the Godot backend and the add-on include Godot's interface and the headers generated from it."""
    users = ("modules/rendering_device_godot/", "modules/godot_addon/")
    for path in tree.find_sources(CPP, ("modules/",)):
        for line, _, name in tree.get_includes(path):
            if re.search(r"(^|/)(gdextension_interface\.h|godot_\w+\.gen\.h)$", name) and not path.startswith(users):
                yield "%s:%d: includes %s; only %s may" % (path, line, name, " and ".join(users))


def check_backends(tree):
    """A backend of rendering_device is chosen by the linker: no other module includes or lists it.

    desktop may include it, because a window presents images of one backend. main may list it, so that a build without it is
    refused, but not include it. The add-on may do both, because it passes on the device of its host.
    """
    for path in tree.find_sources(CPP, ("modules/",)):
        module = tree.get_module(path)
        for line, _, name in tree.get_includes(path):
            included = tree.get_module(name)
            if included and BACKEND.fullmatch(included) and module not in (included, "desktop", "godot_addon"):
                yield "%s:%d: includes %s; only desktop and godot_addon may" % (path, line, name)
    for name, config in tree.configs.items():
        for dependency in config["dependencies"]:
            if BACKEND.fullmatch(dependency) and name not in BACKEND_USERS:
                yield "modules/%s/config.py: lists %s; only %s may" % (name, dependency, " and ".join(BACKEND_USERS))


def check_system_headers(tree):
    """windows.h is included by files for Windows only, without the parts that define names such as ERROR."""
    for path in tree.find_sources(CPP):
        for line, _, name in tree.get_includes(path):
            if name.lower() != "windows.h":
                continue
            if not path.endswith("_windows.cpp"):
                yield "%s:%d: includes %s; only files named *_windows.cpp may" % (path, line, name)
            elif not all("#define " + macro in tree.get_text(path) for macro in ("WIN32_LEAN_AND_MEAN", "NOGDI")):
                yield "%s:%d: define WIN32_LEAN_AND_MEAN and NOGDI before windows.h" % (path, line)


def check_thread_locals(tree):
    """The add-on's modules have no thread_local: on Windows, a destructor crashes where a thread outlives the library."""
    for path in tree.find_sources(CPP, ("modules/",)):
        module = tree.get_module(path)
        if "/tests/" in path or "godot" not in tree.configs.get(module, {}).get("hosts", ()):
            continue
        for number, line in enumerate(tree.get_text(path).splitlines(), 1):
            if re.search(r"\bthread_local\b", line.split("//")[0]):
                yield "%s:%d: thread_local in a module that is built for Godot" % (path, number)


def list_private_names(text):
    """Return the names that a .cpp file declares in anonymous namespaces."""
    names = set()
    is_private = False
    for line in text.splitlines():
        if line == "namespace {":
            is_private = True
        elif line.startswith("} // namespace"):
            is_private = False
        elif is_private and line[:1].isalpha() and not line.startswith("using "):
            found = PRIVATE_TYPE.match(line) or PRIVATE_VALUE.match(line)
            if found:
                names.add(found.group(1))
    return names


def check_private_names(tree):
    """Files of a folder, which may be compiled as one, declare no name twice in anonymous namespaces. The compiler would notice most,
    but of two functions with other parameters it might call the wrong one."""
    owners = {}
    for path in tree.find_sources((".cpp",), ("modules/", "tests/")):
        for name in sorted(list_private_names(tree.get_text(path))):
            first = owners.setdefault((os.path.dirname(path), name), path)
            if first != path:
                yield "%s: %s is declared in %s too; give it a name of its own or share it in a header" % (path, name, first)


def check_test_headers(tree):
    """Only tests include headers in a tests folder, such as those that give tests access to a device."""
    for path in tree.find_sources(CPP):
        if path.startswith("tests/") or "/tests/" in path:
            continue
        for line, _, name in tree.get_includes(path):
            if name.startswith("tests/") or "/tests/" in name:
                yield "%s:%d: includes %s; only tests may" % (path, line, name)


def check_window_library(tree):
    """Only desktop, main and editor may include GLFW: for the window and its key codes."""
    for path in tree.find_sources(CPP):
        for line, _, name in tree.get_includes(path):
            if re.search(r"GLFW|glfw", name) and not path.startswith(WINDOW_OWNERS):
                yield "%s:%d: includes %s; only desktop, main and editor may" % (path, line, name)


def check_modules_without_device(tree):
    """scene and mesh_tools do not depend on rendering_device, so their tests need no GPU."""
    for name in WITHOUT_DEVICE:
        reached, waiting = set(), [name]
        while waiting:
            current = waiting.pop()
            if current in reached or current not in tree.configs:
                continue
            reached.add(current)
            waiting += tree.configs[current]["dependencies"]
        if "rendering_device" in reached:
            yield "modules/%s/config.py: depends on rendering_device" % name


def check_registration_is_readable(tree):
    """register_types.cpp writes ids as literals, so that check_technique_names finds them."""
    for module, (ids, classes) in tree.find_techniques().items():
        if not ids or not classes:
            yield 'modules/%s/register_types.cpp: write ShadowRegistry::add({ "id", ... make_unique<Class>' % module


def check_technique_names(tree):
    """The id and class of a technique or mask filter occur only in its module, its shaders, and TECHNIQUE_FOLDERS."""
    techniques = tree.find_techniques()
    checked_endings = SOURCES + ("SCsub", "SConstruct", ".json", ".cfg", ".html")
    for path in tree.files:
        is_project = path.startswith(PROJECT_FOLDERS) or path == "SConstruct"
        if not is_project or not path.endswith(checked_endings) or path.startswith(TECHNIQUE_FOLDERS):
            continue
        for module, (ids, classes) in techniques.items():
            if path.startswith(("modules/%s/" % module, "shaders/%s/" % module)):
                continue
            for number, line in enumerate(tree.get_text(path).splitlines(), 1):
                code = line.split("//")[0] if path.endswith(CPP) else ""
                for name in sorted(ids):
                    # A plain word is a technique's id only when it is alone in quotes; an id
                    # with an underscore also begins the names of its properties.
                    ending = r"(_\w+)?" if "_" in name else ""
                    if re.search(r"[\"']%s%s[\"']" % (name, ending), line):
                        yield '%s:%d: names technique "%s" of module %s' % (path, number, name, module)
                for name in sorted(classes):
                    # A class of one plain word may be that word in comments and shaders.
                    is_word = len(re.findall("[A-Z]", name)) == 1
                    if re.search(r"\b%s\b" % name, code if is_word else line):
                        yield "%s:%d: names class %s of module %s" % (path, number, name, module)


def check_shader_includes(tree):
    """A shader includes its own folder, common/ and shared/."""
    for path in tree.find_sources(SHADERS + (".h",), ("shaders/",)):
        own = path.split("/")[1]
        for line, bracket, name in tree.get_includes(path):
            if bracket == "<" and not any(file.startswith("shaders/%s/" % name.split("/")[0]) for file in tree.files):
                continue  # the standard library and GLM, in headers that C++ reads too
            if name.split("/")[0] not in (own, "common", "shared"):
                yield "%s:%d: includes %s; allowed are %s/, common/ and shared/" % (path, line, name, own)
            elif "shaders/" + name not in tree.files:
                yield "%s:%d: includes %s, which is not below shaders/" % (path, line, name)


def check_file_names(tree):
    """No file is named utils, helpers, misc or manager: the name has no meaning."""
    for path in tree.find_sources(SOURCES):
        stem = os.path.basename(path).split(".")[0]
        if VAGUE_NAMES.search(stem):
            yield "%s: name the file after what it holds" % path


def check_file_lengths(tree):
    """No file is longer than 800 lines. A file of more than 400 lines gets a note."""
    for path in tree.find_sources(SOURCES):
        count = tree.get_text(path).count("\n")
        if count > REFUSED_LINES:
            yield "%s: %d lines, split it (at most %d)" % (path, count, REFUSED_LINES)
        elif count > NOTED_LINES:
            print("note: %s has %d lines; above %d, give a reason in the review" % (path, count, NOTED_LINES))


def check_top_level(tree):
    """The top level has only the entries of TOP_LEVEL, and hidden ones."""
    files = tree.files
    if os.path.exists(os.path.join(tree.root, ".git")):
        # Untracked files (a custom.py, notes) are the developer's own.
        command = ["git", "-C", tree.root, "ls-files", "-z"]
        files = subprocess.run(command, capture_output=True, check=True).stdout.decode().split("\0")
    for name in sorted({path.split("/")[0] for path in files if path}):
        if name not in TOP_LEVEL and not name.startswith("."):
            yield "%s: is not in TOP_LEVEL of test_layers.py; move it into one of its folders" % name


RULES = (
    check_root_relative_includes,
    check_listed_dependencies,
    check_layers,
    check_vulkan,
    check_godot,
    check_backends,
    check_system_headers,
    check_thread_locals,
    check_private_names,
    check_test_headers,
    check_window_library,
    check_modules_without_device,
    check_registration_is_readable,
    check_technique_names,
    check_shader_includes,
    check_file_names,
    check_file_lengths,
    check_top_level,
)


def find_breaches(root):
    """Return rule name -> its breaches."""
    tree = Tree(root)
    if not tree.configs:
        raise SystemExit("ERROR: %s: no modules found below modules/" % root)
    return {rule.__name__: list(rule(tree)) for rule in RULES}


def main():
    parser = argparse.ArgumentParser(description="Checks the rules on folders, includes and names.")
    parser.add_argument("--root", default=ROOT, help="tree to check")
    parser.add_argument("--self-test", action="store_true", help="check that every rule notices a breach")
    arguments = parser.parse_args()
    sys.dont_write_bytecode = True
    if arguments.self_test:
        import breaches

        passed, failed = breaches.run_self_test(RULES, find_breaches)
    else:
        results = find_breaches(arguments.root)
        for name, lines in results.items():
            for line in lines:
                print("FAILED: %s: %s" % (name, line))
        failed = sum(1 for lines in results.values() if lines)
        passed = len(results) - failed
    print("%d passed, %d failed, 0 skipped" % (passed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
