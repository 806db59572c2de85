"""Builds third-party libraries for platforms other than this machine's: of the program for Windows, and of the add-on.

Debian packages only zlib for Windows (libz-mingw-w64-dev), and libspirv-cross-c-shared-dev can be installed for one
architecture only. So libraries are built here, as static libraries, from the sources of Debian's own packages, or from headers
with implementations that these packages install. The folder of build() receives include/, lib/, licences/ and versions.txt.
Libraries that it has are not built again. Needs apt's network.
"""

import glob
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile

# Debian's source packages, in the order of their dependencies, with the options of cmake: those of the add-on and the program,
# and those of the program only.
ADDON_SOURCES = {
    # only the part that reads SPIR-V
    "spirv-cross": ["-DSPIRV_CROSS_FORCE_PIC=ON", "-DSPIRV_CROSS_CLI=OFF", "-DSPIRV_CROSS_ENABLE_TESTS=OFF"]
    + ["-DSPIRV_CROSS_ENABLE_%s=OFF" % part for part in ("GLSL", "HLSL", "MSL", "CPP", "REFLECT", "C_API", "UTIL")]
}
PROGRAM_SOURCES = {
    "libpng1.6": ["-DPNG_SHARED=OFF", "-DPNG_TESTS=OFF", "-DPNG_EXECUTABLES=OFF"],
    "libjpeg-turbo": ["-DENABLE_SHARED=OFF", "-DWITH_SIMD=OFF", "-DWITH_JAVA=OFF"],  # SIMD needs an assembler
    "imath": ["-DBUILD_TESTING=OFF", "-DIMATH_INSTALL_PKG_CONFIG=ON"],
    "openexr": ["-DBUILD_TESTING=OFF", "-DOPENEXR_BUILD_TOOLS=OFF", "-DOPENEXR_INSTALL_EXAMPLES=OFF", "-DOPENEXR_INSTALL_PKG_CONFIG=ON"],
    # The program traces triangles only. Variants for AVX are faster, and take four times as long to build.
    "embree": [
        "-DEMBREE_STATIC_LIB=ON", "-DEMBREE_TASKING_SYSTEM=INTERNAL", "-DEMBREE_ISPC_SUPPORT=OFF", "-DEMBREE_TUTORIALS=OFF",
        "-DEMBREE_MAX_ISA=NONE", "-DEMBREE_ISA_SSE2=ON", "-DEMBREE_ISA_SSE42=OFF", "-DEMBREE_ISA_AVX=OFF", "-DEMBREE_ISA_AVX2=OFF",
        "-DEMBREE_ISA_AVX512=OFF", "-DEMBREE_STACK_PROTECTOR=OFF", "-DEMBREE_GEOMETRY_QUAD=OFF", "-DEMBREE_GEOMETRY_CURVE=OFF", "-DEMBREE_GEOMETRY_SUBDIVISION=OFF",
        "-DEMBREE_GEOMETRY_USER=OFF", "-DEMBREE_GEOMETRY_GRID=OFF", "-DEMBREE_GEOMETRY_POINT=OFF",
    ],
}  # fmt: skip
# Changes of source files: path, text, its replacement. Embree's build expects Microsoft's compilers on Windows.
CHANGES = {
    "embree": [
        ("CMakeLists.txt", "INCLUDE (msvc)", "INCLUDE (gnu)"),
        ("kernels/CMakeLists.txt", "\n  embree.rc\n", "\n"),
        # which Debian's sources lack
        ("common/cmake/package.cmake", 'INSTALL(FILES "${PROJECT_SOURCE_DIR}/readme.pdf" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT lib)', ""),
    ],
}
# tinygltf is contained in its header, and the parts of stb that it calls in theirs: the source file, and Debian's packages.
TINYGLTF = "".join("#define %s_IMPLEMENTATION\n" % name for name in ("STB_IMAGE", "STB_IMAGE_WRITE", "TINYGLTF")) + "#include <tiny_gltf.h>\n"
HEADER_PACKAGES = ("libtinygltf-dev", "libstb-dev")
VULKAN_HEADER = "/usr/include/vulkan/vulkan_core.h"
HEADERS = ("stb", "nlohmann", "tiny_gltf.h")


def get_sysroot(platform):
    return "/usr/" + platform.tools.rstrip("-")


def run(command, **options):
    """Run a command. Exits with its last lines if it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False, **options)
    if done.returncode:
        print("\n".join(done.stdout.splitlines()[-20:]), file=sys.stderr)
        raise SystemExit("ERROR: `%s` failed. Install the packages CROSS_PACKAGES and WINDOWS_LIBRARY_PACKAGES of demo_project/install_packages.sh." % " ".join(command))
    return done.stdout


def read_text(path):
    """Return the text of a file, "" if it does not exist."""
    if not os.path.exists(path):
        return ""
    with open(path, encoding="utf-8") as file:
        return file.read()


def write_text(path, text):
    """Write a file, and create its folder if it is absent."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


