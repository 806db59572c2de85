#!/usr/bin/env bash
# All tests of Gnomon: installs what is missing, builds, runs. Last line: N passed, N failed, N skipped.
set -uo pipefail

PARTS="layers scenes build docs engine embed drivers command_line editor demo bundle stability removal template sanitized fuzz_replay godot windows windows_program separate_files sanitized_all threads fuzz tables editor_repeats large_meshes validator soak kills extremes blender"

usage() {
    cat <<'TEXT'
Usage: tests/run_tests.sh [--sanitized] [--full] [--godot] [--windows] [--jobs N] [--only PART]...
  --sanitized  also the modules that need no GPU under sanitizers, and the stored fuzzing inputs
  --full       also what --sanitized adds, each source file compiled by itself, sanitizers over everything, the thread
               sanitizer over the modules that need no GPU, removal of every technique and report part in turn, a build
               of the smallest game, tables with 9216 light samples, the editor's tests ten times, shadow volumes of
               large meshes and gltf-validator (installs npm, which downloads them), fuzzing (installs clang), 10,000
               frames of scenes that change at random, programs killed 200 times, all stability sweeps
  --godot      also tests inside Godot 4.5 or later: that of $GODOT or PATH, or one that is set up below
               build/ (1.2 GB, as root)
  --windows    also the Godot add-on's libraries for Windows x86_64 and Linux arm64, cross-compiled, and loaded under Wine
               and QEMU (installs both, and compilers: 1.6 GB), the program and the engine's tests for Windows under Wine,
               and the add-on inside Godot for arm64 (0.6 GB, below build/); needs Godot as --godot does
  --jobs N     build jobs (default: one a core)
  --only PART  this part only; may be repeated. Parts: layers scenes build docs engine embed
               drivers command_line editor demo bundle stability removal template sanitized fuzz_replay; with --godot
               also godot; with --windows also windows windows_program; with --full also separate_files sanitized_all threads tables editor_repeats large_meshes validator
               fuzz soak kills extremes; only when named: blender (installs Blender, 160 MB)
FUZZ_SECONDS   how long each fuzz target runs (environment; default 600)
Exit code: 0 all passed, 1 something failed, 2 wrong usage.
TEXT
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root" || exit 1
jobs=$(nproc 2>/dev/null || echo 1)
is_full=no
is_sanitized=no
has_godot=no
has_windows=no
has_windows_program=yes # until its build fails
only=()
while [ $# -gt 0 ]; do
    case $1 in
        --full) is_full=yes is_sanitized=yes ;;
        --sanitized) is_sanitized=yes ;;
        --godot) has_godot=yes ;;
        --windows) has_windows=yes ;;
        --jobs | --only)
            if [ $# -lt 2 ]; then
                echo "ERROR: $1 needs a value. See tests/run_tests.sh --help." >&2
                exit 2
            fi
            if [ "$1" = --jobs ]; then
                jobs=$2
            elif [[ " $PARTS " == *" $2 "* ]]; then
                only+=("$2")
            else
                echo "ERROR: unknown part $2, must be one of: $PARTS." >&2
                exit 2
            fi
            shift
            ;;
        -h | --help)
            usage
            exit 0
            ;;
        *)
            echo "ERROR: unknown option $1. See tests/run_tests.sh --help." >&2
            exit 2
            ;;
    esac
    shift
done

