#!/usr/bin/env python3
"""Compiles every compute pipeline with AMD's compiler, without a GPU, and compares the result with a stored table.

    amd_pipelines.py            prints what has changed; the exit code is 1 if a pipeline breaks a rule
    amd_pipelines.py --update   writes amd_pipelines.csv and its short form in doc/testing.md

Needs bin/gnomon_pipelines, the SPIR-V of the release build, and RADV of Debian 12's mesa-vulkan-drivers, which compiles for
any AMD GPU on a null device.
"""

import argparse
import csv
import glob
import itertools
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

from nir_divergence import BARRIER, find_subgroup_operations

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))
sys.path[1:1] = [os.path.join(ROOT, "shaders"), os.path.join(ROOT, "tests", "benchmark")]
import spirv_phis  # noqa: E402
from driver import format_table, write_table  # noqa: E402

PROGRAM = os.path.join(ROOT, "bin", "gnomon_pipelines")
SPIRV = os.path.join(ROOT, "build", "release", "shaders")
TABLE = os.path.join(FOLDER, "amd_pipelines.csv")
PAGE = os.path.join(ROOT, "doc", "testing.md")
DRIVERS = "/usr/share/vulkan/icd.d/radeon_icd*.json"
TIMEOUT_S = 1800
FAMILIES = ("NAVI23", "VANGOGH", "GFX1100")  # RX 6600, Steam Deck, RX 7900
MAX_GROWTH = 1.1  # of the number of instructions
# Mesa 22.3 makes a loop of each shuffle on RDNA 3. So there its NIR does not show the shader's own control flow, and shaders
# that pass edges by shuffles spill registers: that may not grow beyond the table, as with instructions.
LOOPING_SHUFFLES = "GFX1100"
SPILLING = ("shadow_edge_count/resolve", "shadow_edge_count/debug")
# Specialization constants: per folder or shader, the values of each id that the program uses. A shader gets each combination
# of the ids that it has. A function computes the value from the others.
SUBGROUP = "subgroup"  # the size that the engine requests
EDGE_COUNT = {0: (SUBGROUP,), 1: (1, 4), 2: (0, 1), 3: (0, 1), 5: (0, 1), 6: (0,), 7: (1,)}
CONSTANTS = {
    # 0 subgroup size; 1 sets of 64 points; 2 leaves without lists; 3 directional; 4 invocations of a work group; 5 casters may
    # cut the light's disc; 6 a CPU driver; 7 a time budget; 8 smooth leaves
    "shadow_edge_count": EDGE_COUNT | {4: (lambda constants: 64 * constants[1],)},
    "shadow_edge_count/bound_nodes": {9: (1, 4)},  # the lowest level
    "shadow_edge_count/debug": EDGE_COUNT | {1: (1,), 4: (64,)},
    "shadow_edge_count/resolve_few_pixels": EDGE_COUNT | {4: (lambda constants: 16 * constants[1],), 8: (0, 1)},
    "shadow_edge_count/resolve_unfinished": EDGE_COUNT | {4: (SUBGROUP,)},
    "shadow_map/resolve": {0: (0, 3)},  # width of the filter
    # 1 inner fins; 2 layers; 3 curve; 4 visibility begins at 0
    "shadow_penumbra_fins": {1: (0, 1), 2: (3,), 3: (0,), 4: (0, 1)},
    "renderer": {0: (0, 1)},  # coloured masks
    "shadows": {0: (0, 1)},
}
# Combinations that the program never uses: a directional light has no disc, leaves with few counted pixels have lists, and those
# that are not smooth have 64 points; unfinished leaves have no lists.
IMPOSSIBLE = (
    ("shadow_edge_count/", {3: 1, 5: 1}),
    ("shadow_edge_count/resolve_few_pixels", {2: 1}),
    ("shadow_edge_count/resolve_few_pixels", {1: 4, 8: 0}),
    ("shadow_edge_count/resolve_unfinished", {2: 0}),
)
# Columns of the table, and the names of RADV's statistics.
STATISTICS = {
    "VGPRs": "VGPRs",
    "SGPRs": "SGPRs",
    "spilled VGPRs": "Spilled VGPRs",
    "spilled SGPRs": "Spilled SGPRs",
    "scratch B": "Scratch size",
    "LDS B": "LDS size",
    "waves per SIMD": "Subgroups per SIMD",
    "code B": "Code size",
    "instructions": "Instructions",
}
COLUMNS = ("family", "shader", "constants", "wave", *STATISTICS, "compile ms")
# Rows of the short form in doc/testing.md: one family, one spot light, with lists.
SHOWN_FAMILY = "NAVI23"
SHOWN_COLUMNS = ("VGPRs", "spilled SGPRs", "LDS B", "waves per SIMD", "instructions")