class SourcePackages:
    """Downloads Debian's source packages with apt, without a change of the system: lists and files are below `folder`."""

    def __init__(self, folder):
        self.folder = folder
        parts = os.path.join(folder, "apt", "parts")
        for name in ("lists/partial", "cache/archives/partial", "parts"):
            os.makedirs(os.path.join(folder, "apt", name), exist_ok=True)
        # The system's own sources of packages, with their sources in place of programs.
        for path in glob.glob("/etc/apt/sources.list.d/*.sources"):
            write_text(os.path.join(parts, os.path.basename(path)), re.sub(r"(?m)^Types:.*$", "Types: deb-src", read_text(path)))
        for path in ["/etc/apt/sources.list", *glob.glob("/etc/apt/sources.list.d/*.list")]:
            write_text(os.path.join(parts, os.path.basename(path)), re.sub(r"(?m)^deb\s", "deb-src ", read_text(path)))
        self.options = []
        for key, value in {
            "Dir::Etc::sourcelist": "/dev/null",
            "Dir::Etc::sourceparts": parts,
            "Dir::State::lists": os.path.join(folder, "apt", "lists"),
            "Dir::Cache": os.path.join(folder, "apt", "cache"),
            "APT::Sandbox::User": "root",
            "Acquire::Retries": "3",
        }.items():
            self.options += ["-o", key + "=" + value]
        run(["apt-get", *self.options, "update"])

    def unpack(self, package):
        """Return the version and the folder of the package's patched source: the newest version that the mirror has, or if it has
        no version in full, the newest without Debian's patches."""
        shown = run(["apt-cache", *self.options, "showsrc", package])
        versions = sorted(set(re.findall(r"(?m)^Version: (.+)$", shown)), key=_DebianVersion, reverse=True)
        for version in versions:
            folder = self._download(package, version, [])
            if folder:
                return version, folder
        for version in versions:
            folder = self._download(package, version, ["--tar-only"])
            if folder:
                return version + " without Debian's patches", folder
        raise SystemExit(
            "ERROR: apt has no sources of %s. Is there a network connection, and does /etc/apt name a Debian 12 mirror?" % package
        )

    def _download(self, package, version, options):
        """Return the folder of the unpacked source, or None if the mirror does not have all of it."""
        command = ["apt-get", *self.options, *options, "--only-source", "source", "%s=%s" % (package, version)]
        with tempfile.TemporaryDirectory(dir=self.folder) as folder:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode:
                return None
            for name in os.listdir(folder):
                if options and ".orig.tar." in name and not name.endswith(".asc"):
                    run(["tar", "-xf", name], cwd=folder)
            unpacked = [name for name in os.listdir(folder) if os.path.isdir(os.path.join(folder, name))]
            if len(unpacked) != 1:
                return None
            target = os.path.join(self.folder, package)
            shutil.rmtree(target, ignore_errors=True)
            shutil.move(os.path.join(folder, unpacked[0]), target)
            return target


class _DebianVersion:
    """Sorts versions as dpkg does."""

    def __init__(self, version):
        self.version = version

    def __lt__(self, other):
        return subprocess.run(["dpkg", "--compare-versions", self.version, "lt", other.version], check=False).returncode == 0


def write_toolchain(path, folder, platform):
    """Write cmake's description of the compilers, which also find the libraries that were installed into the folder before."""
    lines = ["set(CMAKE_SYSTEM_NAME %s)" % platform.system.capitalize(), "set(CMAKE_SYSTEM_PROCESSOR %s)" % platform.arch]
    lines += ["set(CMAKE_FIND_ROOT_PATH %s %s)" % (get_sysroot(platform), folder)]
    compilers = {"C": platform.compiler.replace("g++", "gcc"), "CXX": platform.compiler, "RC": platform.tools + "windres"}
    lines += ["set(CMAKE_%s_COMPILER %s)" % item for item in compilers.items()]
    lines += ["set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)"]
    lines += ["set(CMAKE_FIND_ROOT_PATH_MODE_%s ONLY)" % what for what in ("LIBRARY", "INCLUDE", "PACKAGE")]
    write_text(path, "\n".join(lines) + "\n")


def build_source(source, folder, toolchain, options):
    """Configure, build and install one library."""
    build = source + ".build"
    run(["cmake", "-S", source, "-B", build, "-DCMAKE_TOOLCHAIN_FILE=" + toolchain, "-DCMAKE_BUILD_TYPE=Release",
         "-DCMAKE_INSTALL_PREFIX=" + folder, "-DBUILD_SHARED_LIBS=OFF", *options])  # fmt: skip
    run(["cmake", "--build", build, "--parallel", str(os.cpu_count() or 1), "--target", "install"])
    shutil.rmtree(build)


