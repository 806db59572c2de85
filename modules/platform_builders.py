"""The platforms that libraries are built for: the compiler, the flags, the build folder and the file names of each.

Source files whose name ends with _posix.cpp or _windows.cpp are compiled for these systems only (see modules_builders.py).
"""

import os
import shutil

import cross_libraries
from SCons.Script import Action

# Third-party headers of the add-on. They are independent of the platform, so Debian's own packages provide them.
HEADERS = ("glm", "nlohmann", "spirv_cross", "xxhash.h")
PROGRAM_HEADERS = ("CLI", "doctest", "tiny_gltf.h", "vulkan", "vk_video")  # of the program, in addition
# See cross_libraries.py.
PROGRAM_LIBRARY_FOLDER = "build/windows_libraries"
ADDON_LIBRARY_FOLDER = "build/addon_libraries."  # and the platform's name
HEADER_FOLDER = "/usr/include"
HOST_ARCH = {"aarch64": "arm64"}.get(os.uname().machine, os.uname().machine)
MISSING_COMPILER = (
    "ERROR: platform=%s arch=%s needs the compiler %s, which is not in PATH. Install the packages CROSS_PACKAGES of\n"
    "demo_project/install_packages.sh, or choose the platforms to build with platform= and arch=."
)


class Platform:
    """A system and an architecture. compiler, tools: names in PATH; tools is the prefix of strip, objcopy and ar."""

    def __init__(self, system, arch, compiler, tools, ending):
        self.system = system
        self.arch = arch
        self.compiler = compiler
        self.tools = tools
        self.ending = ending  # of library names
        self.is_host = system == "linux" and arch == HOST_ARCH
        self.has_program = self.is_host or system == "windows"  # where bin/gnomon can be built, not only the add-on

    @property
    def name(self):
        return self.system + "." + self.arch

    @property
    def program_name(self):
        """Return the ending of names of test programs in bin/, which has those of all platforms."""
        return self.name + self.program_ending

    @property
    def program_ending(self):
        return ".exe" if self.system == "windows" else ""

    def is_compiled(self, path):
        """Return whether a source file is for this platform."""
        other = "_posix.cpp" if self.system == "windows" else "_windows.cpp"
        return not path.endswith(other)


PLATFORMS = (
    Platform("linux", "x86_64", "x86_64-linux-gnu-g++", "x86_64-linux-gnu-", ".so"),
    # With Debian's other thread model, win32, libstdc++ 12 has no std::thread.
    Platform("windows", "x86_64", "x86_64-w64-mingw32-g++-posix", "x86_64-w64-mingw32-", ".dll"),
    Platform("linux", "arm64", "aarch64-linux-gnu-g++", "aarch64-linux-gnu-", ".so"),
)
HOST = next((platform for platform in PLATFORMS if platform.is_host), Platform("linux", HOST_ARCH, "g++", "", ".so"))
SYSTEMS = sorted({platform.system for platform in PLATFORMS})
ARCHITECTURES = sorted({platform.arch for platform in (*PLATFORMS, HOST)})


def select_platforms(env, are_chosen):
    """Return the platforms to build: the one that env names with platform= and arch=, or PLATFORMS if the zip of the add-on is built
    and the command line (are_chosen) names none. Exits if a compiler is missing."""
    arch = env["arch"] or ("x86_64" if env["platform"] == "windows" else HOST_ARCH)
    selected = [item for item in {*PLATFORMS, HOST} if (item.system, item.arch) == (env["platform"], arch)]
    if not selected:
        known = ", ".join("platform=%s arch=%s" % (item.system, item.arch) for item in PLATFORMS)
        print("ERROR: platform=%s arch=%s is not built, must be one of: %s." % (env["platform"], arch, known))
        env.Exit(2)
    if env["addon_zip"] and not are_chosen:
        selected = list(PLATFORMS)
    if not env["godot"] and not selected[0].has_program:
        print("ERROR: platform=%s arch=%s godot=no is not built: only the add-on is. Remove godot=no." % (selected[0].system, selected[0].arch))
        env.Exit(2)
    for platform in selected:
        if not platform.is_host and not shutil.which(platform.compiler):
            print(MISSING_COMPILER % (platform.system, platform.arch, platform.compiler))
            env.Exit(2)
    return selected