class PipelineError(Exception):
    """The pipelines cannot be compiled; the text says what to do."""


def inspect(path):
    """Return (sorted ids of the specialization constants, whether there are subgroup operations) of a SPIR-V file."""
    op_capability, subgroup_capabilities, op_decorate, spec_id = 17, range(61, 69), 71, 1
    words, at, ids, uses_subgroups = spirv_phis.load_words(path), spirv_phis.HEADER_WORDS, set(), False
    while at < len(words):
        op = words[at] & 0xFFFF
        if op == op_decorate and words[at + 2] == spec_id:
            ids.add(words[at + 3])
        uses_subgroups = uses_subgroups or (op == op_capability and words[at + 1] in subgroup_capabilities)
        at += words[at] >> 16
    return sorted(ids), uses_subgroups


def list_constants(shader, ids):
    """Return the combinations of constants, each a dict, with which the program uses a shader. Unknown ids are an error."""
    known = CONSTANTS.get(shader.removesuffix(".storage"), CONSTANTS.get(shader.split("/")[0], {}))
    for number in ids:
        if number not in known:
            raise PipelineError("%s has the specialization constant %d. Add its values to CONSTANTS." % (shader, number))
    found = []
    for values in itertools.product(*(known[number] for number in ids)):
        constants = dict(zip(ids, values))
        constants = {number: value(constants) if callable(value) else value for number, value in constants.items()}
        if not any(
            shader.startswith(prefix) and all(constants.get(number) == value for number, value in pattern.items())
            for prefix, pattern in IMPOSSIBLE
        ):
            found.append(constants)
    return found


def list_jobs(family):
    """Return (label, shader, constants as text, path) of each compute pipeline. The variants for devices with few texels per
    buffer are compiled for one family only."""
    jobs = []
    for path in sorted(glob.glob(os.path.join(SPIRV, "*", "*.comp.spv"))):
        shader = os.path.relpath(path, SPIRV)[: -len(".comp.spv")]
        if shader.endswith(".storage") and family != SHOWN_FAMILY:
            continue
        for constants in list_constants(shader, inspect(path)[0]):
            text = " ".join("%d=%s" % item for item in sorted(constants.items()))
            label = "_".join([shader, *text.split()]).replace("/", ".")
            jobs.append((label, shader, text, path))
    if not jobs:
        raise PipelineError("There is no SPIR-V in %s. Build with scons." % SPIRV)
    return jobs


def compile_jobs(family, jobs):
    """Return (device, list of results): per job the driver's statistics, and under "divergent" the lines of the NIR with
    subgroup operations in divergent flow. jobs: (label, shader, constants as text, path)."""
    drivers = glob.glob(DRIVERS)
    if not drivers:
        raise PipelineError("RADV is not installed: no file %s. Install mesa-vulkan-drivers." % DRIVERS)
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, RADV_FORCE_FAMILY=family, VK_ICD_FILENAMES=drivers[0], MESA_SHADER_CACHE_DISABLE="true")
        environment["XDG_RUNTIME_DIR"] = folder
        lines = "".join("%s %s %s\n" % (label, path, text) for label, _, text, path in jobs)
        result = subprocess.run([PROGRAM, "--nir", folder], input=lines, capture_output=True, text=True, env=environment,
                                timeout=TIMEOUT_S, check=False)  # fmt: skip
        if result.returncode != 0:
            raise PipelineError("%s ended with %d for %s: %s" % (PROGRAM, result.returncode, family, result.stderr))
        device, *results = [json.loads(line) for line in result.stdout.splitlines()]
        for found, (_, _, _, path) in zip(results, jobs):
            with open(os.path.join(folder, found["label"] + ".txt"), encoding="utf-8") as file:
                operations = find_subgroup_operations(file.read())
            if not inspect(path)[1]:  # the compiler adds its own operations to atomic ones
                operations = [operation for operation in operations if BARRIER in operation[1]]
            found["operations"] = len(operations)
            found["divergent"] = [words for _, words, is_divergent in operations if is_divergent and family != LOOPING_SHUFFLES]
    return device, results


