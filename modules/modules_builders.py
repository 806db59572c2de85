"""Finds modules, orders them by dependency, and generates the code that registers them.

A module is a folder with register_types.h, SCsub and config.py. One that registers something has a
register_types.cpp too, with initialize_<name>_module and uninitialize_<name>_module. config.py defines:
    get_dependencies() -> list of module names        (required)
    get_layer() -> int                                 (required; dependencies have a lower layer)
    get_description() -> str                           (required; one line, shown to users)
    can_build(env) -> bool, configure(env)             (optional; libraries go into env here)
    get_include_folders(env) -> list of folders        (optional; of third-party headers, for this module and its tests)
    get_source() -> str, get_doc() -> str              (optional; where it comes from, its doc page)
    can_disable() -> bool                              (optional; while the program runs; default: layer 4 and up)
    is_example() -> bool                               (optional; default False; an example to copy, which lists for users omit)
    is_enabled() -> bool                               (optional; built by default)
    get_optional_dependencies() -> list of module names (optional; used only where they are built)
    get_report_options() -> list of options            (optional; of `gnomon report`, which need the module: see ReportPart)
    is_program() -> bool                               (optional; linked into the program or the add-on, but not into tests)
    get_hosts() -> some of "program" and "godot"       (optional; what it is built for; default: both)
    get_systems() -> some of "linux" and "windows"     (optional; what it is built for; default: both)
"""

import hashlib
import importlib.util
import os
import re

VERSION = "0.1.0"  # of all modules, shown to users
REQUIRED_FILES = ("register_types.h", "SCsub", "config.py")
ALONE = "// build: alone"  # first line of files that are not compiled together with others, see list_batches()
BATCH_LINES = 2000


class Module:
    """One module folder and what its config.py defines."""

    def __init__(self, name, folder):
        spec = importlib.util.spec_from_file_location("config_" + name, os.path.join(folder, "config.py"))
        config = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(config)
        self.name = name
        self.folder = folder
        self.config = config
        self.dependencies = list(config.get_dependencies())
        self.optional_dependencies = list(getattr(config, "get_optional_dependencies", lambda: [])())
        self.report_options = list(getattr(config, "get_report_options", lambda: [])())
        self.layer = config.get_layer()
        self.description = config.get_description()
        self.enabled_by_default = getattr(config, "is_enabled", lambda: True)()
        self.source = getattr(config, "get_source", lambda: "")()
        self.doc = getattr(config, "get_doc", lambda: "")()
        self.has_registration = os.path.isfile(os.path.join(folder, "register_types.cpp"))
        self.is_program = getattr(config, "is_program", lambda: False)()
        self.hosts = getattr(config, "get_hosts", lambda: ("program", "godot"))()
        self.systems = getattr(config, "get_systems", lambda: ("linux", "windows"))()
        self.is_example = getattr(config, "is_example", lambda: False)()
        self.can_disable = getattr(config, "can_disable", lambda: self.layer >= 4)()


def find_modules(modules_folder):
    """Return all modules, dependencies first. Exits if a dependency is not in a lower layer. Missing ones are left to select_modules()."""
    found = {}
    for name in sorted(os.listdir(modules_folder)):
        folder = os.path.join(modules_folder, name)
        if all(os.path.isfile(os.path.join(folder, file)) for file in REQUIRED_FILES):
            found[name] = Module(name, folder)
    for module in found.values():
        for dependency in module.dependencies + module.optional_dependencies:
            if dependency not in found:
                continue  # reported by select_modules, where it may turn out not to matter
            if found[dependency].layer >= module.layer:
                raise SystemExit(
                    "ERROR: modules/%s/config.py: layer %d depends on %s of layer %d; dependencies"
                    " must have a lower layer." % (module.name, module.layer, dependency, found[dependency].layer)
                )
    return sorted(found.values(), key=lambda module: (module.layer, module.name))


def select_modules(modules, env):
    """Return the modules to build: those that are enabled, for this host, and can be built here. If
    a dependency is missing, exits with an error that names it and the module; in a build for Godot
    the module is skipped instead."""
    selected = []
    names = set()
    for module in modules:
        if not env["module_%s_enabled" % module.name]:
            continue
        missing = [name for name in module.dependencies if name not in names]
        if ("godot" if env["godot"] else "program") not in module.hosts or (env["godot"] and missing):
            continue  # not for this host, or it depends on a module that is not
        if env["TARGET_PLATFORM"].system not in module.systems:
            continue
        if missing:
            raise SystemExit(
                "ERROR: module %s needs %s, which is not built. Enable it, or set module_%s_enabled=no."
                % (module.name, ", ".join(missing), module.name)
            )
        if not getattr(module.config, "can_build", lambda env: True)(env):
            print("Module %s is disabled: it cannot be built here." % module.name)
            continue
        names.add(module.name)
        selected.append(module)
    return selected