def make_environment(env, platform):
    """Return a clone of env that builds for the platform, into a build folder of its own unless it is this machine's."""
    clone = env.Clone(TARGET_PLATFORM=platform, THIRD_PARTY=[])
    if env["godot"]:
        # Export only the entry points. Otherwise symbols of Godot's own libstdc++ would replace some of ours at load time.
        is_windows = platform.system == "windows"
        exports = clone.File("#modules/godot_addon/exports.def" if is_windows else "#modules/rendering_device_godot/exports.map")
        clone["EXPORTS"] = exports
        # Without --no-insert-timestamp, two builds of the same sources would differ.
        clone.Append(
            SHLINKFLAGS=[exports.path, "-Wl,--no-insert-timestamp"] if is_windows else ["-Wl,--version-script=" + exports.path]
        )
    if platform.is_host:
        return clone
    clone["BUILD_FOLDER"] += "." + platform.name
    folder = clone["BUILD_FOLDER"] + "/third_party"
    clone.Replace(CXX=platform.compiler, SHLIBSUFFIX=platform.ending, AR=platform.tools + "ar", RANLIB=platform.tools + "ranlib")
    # Not all of /usr/include: its other headers are those of this machine's C library.
    clone.Append(CCFLAGS=[("-isystem", clone.Dir(folder).path)])
    clone["THIRD_PARTY"] = clone.Command(
        folder + "/links.txt", clone.Value(HEADERS + PROGRAM_HEADERS), Action(_link_headers, "Linking third-party headers in " + folder.lstrip("#"))
    )
    if platform.arch == "arm64":
        clone.Append(CXXFLAGS=["-Wno-psabi"])  # notes on what g++ before 10.1 compiled differently
    if platform.system == "windows":
        clone["CCFLAGS"] = [flag for flag in clone["CCFLAGS"] if flag not in ("-fPIC", "-fvisibility=hidden")]
        clone.Append(LINKFLAGS=["-static"])  # winpthread too, which Windows lacks
        clone["PROGRAM_SUFFIX"] += platform.program_ending
    add_libraries(clone, platform)
    return clone


def add_libraries(env, platform):
    """Build third-party libraries now, if they are absent, because modules look for them when they are configured."""
    folder = env.Dir("#" + (ADDON_LIBRARY_FOLDER + platform.name if env["godot"] else PROGRAM_LIBRARY_FOLDER)).abspath
    cross_libraries.build(folder, platform, is_addon=env["godot"])
    env["ENV"] = {
        **env["ENV"],
        "CPLUS_INCLUDE_PATH": folder + "/include",  # system folders, as those of the machine's own libraries
        "PKG_CONFIG_LIBDIR": folder + "/lib/pkgconfig:" + cross_libraries.get_sysroot(platform) + "/lib/pkgconfig",
    }
    env.Append(LIBPATH=[folder + "/lib"])
    env["PKG_CONFIG"] = "pkg-config --static"


def _link_headers(target, source, env):
    folder = os.path.dirname(str(target[0]))
    for name in HEADERS + PROGRAM_HEADERS:
        header = os.path.join(HEADER_FOLDER, name)
        if not os.path.exists(header):
            print("ERROR: %s does not exist. Install the packages BUILD_PACKAGES of demo_project/install_packages.sh." % header)
            return 1
        link = os.path.join(folder, name)
        if os.path.lexists(link):
            os.remove(link)
        os.symlink(header, link)
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write("\n".join(HEADERS + PROGRAM_HEADERS) + "\n")
    return 0


def add_stripped(env, target, linked):
    """Add `target`, the linked library without debug information, and `target`.debug, which has it and which debuggers find next
    to it. Return both nodes."""
    tools = "" if env["TARGET_PLATFORM"].is_host else env["TARGET_PLATFORM"].tools
    commands = (
        tools + "objcopy --only-keep-debug $SOURCE ${TARGETS[1]}",
        tools + "strip --strip-unneeded -o ${TARGETS[0]} $SOURCE",
        tools + "objcopy --add-gnu-debuglink=${TARGETS[1]} ${TARGETS[0]}",
    )
    actions = [Action(command, "Stripping $TARGET" if "strip" in command else None) for command in commands]
    return env.Command([target, target + ".debug"], linked, actions)
