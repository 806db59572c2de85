#!/usr/bin/env bash
# From a fresh Debian 12 to demo_project/out/index.html: installs what is missing, builds, renders
# demo scenes with and without soft shadows, and measures every technique (`gnomon report`). The page
# exists once the first configuration (scene, light, light size) is measured, and grows from then on.
set -euo pipefail

usage() {
    cat <<'TEXT'
Usage: demo_project/run_demo.sh [options]
  --all           every scene at three sizes of its lights, all quality levels, stability sweeps: more than an hour
  --size WxH      size of the images and masks (default 256x256)
  --samples N     light samples of the reference (default 1024)
  --frames N      maximum number of frames over which each technique is timed (default 20)
  --quick         three scenes only: sphere, three_lights, torus_knot
  --scenes A,B    these scenes only (default: ten scenes)
  --skip A,B*     skip these of the scenes that would be measured; * matches any text
  --out DIR       where the page goes (default demo_project/out)
  --jobs N        build jobs (default: one per core)
  --device NAME   Vulkan device, by name or index (default: the engine's choice)
  --no-window     do not open the window at the end, even where there is a display
  --no-build      use bin/gnomon as it is
Every run measures everything again. Exit code: 0 all done, 1 something failed, 2 wrong usage.
TEXT
}

fail_usage() {
    echo "ERROR: $1. See demo_project/run_demo.sh --help." >&2
    exit 2
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$root/demo_project/out
jobs=$(nproc 2>/dev/null || echo 1)
wants_window=yes
wants_build=yes
report_options=()
skipped=
scenes=sphere,three_lights,torus_knot,clutter,open_sheets,kitbash,fence,leaf,courtyard,package_duck
extent=(--sizes own --settings default)
while [ $# -gt 0 ]; do
    case $1 in
        --size | --samples | --frames | --scenes | --skip | --out | --jobs | --device)
            [ $# -ge 2 ] || fail_usage "$1 needs a value"
            case $1 in
                --size) [[ $2 =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]] || fail_usage "--size is $2, must be WxH, such as 512x512" ;;
                --samples | --frames | --jobs) [[ $2 =~ ^[1-9][0-9]*$ ]] || fail_usage "$1 is $2, must be a number from 1" ;;
            esac
            case $1 in
                --out) out=$2 ;;
                --jobs) jobs=$2 ;;
                --scenes) scenes=$2 ;;
                --skip) skipped=$2 ;;
                *) report_options+=("$1" "$2") ;;
            esac
            shift
            ;;
        --quick) scenes=sphere,three_lights,torus_knot ;;
        --all)
            scenes=
            extent=()
            ;;
        --no-window) wants_window=no ;;
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
if [ "$wants_build" = yes ]; then
    echo "== Packages"
    install_packages "${BUILD_PACKAGES[@]}" "${DEMO_PACKAGES[@]}" || exit 1
    echo "== Build"
    scons -j"$jobs" -Q bin/gnomon || exit 1
fi

has_failed=no
if [ ! -f demo_project/scenes/bunny.gltf ] || [ ! -f demo_project/scenes/bunny_wax.gltf ]; then
    echo "== Bunny"
    # The other scenes do not need it.
    python3 demo_project/scenes/make_bunny.py || has_failed=yes
fi

# Generated every time, which takes four seconds, so that no files of an older generator are measured.
echo "== Meshes that no technique was tuned for"
python3 demo_project/scenes/make_artist_scenes.py || has_failed=yes
python3 demo_project/scenes/make_foliage_scenes.py || has_failed=yes
python3 demo_project/scenes/make_package_meshes.py || has_failed=yes

echo "== Report"
[ -z "$scenes" ] || report_options+=(--scenes "$scenes")
[ -z "$skipped" ] || report_options+=(--skip "$skipped")
if [ ${#extent[@]} -gt 0 ]; then
    # Only the scenes: of every other part of the report, the option for its extent is "none".
    mapfile -t parts < <("${GNOMON:-bin/gnomon}" report --help | sed -n 's/^ *\(--[a-z]*\) TEXT:{none,quick,full}.*/\1\nnone/p')
    extent+=("${parts[@]}")
fi
"${GNOMON:-bin/gnomon}" report demo_project --out "$out" "${extent[@]}" "${report_options[@]}" || has_failed=yes

if [ "$wants_window" = yes ] && [ -n "${DISPLAY:-}" ]; then
    echo "== Window (close it to end)"
    "${GNOMON:-bin/gnomon}" run demo_project || has_failed=yes
fi
[ "$has_failed" = no ]
