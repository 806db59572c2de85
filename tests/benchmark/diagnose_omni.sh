#!/usr/bin/env bash
# Finds out why an omni light hangs a GPU, in about 4 minutes. Each line separates one cause.
#
#     diagnose_omni.sh PROGRAM [UNOPTIMISED_PROGRAM]
#
# UNOPTIMISED_PROGRAM: the same with shaders as glslang makes them (scons dev_build=yes). Needs the scene courtyard
# (demo_project/scenes/make_foliage_scenes.py). A run prints its result, the time and the CPU time: "in pass" in the message is
# a stop of the GPU in that pass; "compiling pipeline" is the driver's compiler; an end after 90 s without either, with little
# CPU time, is a wait that nothing watches.
set -u
if [ $# -lt 1 ] || [ ! -x "$1" ]; then
    echo "ERROR: usage: diagnose_omni.sh PROGRAM [UNOPTIMISED_PROGRAM], with programs that exist" >&2
    exit 2
fi
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../demo_project/scenes" && pwd)
if [ ! -f "$scenes/courtyard.gltf" ]; then
    echo "ERROR: $scenes/courtyard.gltf does not exist. Run demo_project/scenes/make_foliage_scenes.py" >&2
    exit 2
fi
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export GNOMON_DEVICE_TIMEOUT_S=5 GNOMON_CACHE_DIR=$work/cache # an empty cache: pipelines are compiled
TIMEFORMAT='    %R s, %U s of CPU time'

# try NAME PROGRAM SCENE LIGHT OPTION...: one run.
try() {
    local name=$1 program=$2 scene=$3 light=$4 status
    shift 4
    echo "$(date +%T) $name"
    rm -rf "$work/cache"
    time timeout 90 "$program" visibility "$scenes/$scene.gltf" --light "$light" --technique edge_count \
        --out "$work/mask.exr" "$@" >"$work/log" 2>&1
    status=$?
    echo "    $([ $status -eq 0 ] && echo drawn || echo "ended with $status") $(grep -E 'ERROR|WARNING' "$work/log" | tail -n 2)"
}

try "spot light, for comparison" "$1" three_lights Spot --size 64x64
try "omni light over few faces" "$1" three_lights Omni --size 64x64
try "many faces" "$1" courtyard Lamp --size 64x64
try "many faces and pixels" "$1" courtyard Lamp --size 256x256
try "no edges" "$1" courtyard Lamp --size 256x256 --set light_size=0
try "no interpolation" "$1" courtyard Lamp --size 256x256 --set edge_count_interpolation=0
if [ $# -gt 1 ]; then
    try "unoptimised shaders" "$2" courtyard Lamp --size 256x256
fi