def find_missing_modules(path, modules):
    """Return the names of modules that a test includes, directly or through headers of tests/, and that this build lacks."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    built = {module.name for module in modules}
    missing, seen, waiting = set(), set(), [path]
    while waiting:
        current = waiting.pop()
        if current in seen or not os.path.isfile(current):
            continue
        seen.add(current)
        with open(current, encoding="utf-8") as file:
            included = re.findall(r'^\s*#\s*include\s+"([^"]+)"', file.read(), re.MULTILINE)
        for name in included:
            if name.startswith("tests/"):
                waiting.append(os.path.join(root, name))
            # The last condition excludes headers that are in no module, such as modules/pch.h.
            elif name.startswith("modules/") and name.split("/")[1] not in built and "/" in name[8:]:
                missing.add(name.split("/")[1])
    return missing


def _quote(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def write_registration(target, source, env):
    """Generates register_module_types.<host>.gen.cpp: register_modules() adds all modules except programs to ModuleRegistry."""
    modules = [module for module in env["GNOMON_MODULES"] if not module.is_program]
    lines = ["// Generated by modules/modules_builders.py.", '#include "modules/core/module_registry.h"', ""]
    for module in modules:
        if module.has_registration:
            lines.append('#include "modules/%s/register_types.h"' % module.name)
    lines += ["", "namespace gnomon {", "", "void register_modules() {"]
    for module in modules:
        dependencies = ", ".join(_quote(name) for name in module.dependencies)
        functions = "initialize_{0}_module, uninitialize_{0}_module" if module.has_registration else "nullptr, nullptr"
        lines.append(
            "\tModuleRegistry::add({ %s, %s, %s, %s, %s, %d, %s, %s, { %s }, %s });"
            % (
                _quote(module.name),
                _quote(module.description),
                _quote(module.source),
                _quote(VERSION),
                _quote(module.doc),
                module.layer,
                "true" if module.can_disable else "false",
                "true" if module.is_example else "false",
                dependencies,
                functions.format(module.name),
            )
        )
    lines += ["}", "", "} // namespace gnomon", ""]
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


def format_bytes(name, data):
    """Return lines of C++ that define `const unsigned char NAME[]`: the data and a final 0."""
    lines = ["const unsigned char %s[] = {" % name]
    lines += ["\t" + ",".join(map(str, data[start : start + 32])) + "," for start in range(0, len(data), 32)]
    return [*lines, "\t0 };"]


def add_page_files(env, header, function, objects):
    """Embeds the files of the module's folders page/ and page/third_party, and appends the object to `objects`. `header` declares
    `function`, which is generated and returns them as std::span<const PageFile>, sorted by name (modules/error_report/page_files.h)."""
    from SCons.Script import Action  # not env.Action, which would expand $TARGET at once

    files = sorted(env.Glob("page/*.*") + env.Glob("page/third_party/*.*"), key=lambda node: node.srcnode().path)
    root = env.Dir("page").srcnode().abspath
    names = [os.path.relpath(node.srcnode().abspath, root) for node in files]
    generated = env.Command(
        "embedded/page_files.gen.cpp",
        [env.Value((header, function, names)), *files],
        Action(_write_page_files, "Embedding pages in $TARGET"),
    )
    env.Depends(generated, "#modules/modules_builders.py")
    env.add_sources(generated, objects)


def _write_page_files(target, source, env):
    header, function, names = source[0].read()
    lines = ['#include "%s"' % header, "", "namespace gnomon {", "namespace {"]
    rows = []
    for index, (name, node) in enumerate(zip(names, source[1:])):
        with open(node.srcnode().abspath, "rb") as file:
            data = file.read()
        lines += format_bytes("FILE_%d" % index, data)
        rows.append('\t{ "%s", { reinterpret_cast<const char *>(FILE_%d), %d } },' % (name, index, len(data)))
    lines += ["const PageFile FILES[] = {", *rows, "};", "} // namespace", ""]
    lines += ["std::span<const PageFile> %s {" % function, "\treturn FILES;", "}", "", "} // namespace gnomon", ""]
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


def add_builders(env, modules):
    """Calls each module's configure(), and adds the precompiled header and the method add_sources() to env."""
    env["GNOMON_MODULES"] = modules
    for module in modules:
        getattr(module.config, "configure", lambda env: None)(env)

    add_precompiled_header(env, "pch")
    env.AddMethod(add_sources, "add_sources")


def add_sources(env, pattern_or_files, objects):
    """Compiles the files (glob pattern or list) and appends their objects to `objects`. With unity=yes, several files are compiled
    as one, see list_batches()."""
    sources = env.Glob(pattern_or_files) if isinstance(pattern_or_files, str) else pattern_or_files
    sources = [item for item in map(env.File, env.Flatten(sources)) if env["TARGET_PLATFORM"].is_compiled(str(item))]
    for batch in list_batches(sources) if env["unity"] else [[item] for item in sources]:
        source = batch[0] if len(batch) == 1 else _add_batch(env, batch)
        made = env.Object(source)
        env.Depends(made, env["PRECOMPILED"])
        objects.extend(made)
        if env["compiledb"] and len(batch) > 1:
            env.Object(batch)  # each file in compile_commands.json; not linked, therefore not compiled