# is_requested PART: whether the part runs. The parts godot_* are requested together, as the part godot, and windows* as windows.
is_requested() {
    local requested=$1 name
    case $requested in
        sanitized | fuzz_replay)
            [ ${#only[@]} -gt 0 ] || [ "$is_sanitized" = yes ] || return 1
            ;;
        godot_*)
            [ "$has_godot" = yes ] || return 1
            requested=godot
            ;;
        windows_program)
            [ "$has_windows_program" = yes ] || return 1
            [ ${#only[@]} -gt 0 ] || [ "$has_windows" = yes ] || return 1
            ;;
        windows*)
            [ "$has_windows" = yes ] || return 1
            requested=windows
            ;;
    esac
    [ ${#only[@]} -eq 0 ] && return 0
    for name in "${only[@]}"; do
        [ "$name" = "$requested" ] && return 0
    done
    return 1
}

# shellcheck source=demo_project/install_packages.sh
. demo_project/install_packages.sh
packages=("${BUILD_PACKAGES[@]}" "${DEMO_PACKAGES[@]}" "${TEST_PACKAGES[@]}")
if [ "$is_full" = yes ] && { is_requested large_meshes || is_requested validator; } && ! command -v npm >/dev/null; then
    packages+=("${LARGE_MESH_PACKAGES[@]}")
fi
if [ "$is_full" = yes ] && is_requested fuzz; then
    packages+=("${FUZZ_PACKAGES[@]}")
fi
if [[ " ${only[*]} " == *" godot "* ]]; then
    has_godot=yes
fi
if [[ " ${only[*]} " == *" windows "* ]]; then
    has_windows=yes
fi
if is_requested windows || is_requested windows_program; then
    packages+=("${CROSS_PACKAGES[@]}" "${CROSS_RUN_PACKAGES[@]}")
fi
if is_requested windows_program; then
    packages+=("${WINDOWS_LIBRARY_PACKAGES[@]}")
fi
if [[ " ${only[*]} " == *" blender "* ]]; then
    packages+=("${BLENDER_PACKAGES[@]}")
fi
install_packages "${packages[@]}" || exit 1

work=$(mktemp -d) || exit 1
# Background jobs of a script ignore the interrupt key, so they are ended together with the script.
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
# Never the user's own cache; shared by all parts, so that a reference is traced once.
export GNOMON_CACHE_DIR=$work/cache GNOMON_CONFIG_DIR=$work/config
export PYTHONDONTWRITEBYTECODE=1
# Mesa's software drivers compile shaders without optimising them, in half the time: most tests draw few frames with each.
export GALLIVM_PERF=${GALLIVM_PERF-nopt}
unset GNOMON_UPDATE_GOLDEN # tests compare; only tests/golden/update.sh writes
mkdir -p "$GNOMON_CACHE_DIR"

# One file per part (see run_parts), with a line for each of its steps: "PASSED FAILED SKIPPED" and text for people.
results=$work/results
mkdir "$results"

# add_result PART PASSED FAILED SKIPPED: adds the line of a part that began at $part_begin.
add_result() {
    printf '%d %d %d %-16s %5d passed %4d failed %4d skipped  %4d s\n' "$2" "$3" "$4" "$1" "$2" "$3" "$4" \
        $((SECONDS - part_begin)) >>"$results/$name"
}

# keep_failures PART LOG: saves the log's lines on failures, which finish() shows again after all other output.
keep_failures() {
    {
        echo "-- $1:"
        grep -E '^ *FAILED|^(FAIL|ERROR): |: ERROR: |^ *TEST CASE: |AddressSanitizer|runtime error' "$2" | tail -n 40
    } >>"$work/failures"
}

# run_part PART COMMAND...: adds the counts of the command's own summary line. No such line, or a bad exit
# code without a failed test, counts as one failure, so that a crash is never silent.
run_part() {
    local part=$1 log=$work/log.$name status summary counts
    shift
    part_begin=$SECONDS
    echo "== $part: $*"
    "$@" 2>&1 | tee "$log"
    status=${PIPESTATUS[0]}
    summary=$(grep -E '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$log" | tail -n 1)
    [ "$status" -eq 0 ] || keep_failures "$part" "$log"
    read -r -a counts <<<"$(tr -dc '0-9 ' <<<"$summary")"
    if [ ${#counts[@]} -ne 3 ]; then
        echo "FAILED: $part ended with $status and without a summary line"
        add_result "$part" 0 1 0
    elif [ "$status" -ne 0 ] && [ "${counts[1]}" -eq 0 ]; then
        echo "FAILED: $part ended with $status"
        add_result "$part" "${counts[0]}" 1 "${counts[2]}"
    else
        add_result "$part" "${counts[@]}"
    fi
}

# run_check PART COMMAND...: one test, passed when the command ends with 0.
run_check() {
    local part=$1
    shift
    part_begin=$SECONDS
    echo "== $part: $*"
    if "$@"; then
        add_result "$part" 1 0 0
    else
        echo "FAILED: $part: $*"
        add_result "$part" 0 1 0
        return 1
    fi
}

# run_parts PART...: runs the parts in this order, one more at a time than the build has jobs, because most parts leave a core idle now
# and then; with one job, one at a time. The output of each part is shown when it has ended.
run_parts() {
    local part running=0 most=$((jobs > 1 ? jobs + 1 : 1))
    for part in "$@"; do
        is_requested "$part" || continue
        if [ "$running" -ge "$most" ]; then
            wait -n
            running=$((running - 1))
        fi
        (
            name=$part
            "part_$part" >"$work/output.$part" 2>&1
            flock "$work/output" cat "$work/output.$part"
        ) &
        running=$((running + 1))
    done
    wait
}

# finish: prints failures, one line per part and the sums, and exits with 0 if some passed and none failed.
finish() {
    local counts passed failed skipped rest
    echo
    [ -f "$work/failures" ] && cat "$work/failures"
    counts=(0 0 0)
    while read -r passed failed skipped rest; do
        echo "$rest"
        counts=($((counts[0] + passed)) $((counts[1] + failed)) $((counts[2] + skipped)))
    done < <(cat "$results"/*)
    printf 'in all %d s\n' "$SECONDS"
    echo "${counts[0]} passed, ${counts[1]} failed, ${counts[2]} skipped"
    [ "${counts[1]}" -eq 0 ] && [ "${counts[0]}" -gt 0 ]
    exit
}

# Options that disable what cannot run without a device: the modules that depend on it. The render graph stays, much
# of which needs none, and the backend, which the test runner queries for validation messages.
list_device_options() {
    python3 - <<'PYTHON'
import sys

sys.path.insert(0, "modules")
import modules_builders

needing = {"rendering_device"}
for module in modules_builders.find_modules("modules"):  # dependencies come first
    if module.name not in ("rendering_device_vulkan", "render_graph") and needing & set(module.dependencies):
        needing.add(module.name)
        print("module_%s_enabled=no" % module.name)
PYTHON
}

# build_without_device SANITIZERS TARGET...: modules that need no device, built with sanitizers. Parts may call it at the same time.
build_without_device() {
    local sanitizers=$1 options
    shift
    mapfile -t options < <(list_device_options)
    flock "$work/build.$sanitizers" scons -Q -j"$jobs" compiledb=no sanitize="$sanitizers" "${options[@]}" "$@"
}

# run_sanitized PART SANITIZERS TEST_OPTION...: tests the modules that need no device. First the sanitizers must report the
# deliberate errors of the canaries.
run_sanitized() {
    local part=$1 sanitizers=$2 suffix=release_${2//,/_}
    shift 2
    run_check "$part build" build_without_device "$sanitizers" "bin/gnomon_tests.$suffix" canaries || return
    run_part "$part canary" python3 tests/canaries/test_canaries.py "$sanitizers"
    run_part "$part" python3 tests/run_engine.py --processes "$jobs" "bin/gnomon_tests.$suffix" -- '--test-case-exclude=*[GPU]*' "$@"
}

check_layout() {
    find modules tests -name '*.cpp' -print0 -o -name '*.h' -print0 | xargs -0 clang-format --dry-run -Werror
}
part_layers() {
    run_part layers python3 tests/layers/test_layers.py
    run_part "layers canary" python3 tests/layers/test_layers.py --self-test
    run_check "layout" check_layout
}
part_scenes() {
    run_part scenes python3 tests/run_unittest.py tests/demo/test_scenes.py tests/demo/test_artist_scenes.py tests/demo/test_valley.py \
        tests/demo/test_foliage_scenes.py tests/demo/test_animated_casters.py \
        tests/demo/test_package_meshes.py tests/demo/test_run_demo.py
}
part_docs() {
    run_part docs python3 tests/run_unittest.py tests/docs/test_docs.py
}
part_engine() {
    run_part "engine slices" python3 tests/run_unittest.py tests/canaries/test_engine_slices.py
    run_part engine python3 tests/run_engine.py bin/gnomon_tests --processes "$jobs"
}
part_embed() {
    run_part embed python3 tests/run_unittest.py tests/embed/test_embed.py
}
part_drivers() {
    run_part drivers python3 tests/run_unittest.py tests/benchmark/test_counted_work.py tests/drivers/test_spirv.py tests/drivers/test_amd.py \
        tests/drivers/test_llvmpipe.py tests/drivers/test_swiftshader.py
}
part_command_line() {
    run_part "command line" python3 tests/run_unittest.py tests/command_line/test_bad_input.py tests/command_line/test_probe.py \
        tests/command_line/test_good_commands.py tests/command_line/test_downloaded_models.py tests/command_line/test_animation.py \
        tests/command_line/test_report.py tests/command_line/test_stopped_report.py \
        tests/command_line/test_device_failures.py tests/command_line/test_memory_patterns.py \
        tests/command_line/test_kills.py
}
part_editor() {
    run_part editor python3 tests/run_unittest.py tests/command_line/test_window.py tests/command_line/test_editor.py \
        tests/command_line/test_editor_views.py tests/command_line/test_editor_safety.py \
        tests/command_line/test_editor_materials.py tests/command_line/test_editor_staging.py \
        tests/command_line/test_editor_timeline.py
}
part_blender() {
    run_part blender python3 tests/run_unittest.py tests/blender/test_export.py tests/blender/test_round_trip.py
}
part_demo() {
    # Without --all the demo draws one of the package meshes; "stability" draws more, and "tables" all of them. Shaders are
    # optimised (no GALLIVM_PERF), because the demo draws many frames with each.
    run_check demo env -u GALLIVM_PERF demo_project/run_demo.sh --no-build --size 128x128 --samples 64 --frames 3 --no-window --out "$work/demo"
}
part_bundle() {
    run_part bundle python3 tests/run_unittest.py tests/benchmark/test_bundle.py
}
part_stability() {
    run_part stability python3 tests/run_unittest.py tests/stability/test_stability.py tests/stability/test_untuned_meshes.py
}
part_removal() {
    if [ "$is_full" = yes ]; then
        run_part removal python3 tests/removal/test_removal.py --jobs "$jobs" --all
        run_part "smallest game" python3 tests/removal/test_minimal.py --jobs "$jobs"
    else
        run_part removal python3 tests/removal/test_removal.py --jobs "$jobs"
        run_part "smallest game" python3 tests/removal/test_minimal.py --plan
    fi
}
part_template() {
    run_part template python3 tests/run_unittest.py tests/template/test_add_a_technique.py
}
part_sanitized() {
    run_sanitized sanitized address,undefined
}
part_fuzz_replay() {
    if run_check "fuzz_replay build" build_without_device address,undefined fuzz_targets; then
        run_part "fuzz_replay canary" python3 tests/canaries/test_replay.py release_address_undefined
        run_part fuzz_replay python3 tests/fuzz/replay_corpus.py release_address_undefined
    fi
}
part_godot_set_up() {
    run_check "godot set-up" install_godot "$root"
}
part_godot_device() {
    run_part "godot device" python3 tests/godot/test_godot.py
    # llvmpipe with subgroups of 4 invocations, as on arm64; other drivers ignore the variable.
    run_part "subgroups of 4" env LP_NATIVE_VECTOR_WIDTH=128 python3 tests/godot/test_godot.py '--source-file=*test_edge_count_mask.cpp'
}
part_godot_addon() {
    run_part "godot add-on" python3 tests/godot/test_addon.py
}
part_godot_games() {
    run_part "godot games" python3 tests/godot/test_games.py
}
part_godot_masks() {
    run_part "godot masks" python3 tests/godot/test_masks.py
}
part_godot_editor() {
    run_part "godot editor" python3 tests/godot/test_editor.py
}
part_godot_soak() {
    local options=()
    [ "$is_full" = yes ] && options=(--full)
    # Optimised shaders (no GALLIVM_PERF): the test draws many frames with each.
    run_part "godot soak" env -u GALLIVM_PERF python3 tests/godot/test_soak.py "${options[@]}"
}
part_windows() {
    run_part windows python3 tests/run_unittest.py tests/platforms/test_libraries.py tests/platforms/test_saves.py \
        tests/godot/host/test_host.py tests/godot/test_missing_library.py
}
part_windows_set_up() {
    run_check "arm64 set-up" install_godot_arm64 "$root"
}
part_windows_arm64() {
    local options=()
    [ "$is_full" = yes ] && options=(--full)
    run_part "windows arm64" python3 tests/godot/test_arm64.py "${options[@]}"
}
part_windows_program() {
    # A Wine of its own, because the part windows ends the one that it started.
    export GNOMON_WINE_FOLDER=$root/build/wine_program
    GNOMON_ALL_MASKS=$is_full run_part "windows program" python3 tests/run_unittest.py tests/platforms/test_program.py
    run_part "windows engine" python3 tests/run_engine.py --processes "$jobs" bin/gnomon_tests.exe
}
part_separate_files() {
    run_part "separate files" python3 tests/separate_files/test_separate_files.py --processes "$jobs"
}
part_sanitized_all() {
    run_check "all sanitized build" scons -Q -j"$jobs" compiledb=no sanitize=address,undefined &&
        run_part "all sanitized" env ASAN_OPTIONS=detect_leaks=0 bin/gnomon_tests.release_address_undefined # Mesa leaks
}
part_threads() {
    run_sanitized threads thread
}
part_fuzz() {
    run_check "fuzz build" scons -Q -j"$jobs" compiledb=no fuzz=yes &&
        run_part fuzz python3 tests/fuzz/run_fuzz.py --jobs "$jobs"
}
part_tables() {
    run_check tables demo_project/run_demo.sh --all --no-build --samples 9216 --no-window
}
part_large_meshes() {
    run_part "large meshes" python3 tests/run_unittest.py tests/stability/test_large_meshes.py
}
part_validator() {
    run_part validator python3 tests/run_unittest.py tests/gltf/test_validator.py
}
part_soak() {
    run_part soak python3 tests/stability/run_soak.py bin/gnomon_tests
}
part_extremes() {
    STABILITY_EXTENT=full run_part extremes python3 tests/run_unittest.py tests/stability/test_stability.py \
        tests/stability/test_untuned_meshes.py
}
part_kills() {
    GNOMON_KILL_COUNT=200 run_part "kills, engine" bin/gnomon_tests '--test-case=*killed at a random time*'
    GNOMON_KILL_COUNT=200 run_part kills python3 tests/run_unittest.py tests/command_line/test_kills.py \
        tests/command_line/test_device_failures.py
}
part_editor_repeats() {
    # These tests depend on windows, the mouse and other processes, so they may pass once and fail the next time.
    local repeat
    for repeat in 1 2 3 4 5 6 7 8 9 10; do
        part_editor
    done
}

# shellcheck source=demo_project/install_godot.sh
. demo_project/install_godot.sh
# shellcheck source=demo_project/install_godot_arm64.sh
. demo_project/install_godot_arm64.sh
run_parts layers scenes
run_parts godot_set_up windows_set_up & # next to the build
set_up=$!
# The parts below run the programs that are built here. Nothing runs at the same time: a test might use a half-built program.
name=build
part_begin=$SECONDS
if is_requested build; then
    run_check build scons -Q -j"$jobs" || finish
fi
wait "$set_up"
part_begin=$SECONDS
if is_requested godot_build && install_godot "$root"; then # it exports $GODOT, and $GODOT_TEMPLATE and $GODOT_RUN
    run_check "godot build" scons -Q -j"$jobs" compiledb=no godot=yes || has_godot=no
fi
part_begin=$SECONDS
if is_requested windows_build && install_godot "$root"; then
    run_check "windows build" scons -Q -j"$jobs" compiledb=no addon_zip=yes bin/gnomon_godot_addon.zip platform_programs || has_windows=no
fi
part_begin=$SECONDS
if is_requested windows_program; then
    run_check "windows program build" scons -Q -j"$jobs" compiledb=no platform=windows godot=no || has_windows_program=no
fi
# Long parts are first.
run_parts sanitized godot_addon windows_program engine command_line godot_masks godot_games windows_arm64 editor drivers godot_soak removal godot_editor \
    stability godot_device demo bundle fuzz_replay windows embed docs template
# Only on request: the package is large.
if [ ${#only[@]} -gt 0 ]; then
    run_parts blender
fi
if [ "$is_full" = yes ]; then
    for part in separate_files sanitized_all threads tables fuzz large_meshes validator soak extremes kills editor_repeats; do
        run_parts "$part"
    done
fi
finish
