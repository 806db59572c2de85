"""Compiles GLSL to SPIR-V at build time, and embeds the SPIR-V in one C++ file.

An entry point is `<what>.<stage>`; include paths start at shaders/. Errors show the GLSL file and
line, as glslangValidator prints them.

An entry point that has `#ifdef VARIANT_<NAME>`, itself or in a file that it includes, is compiled once
more with that macro defined, as `<what>.<name>.<stage>`. At run time compile_shader does the same.
"""

import glob
import os
import re
import struct
import subprocess

import spirv_phis
from SCons.Script import Action

STAGES = ("vert", "frag", "geom", "comp")
# glslang calls every function and leaves every variable in memory. With these passes of spirv-opt lavapipe creates pipelines in half
# the time. With all of -O (SPIRV-Tools 2023.1) the masks of edge_count and the culling of shadow_volume are wrong.
# --scalar-replacement=0 (no limit) comes before --ssa-rewrite, which would otherwise make phis of structures (see spirv_phis.py);
# --simplify-instructions then removes the composites that this leaves, a third of the code.
# The shaders of the Godot add-on stay as they are: Godot 4.6 has an optimizer of its own, after which lavapipe refuses some of these.
OPTIMIZER_PASSES = (
    "--inline-entry-points-exhaustive",
    "--eliminate-dead-functions",
    "--scalar-replacement=0",
    "--convert-local-access-chains",
    "--eliminate-local-single-block",
    "--eliminate-local-single-store",
    "--ssa-rewrite",
    "--simplify-instructions",
    "--eliminate-dead-code-aggressive",
)
_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
_VARIANT = re.compile(r"^\s*#\s*if.*\bVARIANT_([A-Z]+)\b", re.MULTILINE)


def _scan(node, env, path):
    """Return the files that a shader includes, for SCons. Include paths start at shaders/."""
    if not os.path.exists(node.srcnode().abspath):
        return []
    with open(node.srcnode().abspath, encoding="utf-8") as file:
        return [env.File("#shaders/" + name) for name in _INCLUDE.findall(file.read())]


def get_spirv_prefix(env):
    """Return the folder of SPIR-V within a build folder, "" or with a slash at its end. The add-on has
    its own, because its SPIR-V is not optimised."""
    return "godot/" if env["godot"] else ""


def find_variants(folder, name):
    """Return the sorted names of an entry point's variants, in lower case. folder: shaders/. name: path of the entry point in it."""
    found, seen, waiting = set(), set(), [name]
    while waiting:
        path = os.path.join(folder, waiting.pop())
        if path in seen or not os.path.exists(path):
            continue
        seen.add(path)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        found.update(variant.lower() for variant in _VARIANT.findall(text))
        waiting += _INCLUDE.findall(text)
    return sorted(found)


