"""A small source tree that follows every rule of test_layers.py, and changes that each break one rule."""

import os
import shutil
import tempfile

MODULE_CONFIG = "def get_dependencies():\n    return %r\n\n\ndef get_layer():\n    return %d\n\n\ndef get_description():\n    return ''\n"


def add_file(root, path, text):
    """Append the text to a file, which is created if it does not exist."""
    path = os.path.join(root, path)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "a", encoding="utf-8") as file:
        file.write(text)


def add_module(root, name, dependencies, layer):
    add_file(root, "modules/%s/config.py" % name, MODULE_CONFIG % (dependencies, layer))
    add_file(root, "modules/%s/SCsub" % name, "\n")
    add_file(root, "modules/%s/register_types.h" % name, "#pragma once\n")


def make_small_tree(root):
    """Make a tree that follows every rule. Each breach below is added to a copy of it."""
    add_module(root, "core", [], 0)
    add_module(root, "rendering_device", ["core"], 1)
    add_module(root, "rendering_device_vulkan", ["core", "rendering_device"], 2)
    add_module(root, "desktop", ["core", "rendering_device", "rendering_device_vulkan"], 3)
    add_module(root, "scene", ["core"], 1)
    add_module(root, "mesh_tools", ["core", "scene"], 2)
    add_module(root, "renderer", ["core", "rendering_device", "scene"], 3)
    add_module(root, "shadow_lamp", ["core", "renderer"], 4)
    add_module(root, "shadow_moon", ["core", "renderer"], 4)
    add_module(root, "editor", ["core"], 5)
    add_module(root, "main", ["core", "rendering_device_vulkan"], 6)
    for name, technique, made in (("lamp", "lamp_fan", "ShadowLamp"), ("moon", "moon", "Sun")):
        text = 'ShadowRegistry::add({ "%s", "x", [] { return std::make_unique<%s>(); } });\n' % (technique, made)
        add_file(root, "modules/shadow_%s/register_types.cpp" % name, text)
    add_file(root, "modules/scene/node.h", '#include "modules/core/register_types.h"\n#include <vector>\n')
    add_file(root, "modules/rendering_device/tests/testing.h", "#pragma once\n")
    add_file(root, "modules/rendering_device/tests/a.h", '#include "modules/rendering_device/tests/testing.h"\n')
    add_file(root, "modules/rendering_device_vulkan/device.cpp", "#include <vulkan/vulkan.h>\n")
    add_file(root, "modules/desktop/a.cpp", '#include "modules/rendering_device_vulkan/vulkan_handles.h"\n')
    add_file(root, "tests/a.h", '#include "modules/rendering_device/tests/testing.h"\n')
    add_file(root, "modules/main/window.cpp", "#include <GLFW/glfw3.h>\n")
    add_file(root, "modules/rendering_device_vulkan/vulkan_handles.h", "#include <vulkan/vulkan_core.h>\n")
    add_file(root, "shaders/common/depth_inc.glsl", "// moon, Sun and lamp_fan without quotes are words\n")
    add_file(root, "shaders/shared/shared_begin.h", "#include <cstdint>\n")
    add_file(root, "shaders/shadow_lamp/fan.frag", '#include "common/depth_inc.glsl"\n')
    add_file(root, "tests/golden/box/golden.json", '{ "lamp_fan": 1 }\n')
    add_file(root, "doc/index.md", "lamp_fan\n")
    add_file(root, "SConstruct", "\n")
    add_file(root, ".gitignore", "/bin/\n*.pyc\n__pycache__/\n")
    add_file(root, "bin/gnomon", "ignored, see .gitignore")


def replace_config(root, name, dependencies, layer):
    os.remove(os.path.join(root, "modules", name, "config.py"))
    add_file(root, "modules/%s/config.py" % name, MODULE_CONFIG % (dependencies, layer))


def add_named_filter(root):
    """Add a mask filter, and name it in the renderer."""
    text = 'MaskFilterRegistry::add({ "mist", "x", [] { return std::make_unique<Mist>(); } });\n'
    add_module(root, "receiver_mist", ["core", "renderer"], 4)
    add_file(root, "modules/receiver_mist/register_types.cpp", text)
    add_file(root, "modules/renderer/a.cpp", 'find("mist");\n')