def build_tinygltf(folder, work, platform):
    links = os.path.join(work, "links")
    os.makedirs(links, exist_ok=True)
    for name in HEADERS:
        link = os.path.join(links, name)
        if not os.path.lexists(link):
            os.symlink("/usr/include/" + name, link)
    source = os.path.join(work, "tinygltf.cpp")
    write_text(source, TINYGLTF)
    made = os.path.join(work, "tinygltf.o")
    run([platform.compiler, "-O2", "-g1", "-w", "-isystem", links, "-isystem", links + "/stb", "-c", source, "-o", made])
    run([platform.tools + "ar", "rcs", os.path.join(folder, "lib", "libtinygltf.a"), made])


def make_vulkan_import(folder, work, platform):
    """Make the import library of vulkan-1.dll, the loader, which comes with every graphics driver. It is loaded at the first call, so
    that a program can say what is missing where there is none."""
    names = re.findall(r"VKAPI_CALL (vk\w+)\(", read_text(VULKAN_HEADER))
    # The loader exports the functions of Vulkan itself and of surfaces and swapchains (KHR); others are looked up by name.
    exported = [name for name in names if not re.search(r"[A-Z]{2,}$", name) or name.endswith("KHR")]
    definition = os.path.join(work, "vulkan-1.def")
    write_text(definition, "LIBRARY vulkan-1.dll\nEXPORTS\n" + "\n".join(exported) + "\n")
    run([platform.tools + "dlltool", "-d", definition, "-y", os.path.join(folder, "lib", "libvulkan.a")])


def copy_licence(folder, package, source):
    """Copy Debian's copyright file of a package, or where its source has none the licence itself."""
    names = ("debian/copyright", "LICENSE", "LICENSE.txt", "LICENSE.md", "COPYING", "copyright")
    found = next(path for path in (os.path.join(source, name) for name in names) if os.path.exists(path))
    os.makedirs(os.path.join(folder, "licences"), exist_ok=True)
    shutil.copyfile(found, os.path.join(folder, "licences", package))


def change_source(source, name, old, new):
    path = os.path.join(source, name)
    text = read_text(path)
    if old not in text:
        raise SystemExit("ERROR: %s has no longer the text %r, which the build replaces." % (path, old))
    write_text(path, text.replace(old, new))


def merge_embree(folder, platform):
    """Make one library of Embree's parts, so that the order in which they are linked does not matter."""
    library = os.path.join(folder, "lib")
    names = ["libembree3.a", "liblexers.a", "libmath.a", "libsimd.a", "libsys.a", "libtasking.a"]
    paths = [os.path.join(library, name) for name in names] + sorted(glob.glob(library + "/libembree_*.a"))
    paths = [path for path in paths if os.path.exists(path)]
    merged = os.path.join(library, "merged.a")
    run([platform.tools + "ar", "-M"], input="create %s\n%ssave\nend\n" % (merged, "".join("addlib %s\n" % path for path in paths)))
    for path in paths:
        os.remove(path)
    os.rename(merged, os.path.join(library, names[0]))


def compute_recipe(*parts):
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]


def build(folder, platform, is_addon):
    """Build the libraries of the add-on or of the program that the folder does not have with the recipe of this file."""
    folder = os.path.abspath(folder)
    recipe = compute_recipe(read_text(os.path.abspath(__file__)))
    stamp = os.path.join(folder, "versions.txt")
    if read_text(stamp).startswith(recipe + "\n"):
        return
    duration = "half a minute" if is_addon else "7 minutes"
    print("Building third-party libraries for %s in %s (%s on two cores)" % (platform.name, folder, duration), flush=True)
    work = os.path.join(folder, "work")
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    os.makedirs(os.path.join(folder, "lib"), exist_ok=True)
    toolchain = os.path.join(work, "toolchain.cmake")
    write_toolchain(toolchain, folder, platform)
    packages = None
    versions = []
    sources = ADDON_SOURCES if is_addon else {**ADDON_SOURCES, **PROGRAM_SOURCES}
    for index, (package, options) in enumerate(sources.items(), 1):
        made = os.path.join(folder, "made", package)  # the recipe and the version of a library that is complete
        own_recipe = compute_recipe(options, CHANGES.get(package, []))
        if not read_text(made).startswith(own_recipe + "\n"):
            packages = packages or SourcePackages(work)
            version, source = packages.unpack(package)
            print("%d/%d %s %s" % (index, len(sources), package, version), flush=True)
            for change in CHANGES.get(package, []):
                change_source(source, *change)
            build_source(source, folder, toolchain, options)
            if package == "embree":
                merge_embree(folder, platform)
            copy_licence(folder, package, source)
            shutil.rmtree(source)
            write_text(made, own_recipe + "\n" + version + "\n")
        versions.append("%s %s" % (package, read_text(made).splitlines()[1]))
    if not is_addon:
        build_tinygltf(folder, work, platform)
        for package in (*HEADER_PACKAGES, "libz-mingw-w64-dev"):
            copy_licence(folder, package, "/usr/share/doc/" + package)
            versions.append("%s %s" % (package, run(["dpkg-query", "-W", "-f", "${Version}", package])))
        make_vulkan_import(folder, work, platform)
    shutil.rmtree(work)
    write_text(stamp, recipe + "\n" + "\n".join(versions) + "\n")
