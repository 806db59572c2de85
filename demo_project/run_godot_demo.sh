#!/usr/bin/env bash
# From a fresh Debian 12 to demo_project/godot/out/index.html: installs Godot if there is none, builds the add-on and the
# program, renders the Godot project, and measures Gnomon's shadows next to Godot's own.
set -euo pipefail

usage() {
    cat <<'TEXT'
Usage: demo_project/run_godot_demo.sh [options]
  --size N        width and height of the images (default 800)
  --samples N     light samples of the reference (default 9216)
  --frames N      frames over which each shadow mode is timed (default 20)
  --cases A,B     cases LIGHT_CASTER, such as omni_box (default: all twelve)
  --scenes A,B    also glTF files inside this repository, each of their lights alone
  --out DIR       where the page goes (default demo_project/godot/out)
  --jobs N        build jobs (default: one per core)
  --no-build      use what is built
Godot is $GODOT, or `godot` in PATH, 4.5 or later; else Debian's is set up below build/, which needs root.
Exit code: 0 all done, 1 something failed, 2 wrong usage.
TEXT
}

fail_usage() {
    echo "ERROR: $1. See demo_project/run_godot_demo.sh --help." >&2
    exit 2
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$root/demo_project/godot/out
jobs=$(nproc 2>/dev/null || echo 1)
wants_build=yes
measure_options=()
while [ $# -gt 0 ]; do
    case $1 in
        --size | --samples | --frames | --cases | --scenes | --out | --jobs)
            [ $# -ge 2 ] || fail_usage "$1 needs a value"
            case $1 in
                --size | --samples | --frames | --jobs)
                    [[ $2 =~ ^[1-9][0-9]*$ ]] || fail_usage "$1 is $2, must be a number from 1" ;;
            esac
            case $1 in
                --out) out=$2 ;;
                --jobs) jobs=$2 ;;
                *) measure_options+=("$1" "$2") ;;
            esac
            shift
            ;;
        --no-build) wants_build=no ;;
        -h | --help)
            usage
            exit 0
            ;;
        *) fail_usage "unknown option $1" ;;
    esac
    shift
done
mkdir -p "$out"
out=$(cd "$out" && pwd)
cd "$root"

# shellcheck source=demo_project/install_packages.sh
. demo_project/install_packages.sh
# shellcheck source=demo_project/install_godot.sh
. demo_project/install_godot.sh
echo "== Packages"
install_packages "${BUILD_PACKAGES[@]}" "${DEMO_PACKAGES[@]}" || exit 1
install_godot "$root" || exit 1
if [ "$wants_build" = yes ]; then
    echo "== Build"
    scons -j"$jobs" -Q compiledb=no bin/gnomon
    scons -j"$jobs" -Q compiledb=no godot=yes tests=no
fi
echo "== Godot"
python3 demo_project/measure_godot.py --out "$out" "${measure_options[@]}"
echo "Page: $out/index.html"
