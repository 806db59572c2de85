#!/bin/sh
# Measures errors and times of the techniques on this machine's device; see usage below.
set -eu

usage() {
    cat <<'TEXT'
Usage: ./measure.sh [--quick | --all] [options]
  --quick         (default) errors and times of every technique in ten scenes, 512 x 512; on two CPU cores 8 minutes at most
  --all           the same, and times at 1920 x 1080 and 3840 x 2160 in the study's scenes, kitbash and courtyard
  --out DIR       where the results go (default: results, next to this script)
  --device NAME   Vulkan device, by name or index
  --scenes A,B    only these of the ten scenes
  --size WxH      size of their images (default: 512x512)
Writes DIR/results.json, one file to send, and DIR/report/index.html, a page with plots.
TEXT
}

here=$(cd "$(dirname "$0")" && pwd)
out=$here/results
device=
scenes=sphere,three_lights,torus_knot,clutter,open_sheets,kitbash,fence,leaf,courtyard,package_duck
size=512x512
is_all=no
while [ $# -gt 0 ]; do
    case $1 in
        --quick) is_all=no ;;
        --all) is_all=yes ;;
        --out | --device | --scenes | --size)
            if [ $# -lt 2 ]; then
                echo "ERROR: $1 needs a value. See ./measure.sh --help." >&2
                exit 2
            fi
            case $1 in
                --out) out=$2 ;;
                --device) device=$2 ;;
                --scenes) scenes=$2 ;;
                --size) size=$2 ;;
            esac
            shift
            ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            echo "ERROR: unknown option $1. See ./measure.sh --help." >&2
            exit 2
            ;;
    esac
    shift
done
mkdir -p "$out"
# References are cached next to this script: the bundle contains those of --quick, and others are traced once.
if [ -w "$here" ]; then
    GNOMON_CACHE_DIR=$here/references
    mkdir -p "$GNOMON_CACHE_DIR"
    export GNOMON_CACHE_DIR
fi
gnomon() {
    command=$1
    shift
    "$here/gnomon" "$command" "$@" ${device:+--device "$device"}
}

gnomon info --json >"$out/info.json"
gnomon report "$here/project" --scenes "$scenes" --sizes own --settings default --size "$size" --scaling none --change none --stability none \
    --precision 0 --out "$out/report"

# add_time SCENE SIZE TECHNIQUE SETTING: times the scene's first light and prints an object for results.json. Its time is null
# if the program fails.
add_time() {
    if gnomon visibility "$here/project/scenes/$1.gltf" --size "$2" --technique "$3" --time "$out/time.json" --out "$out/mask.exr" \
        ${4:+--set "$4"} >/dev/null 2>"$out/log"; then
        time=$(cat "$out/time.json")
    else
        echo "WARNING: $1, $2, $3: $(cat "$out/log")" >&2
        time=null
    fi
    printf '%s{ "scene": "%s", "size": "%s", "technique": "%s", "setting": "%s", "time": %s }' "$separator" "$1" "$2" "$3" "$4" "$time"
    separator=,
}

list_times() {
    separator=
    for pixels in 1920x1080 3840x2160; do
        for scene in sphere contact_box torus_knot stacked_layers clutter terrain kitbash courtyard; do
            echo "$scene, $pixels" >&2
            for technique in edge_count pcss penumbra_fins outer_fins shadow_volume jittered_pcf shadow_map views; do
                add_time $scene $pixels $technique ""
            done
            # The two settings that correspond to Sun et al. 2010: three depth peels, and fins from a geometry shader.
            add_time $scene $pixels penumbra_fins technique.penumbra_fins.peeling=passes
            add_time $scene $pixels penumbra_fins technique.penumbra_fins.method=geometry_shader
        done
    done
}

{
    printf '{ "format": "gnomon_bundle", "version": 1,\n"info": '
    cat "$out/info.json"
    printf ',\n"report": '
    cat "$out/report/report.json"
    printf ',\n"times": ['
    [ $is_all = no ] || list_times
    printf ']\n}\n'
} >"$out/results.json"
rm -f "$out/info.json" "$out/time.json" "$out/mask.exr" "$out/log"
echo "Results: $out/results.json"
