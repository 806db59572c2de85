# shellcheck shell=bash disable=SC2034
# The packages Gnomon needs on Debian 12, listed here only. Sourced by run_demo.sh,
# run_godot_demo.sh and tests/run_tests.sh; see doc/getting_started.md.

# To build and run bin/gnomon.
BUILD_PACKAGES=(
    build-essential pkg-config python3 scons
    libvulkan-dev mesa-vulkan-drivers glslang-dev glslang-tools spirv-tools libspirv-cross-c-shared-dev
    libglfw3-dev libglm-dev libtinygltf-dev nlohmann-json3-dev libpng-dev libturbojpeg0-dev libembree-dev
    libimgui-dev libstb-dev libopenexr-dev libcli11-dev doctest-dev libxxhash-dev
)
# Meshes for scenes/make_bunny.py and scenes/make_package_meshes.py, and their converter.
DEMO_PACKAGES=(glmark2-data assimp-testmodels assimp-utils)
# For the tests, in addition.
TEST_PACKAGES=(
    git vulkan-tools vulkan-validationlayers xvfb xdotool imagemagick x11-apps chromium clang-format
)
# For tests/run_tests.sh --full, in addition, to download meshes and gltf-validator.
LARGE_MESH_PACKAGES=(npm)
# For the fuzz tests of tests/run_tests.sh --full, in addition: libFuzzer is part of clang.
FUZZ_PACKAGES=(clang libclang-rt-14-dev)
# To build the add-on for Windows x86_64 and Linux arm64 (scons platform=windows, scons arch=arm64) and to pack its zip, in
# addition to BUILD_PACKAGES; 600 MB.
CROSS_PACKAGES=(g++-mingw-w64-x86-64-posix g++-aarch64-linux-gnu cmake)
# To build the program for Windows and its libraries (scons platform=windows godot=no), in addition.
WINDOWS_LIBRARY_PACKAGES=(libz-mingw-w64-dev)
# To run what they build: tests/run_tests.sh --windows; 1 GB.
CROSS_RUN_PACKAGES=(wine64 qemu-user-static)
# For tests/run_tests.sh --only blender, in addition; 160 MB with dependencies.
BLENDER_PACKAGES=(blender python3-numpy)

is_package_installed() {
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# find_debian_mirror: prints the address of the mirror that apt uses, or nothing if apt names none.
find_debian_mirror() {
    # shellcheck disable=SC2016
    apt-get indextargets --format '$(SITE)' 2>/dev/null | grep -v security | head -n 1
}

# install_packages PACKAGE...: installs the packages that are missing. Needs no network if none is missing.
# Returns 1, with the list on stderr, if that fails.
install_packages() {
    local missing=() package as_root=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "ERROR: this system has no apt. Install what these Debian 12 packages contain, then build with scons:" >&2
        printf '    %s\n' "$*" >&2
        return 1
    fi
    for package in "$@"; do
        is_package_installed "$package" || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        return 0
    fi
    echo "Installing ${#missing[@]} packages: ${missing[*]}"
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "ERROR: not root and no sudo. Install as root, then run this again:" >&2
            echo "    apt-get install --no-install-recommends ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    # env sets the variable, because sudo would drop it. Another apt or dpkg that runs is waited for.
    local errors install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=60 -qq -y
        --no-install-recommends install "${missing[@]}")
    if "${install[@]}" >/dev/null 2>&1; then
        return 0
    fi
    # The package lists may be absent or old.
    "${as_root[@]}" apt-get -qq update >/dev/null || true
    if errors=$("${install[@]}" 2>&1 >/dev/null); then
        return 0
    fi
    echo "$errors" >&2
    if [[ $errors == *"Could not get lock"* || $errors == *"Unable to acquire the dpkg"* ]]; then
        echo "ERROR: apt is busy: another program installs packages. Wait until it has ended, then run this again." >&2
        return 1
    fi
    echo "ERROR: apt-get could not install: ${missing[*]}. Check the network connection, and that this is Debian 12." >&2
    return 1
}