def list_batches(sources):
    """Divide source files into those that are compiled as one: neighbours in the listing of their folder with about BATCH_LINES in
    all. Headers are then read once for all. Files whose first line is ALONE, those for one system and generated files are batches
    of their own. A batch depends on its folder only, not on the other sources, so that the program and the add-on share objects."""
    batches = {}
    divided = {}
    for source in sources:
        path = source.srcnode().abspath
        folder = os.path.dirname(path)
        if folder not in divided:
            divided[folder] = _divide_folder(folder)
        batches.setdefault((folder, divided[folder].get(path, path)), []).append(source)
    return list(batches.values())


def _divide_folder(folder):
    """Return {path: number of its batch} of the C++ files of a folder."""
    batches = {}
    number, lines = 0, 0
    for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else ():
        path = os.path.join(folder, name)
        if not name.endswith(".cpp"):
            continue
        with open(path, encoding="utf-8") as file:
            text = file.read()
        if text.startswith(ALONE) or name.endswith(("_posix.cpp", "_windows.cpp")):  # their system headers define many names
            continue
        if lines > BATCH_LINES:
            number, lines = number + 1, 0
        lines += text.count("\n")
        batches[path] = number
    return batches


def _add_batch(env, batch):
    """Add a generated file that includes the files of a batch. Its name has a hash of them, because another build may have fewer."""
    root = env.Dir("#").abspath
    paths = [os.path.relpath(source.srcnode().abspath, root) for source in batch]
    text = "".join('#include "%s"\n' % path for path in paths)
    first = os.path.splitext(os.path.basename(paths[0]))[0]
    name = "%s_and_%d_more.%s.gen.cpp" % (first, len(batch) - 1, hashlib.sha256(text.encode()).hexdigest()[:6])
    folder = os.path.join(env["BUILD_FOLDER"], os.path.dirname(paths[0]), "batches")  # not where SCsub files look for sources
    return env.Command(os.path.join(folder, name), env.Value(text), env.Action(_write_text, None))


def _write_text(target, source, env):
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write(source[0].get_text_contents())


def add_precompiled_header(env, folder):
    """Compiles modules/pch.h with the flags of env into a folder of the build. add_sources() makes objects depend on it."""
    from SCons.Script import Action  # not env.Action, which would expand $SOURCE at once

    copy = env["BUILD_FOLDER"] + "/" + folder + "/pch.h"
    header = env.Command(copy, "#modules/pch.h", [lambda target, source, env: _copy(target, source)])
    env["PRECOMPILED"] = env.Command(
        copy + ".gch",
        header,
        Action("$CXX -x c++-header $CXXFLAGS $CCFLAGS $_CCCOMCOM -o $TARGET $SOURCE", "Precompiling $SOURCE"),
    )
    env.Depends(env["PRECOMPILED"], [copy, *env["THIRD_PARTY"]])
    # Relative, so that a copy of the tree with its build folder rebuilds nothing (tests/removal).
    env["PRECOMPILED_PATH"] = env.File(copy).path


def use_precompiled_header(env):
    """Return a clone of env whose C++ files begin with the precompiled header."""
    clone = env.Clone()
    clone.Append(CXXFLAGS=["-include", env["PRECOMPILED_PATH"], "-Winvalid-pch"])
    return clone


def use_module(env, module):
    """Return a clone of env with the module's folders of third-party headers, or env itself if it has none."""
    folders = getattr(module.config, "get_include_folders", lambda env: [])(env)
    # As system folders, so that third-party headers cause no warnings.
    return env.Clone(CCFLAGS=env["CCFLAGS"] + [("-isystem", folder) for folder in folders]) if folders else env


OPTIMISED = "// build: optimised"


def make_test_environment(env):
    """Return a clone of env for tests, with the method add_test_sources(). Tests are compiled without optimisation, which would
    take longer than it saves. The exception are tests that compute much: their first line is OPTIMISED.
    """
    plain = env.Clone(CCFLAGS=["-O0" if flag == "-O2" else flag for flag in env["CCFLAGS"]])
    if "-O2" in env["CCFLAGS"]:
        add_precompiled_header(plain, "pch_tests")
    clone = use_precompiled_header(plain)

    def add_test_sources(self, files, objects):
        sources = [self.File(item) for item in (self.Glob(files) if isinstance(files, str) else files)]
        optimised = [source for source in sources if _read_first_line(source) == OPTIMISED]
        self.add_sources([source for source in sources if source not in optimised], objects)
        if optimised:
            compiler = use_precompiled_header(env)
            compiler.Append(CCFLAGS=self["CCFLAGS"][len(plain["CCFLAGS"]) :])  # what use_module added
            compiler.add_sources(optimised, objects)

    clone.AddMethod(add_test_sources, "add_test_sources")
    return clone


def _read_first_line(source):
    with open(source.srcnode().abspath, encoding="utf-8") as file:
        return file.readline().strip()


def _copy(target, source):
    with open(str(source[0]), "rb") as read, open(str(target[0]), "wb") as written:
        written.write(read.read())