# (What is broken, the rule that must notice it, a function that breaks it.)
BREACHES = (
    ("an include from the file's own folder", "check_root_relative_includes",
     lambda root: add_file(root, "modules/scene/light.h", '#include "node.h"\n')),
    ("an include of a module that is not listed", "check_listed_dependencies",
     lambda root: add_file(root, "modules/scene/light.h", '#include "modules/editor/register_types.h"\n')),
    ("an include of a module listed only by a dependency", "check_listed_dependencies",
     lambda root: add_file(root, "modules/shadow_lamp/a.cpp", '#include "modules/scene/node.h"\n')),
    ("an include with brackets and blanks", "check_listed_dependencies",
     lambda root: add_file(root, "modules/scene/light.h", "  #  include <modules/main/register_types.h>\n")),
    ("a dependency on a higher layer", "check_layers",
     lambda root: replace_config(root, "scene", ["core", "renderer"], 1)),
    ("a technique that lists another technique", "check_layers",
     lambda root: replace_config(root, "shadow_lamp", ["renderer", "shadow_moon"], 4)),
    ("a dependency that does not exist", "check_layers",
     lambda root: replace_config(root, "shadow_lamp", ["renderer", "gone"], 4)),
    ("Vulkan in the renderer", "check_vulkan",
     lambda root: add_file(root, "modules/renderer/a.cpp", "#include <vulkan/vulkan_raii.hpp>\n")),
    ("Godot's interface in the renderer", "check_godot",
     lambda root: add_file(root, "modules/renderer/a.cpp", "#include <gdextension_interface.h>\n")),
    ("Vulkan's handles in the renderer", "check_vulkan",
     lambda root: add_file(root, "modules/renderer/a.cpp", '#include "modules/rendering_device_vulkan/vulkan_handles.h"\n')),
    ("Vulkan in main", "check_vulkan",
     lambda root: add_file(root, "modules/main/window.cpp", "#include <vulkan/vulkan_core.h>\n")),
    ("Vulkan in a test", "check_vulkan",
     lambda root: add_file(root, "tests/a.cpp", '#include "vulkan.h"\n')),
    ("Vulkan in rendering_device", "check_vulkan",
     lambda root: add_file(root, "modules/rendering_device/a.h", "#include <vulkan/vulkan_core.h>\n")),
    ("a backend in a technique", "check_backends",
     lambda root: add_file(root, "modules/shadow_moon/a.cpp", '#include "modules/rendering_device_vulkan/a.h"\n')),
    ("a backend in main", "check_backends",
     lambda root: add_file(root, "modules/main/a.cpp", '#include "modules/rendering_device_vulkan/a.h"\n')),
    ("a technique that lists a backend", "check_backends",
     lambda root: replace_config(root, "shadow_moon", ["core", "renderer", "rendering_device_vulkan"], 4)),
    ("windows.h in a file for all systems", "check_system_headers",
     lambda root: add_file(root, "modules/core/a.cpp", "#define WIN32_LEAN_AND_MEAN\n#define NOGDI\n#include <windows.h>\n")),
    ("all of windows.h", "check_system_headers",
     lambda root: add_file(root, "modules/core/a_windows.cpp", "#define NOGDI\n#include <Windows.h>\n")),
    ("a thread_local in a module that is built for Godot", "check_thread_locals",
     lambda root: add_file(root, "modules/shadow_moon/a.cpp", "static thread_local std::string text;\n")),
    ("a private function of the same name in two files", "check_private_names",
     lambda root: [add_file(root, "modules/core/%s.cpp" % name, "namespace {\n\nint find(%s p_value) {\n}\n\n} // namespace\n" % kind)
                   for name, kind in (("a", "int"), ("b", "double"))]),
    ("the device's testing header in the renderer", "check_test_headers",
     lambda root: add_file(root, "modules/renderer/a.cpp", '#include "modules/rendering_device/tests/testing.h"\n')),
    ("the device's testing header in rendering_device itself", "check_test_headers",
     lambda root: add_file(root, "modules/rendering_device/a.h", '#include "modules/rendering_device/tests/testing.h"\n')),
    ("GLFW in the renderer", "check_window_library",
     lambda root: add_file(root, "modules/renderer/a.cpp", "#include <GLFW/glfw3.h>\n")),
    ("mesh_tools that depends on the device", "check_modules_without_device",
     lambda root: replace_config(root, "mesh_tools", ["core", "rendering_device"], 2)),
    ("mesh_tools that depends on the device through the renderer", "check_modules_without_device",
     lambda root: replace_config(root, "mesh_tools", ["core", "renderer"], 4)),
    ("an id of a mask filter in the renderer", "check_technique_names",
     add_named_filter),
    ("an id that is not a literal", "check_registration_is_readable",
     lambda root: add_file(root, "modules/renderer/register_types.cpp", "ShadowRegistry::add(make_info());\n")),
    ("an id in the renderer", "check_technique_names",
     lambda root: add_file(root, "modules/renderer/a.cpp", 'find("moon");\n')),
    ("a property of a technique in a script", "check_technique_names",
     lambda root: add_file(root, "tests/a.py", "value = 'lamp_fan_count'\n")),
    ("an id in another technique's module", "check_technique_names",
     lambda root: add_file(root, "modules/shadow_moon/a.cpp", 'find("lamp_fan");\n')),
    ("a class in a test of the engine", "check_technique_names",
     lambda root: add_file(root, "tests/a.cpp", "ShadowLamp lamp;\n")),
    ("a class of one word in a test of the engine", "check_technique_names",
     lambda root: add_file(root, "tests/a.cpp", "Sun sun; // shines\n")),
    ("a shader include of another technique in brackets", "check_shader_includes",
     lambda root: add_file(root, "shaders/shadow_moon/a.frag", "#include <shadow_lamp/fan.frag>\n")),
    ("a shader that includes another technique's", "check_shader_includes",
     lambda root: add_file(root, "shaders/shadow_moon/a.frag", '#include "shadow_lamp/fan.frag"\n')),
    ("a common shader that includes a technique's", "check_shader_includes",
     lambda root: add_file(root, "shaders/common/a_inc.glsl", '#include "shadow_lamp/fan.frag"\n')),
    ("a shader include that does not exist", "check_shader_includes",
     lambda root: add_file(root, "shaders/shadow_moon/a.frag", '#include "common/gone_inc.glsl"\n')),
    ("a file named utils", "check_file_names",
     lambda root: add_file(root, "modules/core/string_utils.h", "\n")),
    ("a file named helpers", "check_file_names",
     lambda root: add_file(root, "tests/helpers.py", "\n")),
    ("a file of 801 lines", "check_file_lengths",
     lambda root: add_file(root, "modules/core/long.cpp", "\n" * 801)),
    ("a top-level entry that is not in TOP_LEVEL", "check_top_level",
     lambda root: add_file(root, "tools/a.py", "\n")),
)  # fmt: skip


def run_self_test(rules, find_breaches):
    """Check that every rule notices its breaches. Return (passed, failed)."""
    passed = failed = 0
    with tempfile.TemporaryDirectory() as folder:
        clean = os.path.join(folder, "clean")
        make_small_tree(clean)
        found = [line for lines in find_breaches(clean).values() for line in lines]
        if found:
            failed += 1
            print("FAILED: a tree that follows every rule is refused:\n\t" + "\n\t".join(found))
        else:
            passed += 1
        for index, (what, rule, break_it) in enumerate(BREACHES):
            root = os.path.join(folder, "breach_%d" % index)
            shutil.copytree(clean, root)
            break_it(root)
            if find_breaches(root)[rule]:
                passed += 1
            else:
                failed += 1
                print("FAILED: %s did not notice %s" % (rule, what))
        untested = {rule.__name__ for rule in rules} - {rule for _, rule, _ in BREACHES}
        if untested:
            failed += 1
            print("FAILED: no breach is tried for %s" % ", ".join(sorted(untested)))
    return passed, failed
