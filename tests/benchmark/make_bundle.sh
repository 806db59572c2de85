#!/usr/bin/env bash
# Packs the program with its libraries, so that it runs without installation. See usage below, and "A portable program" in
# doc/benchmarks.md.
set -euo pipefail

usage() {
    cat <<'TEXT'
Usage: tests/benchmark/make_bundle.sh [options]
  --out FILE    the archive (default build/gnomon-linux-x86_64.tar.xz, or build/gnomon-windows-x86_64.zip)
  --program P   the program to pack (default bin/gnomon)
  --windows     the program for Windows, bin/gnomon.exe, without references
  --quick       references of two scenes, in 64 x 64 pixels, instead of those of measure.sh --quick (for tests)
Packs the stripped program, its shared libraries with their licences, the scenes as files, the references of
measure.sh --quick, and scripts in sh. Needs the packages that run_demo.sh installs and the scenes that it makes. The
archive runs on x86-64 Linux with the C library of Debian 12 (glibc 2.36) or newer and a Vulkan driver.
Exit code: 0 done, 1 failed, 2 wrong usage.
TEXT
}

fail() {
    echo "ERROR: $1" >&2
    exit 1
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=
program=
is_windows=no
measure_options=()
while [ $# -gt 0 ]; do
    case $1 in
        --out | --program)
            [ $# -ge 2 ] || {
                echo "ERROR: $1 needs a value. See tests/benchmark/make_bundle.sh --help." >&2
                exit 2
            }
            if [ "$1" = --out ]; then out=$2; else program=$2; fi
            shift
            ;;
        --windows) is_windows=yes ;;
        --quick) measure_options=(--scenes "sphere,contact_box" --size 64x64) ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            echo "ERROR: unknown option $1. See tests/benchmark/make_bundle.sh --help." >&2
            exit 2
            ;;
    esac
    shift
done
if [ "$is_windows" = yes ]; then
    name=gnomon-windows-x86_64
    out=${out:-$root/build/$name.zip} program=${program:-$root/bin/gnomon.exe} build="scons platform=windows godot=no bin/gnomon.exe"
else
    name=gnomon-linux-x86_64
    out=${out:-$root/build/$name.tar.xz} program=${program:-$root/bin/gnomon} build="scons bin/gnomon"
fi
[ -x "$program" ] || fail "$program does not exist. Build it: $build."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bundle=$work/$name
mkdir -p "$bundle/licences" "$bundle/project/scenes"

add_own_files() {
    cp "$root/LICENSE" "$bundle/licences/gnomon.txt"
    cp "$root"/modules/error_report/page/third_party/*LICENSE* "$bundle/licences/"
    cp "$root"/demo_project/scenes/*.gltf "$root"/demo_project/scenes/*.bin "$root"/demo_project/scenes/*.png "$bundle/project/scenes/"
    cp "$root/demo_project/project.cfg" "$bundle/project/"
}
check_size() {
    size=$(stat -c %s "$out")
    echo "$out: $((size / 1048576)) MiB"
    [ "$size" -lt $((60 * 1048576)) ] || fail "$out has $size bytes, must be below 60 MiB"
}

# Packages whose code is in the program for Windows, besides the libraries of modules/cross_libraries.py: the compiler's
# libraries, and headers with code.
WINDOWS_PACKAGES="gcc-mingw-w64-x86-64-posix-runtime mingw-w64-x86-64-dev libglm-dev nlohmann-json3-dev libcli11-dev libxxhash-dev libvulkan-dev"
if [ "$is_windows" = yes ]; then
    x86_64-w64-mingw32-strip -o "$bundle/gnomon.exe" "$program"
    for licence in "$root"/build/windows_libraries/licences/*; do
        cp "$licence" "$bundle/licences/$(basename "$licence").txt"
    done
    for package in $WINDOWS_PACKAGES; do
        cp -L "/usr/share/doc/$package/copyright" "$bundle/licences/$package.txt"
    done
    add_own_files
    for text in README.txt measure.cmd; do
        sed 's/$/\r/' "$root/tests/benchmark/bundle/windows/$text" >"$bundle/$text" # Windows' line ends
    done
    mkdir -p "$(dirname "$out")"
    rm -f "$out"
    (cd "$work" && python3 -m zipfile -c "$out" "$name")
    check_size
    exit 0
fi
mkdir -p "$bundle/bin" "$bundle/lib" "$bundle/lib/fallback"

echo "== Program"
strip -o "$bundle/bin/gnomon" "$program"

echo "== Libraries"
# The C library is not packed: the program and the driver share that of the system. Libraries that a driver may need too are
# packed as fallbacks for systems without them, because a process loads only one version of each, and the driver of a newer
# system needs the newer one.
is_of_c_library() {
    case $1 in
        libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.* | ld-linux*) return 0 ;;
        *) return 1 ;;
    esac
}
is_of_drivers() {
    case $1 in
        libstdc++.so.* | libgcc_s.so.* | libz.so.* | libvulkan.so.* | libX11.so.* | libxcb.so.* | libXau.so.* | \
            libXdmcp.so.* | libbsd.so.* | libmd.so.*) return 0 ;;
        *) return 1 ;;
    esac
}
add_licence() {
    local package
    package=$(dpkg -S "$(realpath "$1")" 2>/dev/null || dpkg -S "*/$(basename "$(realpath "$1")")" | head -n 1) || fail "no package has $1"
    package=${package%%:*}
    cp -L "/usr/share/doc/$package/copyright" "$bundle/licences/$package.txt"
}
while read -r name path; do
    is_of_c_library "$name" && continue
    if is_of_drivers "$name"; then
        mkdir -p "$bundle/lib/fallback/$name"
        cp -L "$path" "$bundle/lib/fallback/$name/$name"
    else
        cp -L "$path" "$bundle/lib/$name"
    fi
    add_licence "$path"
done < <(ldd "$program" | awk '$2 == "=>" { print $1, $3 }')
find "$bundle/lib" -type f -exec strip --strip-unneeded {} +

echo "== Scenes"
add_own_files
cp "$root/tests/benchmark/bundle/gnomon" "$root/tests/benchmark/bundle/measure.sh" "$root/tests/benchmark/bundle/README.txt" "$bundle/"
chmod +x "$bundle/gnomon" "$bundle/measure.sh"

echo "== References"
"$bundle/measure.sh" --quick --out "$work/measured" "${measure_options[@]}" >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    fail "measure.sh failed in the bundle"
}

rm -f "$bundle"/references/pipelines_* # pipeline caches of this machine's driver

echo "== Archive"
mkdir -p "$(dirname "$out")"
tar -C "$work" --owner=0 --group=0 -cJf "$out" "$(basename "$bundle")"
check_size