def make_row(family, job, result):
    """Return a pipeline's row of the table, all values as text, as they are read back."""
    _, shader, constants, _ = job
    values = [family, shader, constants, result["subgroup_size"], *(result[name] for name in STATISTICS.values())]
    return dict(zip(COLUMNS, (str(value) for value in (*values, result["compile_ms"]))))


def find_breaches(row, result, stored):
    """Return the rules that a pipeline breaks, as sentences. stored: its row of the table; None if there is none."""
    name = " ".join((row["family"], row["shader"], row["constants"])).strip()
    breaches = []
    may_spill = stored is not None and row["family"] == LOOPING_SHUFFLES and row["shader"].startswith(SPILLING)
    for column in ("spilled VGPRs", "scratch B"):
        limit = int(MAX_GROWTH * int(stored[column])) if may_spill else 0
        if int(row[column]) > limit:
            breaches.append("%s: %s is %s, must be at most %d" % (name, column, row[column], limit))
    for words in result["divergent"]:
        breaches.append("%s: a subgroup operation is in divergent flow: %s" % (name, words))
    if stored is None:
        breaches.append("%s is not in amd_pipelines.csv. Run tests/drivers/amd_pipelines.py --update" % name)
    elif int(row["instructions"]) > MAX_GROWTH * int(stored["instructions"]):
        breaches.append("%s: %s instructions, at most 10 %% more than %s are allowed. Make it smaller, or run "
                        "tests/drivers/amd_pipelines.py --update and state the reason in the commit"
                        % (name, row["instructions"], stored["instructions"]))  # fmt: skip
    return breaches


def get_key(row):
    return row["family"], row["shader"], row["constants"]


def load_table():
    """Return (driver version, rows by key) of the stored table; (None, {}) without one."""
    if not os.path.exists(TABLE):
        return None, {}
    with open(TABLE, encoding="utf-8", newline="") as file:
        version = file.readline().strip().removeprefix("# RADV of Mesa ")
        return version, {get_key(row): row for row in csv.DictReader(file)}


def save_table(version, rows):
    with open(TABLE, "w", encoding="utf-8", newline="") as file:
        file.write("# RADV of Mesa %s\n" % version)
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def make_short_table(version, rows):
    """Return the lines of the table in doc/testing.md: the widest pipeline of each shader, by instructions."""
    widest = {}
    for row in rows:
        if row["family"] == SHOWN_FAMILY and not row["shader"].endswith(".storage"):
            other = widest.get(row["shader"])
            if other is None or int(row["instructions"]) > int(other["instructions"]):
                widest[row["shader"]] = row
    large = [row for row in widest.values() if int(row["instructions"]) >= 1000 or row["shader"].endswith("/resolve")]
    large.sort(key=lambda row: (-int(row["instructions"]), row["shader"]))
    rows = [(row["shader"], *(row[column] for column in SHOWN_COLUMNS)) for row in large]
    return format_table(("pipeline (%s, Mesa %s)" % (SHOWN_FAMILY, version), *SHOWN_COLUMNS), rows)


def keep_times(row, stored):
    """Return the stored row if the pipeline is the same, whose compile time alone differs from run to run; else the new one."""
    is_same = stored is not None and all(str(row[column]) == stored[column] for column in COLUMNS if column != "compile ms")
    return stored if is_same else row


def measure(family):
    """Return (driver version, list of (row, result)) of all pipelines of a family."""
    jobs = list_jobs(family)
    device, results = compile_jobs(family, jobs)
    return device["driver_version"], [(make_row(family, job, result), result) for job, result in zip(jobs, results)]


def measure_all():
    """Return (driver version, list of (row, result)) of all families, which are compiled at the same time."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        measured = list(pool.map(measure, FAMILIES))
    return measured[0][0], [pair for _, pairs in measured for pair in pairs]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--update", action="store_true", help="write the table instead of comparing with it")
    arguments = parser.parse_args()
    try:
        version, measured = measure_all()
        if arguments.update:
            _, stored = load_table()
            rows = [keep_times(row, stored.get(get_key(row))) for row, _ in measured]
            save_table(version, rows)
            write_table("pipelines", make_short_table(version, rows), PAGE)
        _, stored = load_table()
    except PipelineError as error:
        print("ERROR: %s" % error, file=sys.stderr)
        return 1
    breaches = []
    for row, result in measured:
        breaches += find_breaches(row, result, stored.get(get_key(row)))
    print("\n".join(breaches + ["%d pipelines, %d breaches" % (len(measured), len(breaches))]))
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
