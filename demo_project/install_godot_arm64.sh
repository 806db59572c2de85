#!/usr/bin/env bash
# Gets a Godot 4 for Linux arm64, which QEMU runs on other processors, for tests/godot/test_arm64.py; see doc/platforms.md. Run it
# by itself, or source it after install_packages.sh and call install_godot_arm64. It needs the packages qemu-user-static and xvfb when it runs Godot.

GODOT_ARM64_SUITE=sid # as in install_godot.sh
GODOT_ARM64_PACKAGES=(
    base-files godot mesa-vulkan-drivers libx11-6 libxcursor1 libxi6 libxinerama1 libxrandr2 libxrender1 libxext6 libxkbcommon0
    libxkbcommon-x11-0 libdbus-1-3 libfontconfig1
)

# install_godot_arm64 ROOT: unpacks Debian's Godot for arm64, its graphics driver and the libraries that they need into
# ROOT/build/godot_arm64/root (0.6 GB, 1 minute), and writes ROOT/build/godot_arm64/godot, which runs that Godot. Nothing is installed, and
# it needs no root: apt has folders and a list of architectures of its own. Returns 1, with the reason on stderr, if that fails.
install_godot_arm64() {
    local folder=$1/build/godot_arm64 mirror options package
    if [ -x "$folder/godot" ]; then
        return 0
    fi
    mirror=$(find_debian_mirror)
    if [ -z "$mirror" ]; then
        echo "ERROR: apt names no mirror to get Godot for arm64 from. Run apt-get update." >&2
        return 1
    fi
    echo "Unpacking Godot for arm64 into $folder (0.6 GB, 1 minute on a fast connection)"
    rm -rf "$folder"
    mkdir -p "$folder/apt/state/lists/partial" "$folder/apt/cache/archives/partial" "$folder/root"
    : >"$folder/apt/status" # no package is installed, so that apt downloads all that the packages need
    echo "deb [arch=arm64] $mirror $GODOT_ARM64_SUITE main" >"$folder/apt/sources.list"
    # Check-Valid-Until=false accepts a mirror whose index has expired, such as a snapshot.
    options=(
        -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::Etc::sourcelist="$folder/apt/sources.list"
        -o Dir::Etc::sourceparts=- -o Dir::State="$folder/apt/state" -o Dir::State::status="$folder/apt/status"
        -o Dir::Cache="$folder/apt/cache" -o APT::Sandbox::User= -o Acquire::Check-Valid-Until=false -o Acquire::Languages=none
    )
    if ! apt-get "${options[@]}" update >"$folder/log" 2>&1 ||
        ! apt-get "${options[@]}" install -y --download-only --no-install-recommends "${GODOT_ARM64_PACKAGES[@]}" \
            >>"$folder/log" 2>&1; then
        tail -n 5 "$folder/log" >&2
        echo "ERROR: Godot for arm64 could not be downloaded, see $folder/log. Is there a network connection?" >&2
        return 1
    fi
    # base-files first: it has the links /lib and /bin, through which files of other packages are unpacked.
    for package in "$folder"/apt/cache/archives/base-files_*.deb "$folder"/apt/cache/archives/*.deb; do
        if ! dpkg-deb --extract "$package" "$folder/root" >>"$folder/log" 2>&1; then
            echo "ERROR: $package could not be unpacked, see $folder/log." >&2
            return 1
        fi
    done
    rm -rf "$folder/apt"
    mkdir -p "$folder/home"
    cat >"$folder/godot.part" <<TEXT
#!/bin/bash
# Runs Godot for Linux arm64 under QEMU, with a home of its own, in which its shaders are cached.
# GODOT_DISPLAY=virtual gives it a display, which a RenderingDevice needs.
export HOME=$folder/home XDG_RUNTIME_DIR=/tmp VK_DRIVER_FILES=$folder/root/usr/share/vulkan/icd.d/lvp_icd.json
# Without pointer authentication, which QEMU emulates slowly, and with the atomic instructions that it translates to those of x86.
command=(qemu-aarch64-static -cpu cortex-a76 -L "$folder/root" "$folder/root/usr/bin/godot" "\$@")
if [ "\${GODOT_DISPLAY:-}" = virtual ]; then
    exec xvfb-run -a -s "-screen 0 1280x1024x24" "\${command[@]}"
fi
exec "\${command[@]}"
TEXT
    chmod +x "$folder/godot.part"
    mv "$folder/godot.part" "$folder/godot"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    root=$(cd "$(dirname "$0")/.." && pwd)
    # shellcheck source=demo_project/install_packages.sh
    . "$root/demo_project/install_packages.sh"
    install_godot_arm64 "$root" || exit 1
    echo "Godot $("$root/build/godot_arm64/godot" --version | tail -n 1) for arm64: $root/build/godot_arm64/godot"
fi