def _embed(target, source, env):
    """Writes a C++ file with a table for find_embedded_shader: name (folder/file) -> SPIR-V words.

    env["SHADER_FUNCTION"]: name of the C++ function that returns the table. env["SHADER_FOLDER"] replaces the folder in names.
    """
    lines = ['#include "modules/core/embedded_shaders.h"', "", "namespace gnomon {", "namespace {"]
    names = []
    for index, node in enumerate(source):
        path = str(node)
        folder, file = os.path.split(path)
        names.append((env.get("SHADER_FOLDER") or os.path.basename(folder)) + "/" + file[: -len(".spv")])
        with open(path, "rb") as binary:
            data = binary.read()
        words = struct.unpack("<%dI" % (len(data) // 4), data)
        lines.append("const uint32_t SHADER_%d[] = {" % index)
        for start in range(0, len(words), 12):
            lines.append("\t" + ", ".join("0x%08x" % word for word in words[start : start + 12]) + ",")
        lines.append("};")
    lines += ["const EmbeddedShader SHADERS[] = {"]
    for index, name in enumerate(names):
        lines.append('\t{ "%s", SHADER_%d },' % (name, index))
    function = env.get("SHADER_FUNCTION", "get_embedded_shaders")
    # The last entry is not part of the span: an array must not be empty.
    lines += ["\t{ {}, {} },", "};", "} // namespace", "", "std::span<const EmbeddedShader> %s();" % function, ""]
    lines += ["std::span<const EmbeddedShader> %s() {" % function]
    lines += ["\treturn std::span<const EmbeddedShader>(SHADERS, %d);" % len(names), "}", "", "} // namespace gnomon", ""]
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


def _optimize(target, source, env):
    """Optimises SPIR-V in place. Messages are shown on failure only: spirv-opt warns of each function
    that returns early, since it cannot inline it."""
    path = str(target[0])
    command = ["spirv-opt", *env["OPTIMIZER_PASSES"], "--target-env=vulkan1.1", "--preserve-bindings", "--preserve-spec-constants"]
    result = subprocess.run(command + [path, "-o", path], capture_output=True, encoding="utf-8", errors="replace")
    if result.returncode != 0:
        print("ERROR: spirv-opt cannot optimise %s:\n%s%s" % (path, result.stdout, result.stderr))
    return result.returncode


def _refuse_aggregate_phis(target, source, env):
    """Fails the build of SPIR-V with phis of structures or arrays."""
    path = str(target[0])
    count = spirv_phis.count_aggregate_phis(spirv_phis.load_words(path))
    if count > 0:
        print("ERROR: %s has %d OpPhi of a structure or array; must be 0. Change OPTIMIZER_PASSES." % (path, count))
    return int(count > 0)


def add_builders(env):
    """Adds the builders `Spirv` and `EmbeddedShaders`."""
    scanner = env.Scanner(function=_scan, skeys=["." + stage for stage in STAGES] + [".glsl", ".h"], recursive=True)
    # vulkan1.1 (SPIR-V 1.3) is the lowest target that has subgroup operations.
    command = "glslangValidator -V --quiet --target-env vulkan1.1 %s $SHADER_VARIANT -I%s -o $TARGET ${SOURCE.srcpath}" % (
        "-g" if env["dev_build"] else "-g0",
        env.Dir("#shaders").path,
    )
    actions = [Action(command, "Compiling shader $TARGET")]  # not env.Action: that expands $TARGET at once, to nothing
    if not env["dev_build"] and not env["godot"]:
        env["OPTIMIZER_PASSES"] = OPTIMIZER_PASSES
        # varlist: a change of the passes rebuilds the shaders.
        actions.append(Action(_optimize, None, varlist=["OPTIMIZER_PASSES"]))
    actions.append(Action(_refuse_aggregate_phis, None))
    env["BUILDERS"]["Spirv"] = env.Builder(action=actions, source_scanner=scanner)
    env["BUILDERS"]["EmbeddedShaders"] = env.Builder(action=Action(_embed, "Embedding shaders in $TARGET"))


def add_test_shaders(env, modules):
    """Return the node of the C++ file that embeds the shaders of tests: the files <what>.<stage> in tests/shaders and in the
    modules' tests. Their names in the table are tests/<what>.<stage>; get_test_shaders() returns the table.
    """
    build_folder = "#" + env["BUILD_FOLDER"].lstrip("#")
    spirv = []
    for source in ["tests/shaders"] + ["modules/%s/tests" % module.name for module in modules]:
        for path in sorted(glob.glob(os.path.join(env.Dir("#").abspath, source, "*"))):
            name = os.path.basename(path)
            if name.rpartition(".")[2] in STAGES:
                target = "%s/tests/shaders/%s%s.spv" % (build_folder, get_spirv_prefix(env), name)
                spirv += env.Spirv(target, "%s/%s/%s" % (build_folder, source, name))
    generated = env.EmbeddedShaders(
        "%s/tests/test_shaders.%s.gen.cpp" % (build_folder, env["HOST"]), spirv, SHADER_FUNCTION="get_test_shaders", SHADER_FOLDER="tests"
    )
    env.Depends(generated, env.Value([str(item) for item in spirv]))
    return generated
