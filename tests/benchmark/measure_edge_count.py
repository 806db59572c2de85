#!/usr/bin/env python3
"""Measures edge_count against its goals and writes the tables of doc/benchmarks.md: about an hour and a half.

    measure_edge_count.py [PART]... [--groups A,B] [--rounds N] [--write]

Parts: errors wrong hard times memory motion; default: all. Each part has its own table; errors and wrong have one per
group. A table is written as soon as it is measured. The images are those of edge_count_images.py. References are traced
once (the program caches them). With --groups the goals cover only these groups, and --write works only for the parts errors
and wrong. Build first: scons.
"""

import argparse
import json
import math
import os
import re
import statistics
import sys
import tempfile

import driver
from edge_count_images import ARTISTS, GROUPS, LARGE_FRACTION, PACKAGES, PLAIN, STUDY, SUN, Image, make_images
from mask_file import load_mask
from measure_techniques import find_reference
from driver import format_yes_no, describe_machine, format_table, publish_tables, run

GNOMON = os.path.abspath(os.environ.get("GNOMON", driver.PROGRAM))

RATE_BASE = 100_000  # wrong receivers are counted per this number of receivers
FINE_SAMPLES = 9216  # reference rays per pixel that resolve errors below 0.004
USUAL_SAMPLES = 1024  # reference rays per pixel that resolve errors above 0.2
ERROR_SIZES = {STUDY: "512x512", PLAIN: "400x400", PACKAGES: "400x400", ARTISTS: "400x400"}
MAE_GOALS = {STUDY: (0.0014, 0.0072), PACKAGES: (0.0025, 0.006), ARTISTS: (0.0025, 0.006)}  # limits of the mean and of the worst image
WRONG_SIZE = "1280x720"
MASK_SIZE = "400x400"
TIME_SIZES = {STUDY: "512x512", PLAIN: "800x800", PACKAGES: "512x512", ARTISTS: "512x512"}
TIMED_FRAMES = 20
PCSS = ("pcss", ("pcss_taps=64",))
RECEIVERS_PASS = "receivers"  # a pass of the shadow system, the same for every technique
GRASS = "grass"  # this scene has goals for errors, but not for times
MEMORY_SIZE = "1920x1080"
SMALLEST_SIZE = "16x16"
# A technique with a tiny map (1 KB per view). Its memory is what every technique needs: G-buffer, receivers, mask.
BASELINE = ("shadow_map", ("shadow_map_size=16",))
MB = 1e6
MOTION_SCENES = ("kitbash", "rigging")
MOTION_FRAMES = 6
MOTION_M = ("0.004", "0.0", "0.003")  # movement of the light per frame: 5 mm
MOTION_SAMPLES = 256
SHOWN_PASSES = 3


def report_progress(*words):
    print(*words, file=sys.stderr, flush=True)


def compare(reference, mask):
    return json.loads(run([GNOMON, "compare", reference, mask]))


class Goals:
    """Rows of a table that compares measured values with their goals."""

    def __init__(self):
        self.rows = []

    def add(self, what, limit, measured, form="%.4f", worst=""):
        self.rows.append((what, "<= %g" % limit, (form % measured) + worst, format_yes_no(measured <= limit)))

    def add_mean(self, what, limit, values, form="%.4f"):
        """values: image name -> value, here and in the methods below. Adds no row if they are empty."""
        if values:
            self.add(what + ", mean", limit, statistics.fmean(values.values()), form)

    def add_geometric_mean(self, what, limit, values):
        if values:
            self.add(what + ", geometric mean", limit, statistics.geometric_mean(values.values()), "%.2f")

    def add_worst(self, what, limit, values, form="%.2f"):
        if values:
            worst = max(values, key=values.get)
            self.add(what + ", worst", limit, values[worst], form, " (%s)" % worst)

    def format(self):
        return format_table(("what", "goal", "measured", "met"), self.rows)


def select(images, *groups):
    return [image for image in images if image.group in groups]


def find_sources(images):
    """Return one image for each scene and light."""
    return list({(image.group, image.source): image for image in images}.values())


def trace(image, size, samples, out):
    reference = find_reference()
    image.draw(GNOMON, reference, ("%s_samples=%d" % (reference, samples),), size, out)


def count_wrong(found):
    """Return the number of receivers with an error above 0.2. found: result of compare(), here and below."""
    return round(found["receiver"]["wrong"] * found["pixels"])


class WrongReceivers:
    """Counts, for each group, the receivers with an error above 0.2."""

    def __init__(self):
        self.counts = {}

    def add(self, group, found):
        wrong, pixels = self.counts.get(group, (0, 0))
        self.counts[group] = wrong + count_wrong(found), pixels + found["pixels"]

    def add_goals(self, goals):
        for group, (wrong, pixels) in self.counts.items():
            goals.add("receivers off by more than 0.2 in %d, %s" % (RATE_BASE, group), 1, wrong / pixels * RATE_BASE, "%.2f")


def measure_errors(images, folder, _rounds):
    """Measure penumbra errors, and receivers with an error above 0.2."""
    reference, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    mae, wrong, rows = {}, WrongReceivers(), []
    for image in images:
        size = ERROR_SIZES[image.group]
        trace(image, size, FINE_SAMPLES, reference)
        errors = []
        for technique, settings in (("edge_count", ()), ("edge_count", ("edge_count_quality=64",)), PCSS):
            image.draw(GNOMON, technique, settings, size, mask)
            errors.append(compare(reference, mask))
        wrong.add(image.group, errors[0])
        own, coarse, pcss = (error["penumbra"] for error in errors)
        mae[image] = own["mae"]
        numbers = (own["mae"], own["p99"], own["umbra_over"], coarse["mae"], pcss["mae"])
        rows.append((image.name, *("%.4f" % number for number in numbers), count_wrong(errors[0]), count_wrong(errors[2])))
        report_progress("errors of %s: %s" % (image.name, rows[-1]))
    goals = Goals()
    for group, (mean, worst) in MAE_GOALS.items():
        of_group = {image.name: mae[image] for image in select(images, group)}
        goals.add_mean("penumbra MAE, " + group, mean, of_group)
        goals.add_worst("penumbra MAE, " + group, worst, of_group, "%.4f")
    wrong.add_goals(goals)
    header = ("image", "MAE", "p99", "`umbra_over`", "MAE of 64 points", "MAE of `pcss`", "wrong", "wrong of `pcss`")
    return [*goals.format(), "", *format_table(header, rows)]


def measure_wrong(images, folder, _rounds):
    """Count receivers with an error above 0.2 in large images."""
    reference, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    goals, wrong, rows = Goals(), WrongReceivers(), []
    for image in images:
        trace(image, WRONG_SIZE, USUAL_SAMPLES, reference)
        image.draw(GNOMON, "edge_count", (), WRONG_SIZE, mask)
        found = compare(reference, mask)
        wrong.add(image.group, found)
        report_progress("wrong in %s: %d of %d" % (image.name, count_wrong(found), found["pixels"]))
        if count_wrong(found) > 0:
            rows.append((image.name, count_wrong(found), found["pixels"]))
    wrong.add_goals(goals)
    return [*goals.format(), "", *(format_table(("image", "wrong", "receivers"), rows) if rows else ["No image has a receiver that is off by more than 0.2."])]


def measure_hard(images, folder, _rounds):
    """Compare hard shadows, of a light of size 0, with traced ones."""
    reference, mask = os.path.join(folder, "reference.exr"), os.path.join(folder, "mask.exr")
    goals, rows = Goals(), []
    for technique, limit in (("edge_count", 2), ("shadow_volume", 20)):
        wrong, pixels = 0, 0
        for source in find_sources(images):
            image = Image(source.group, source.path, source.light, 0.0)
            trace(image, MASK_SIZE, 1, reference)
            image.draw(GNOMON, technique, (), MASK_SIZE, mask)
            found = compare(reference, mask)
            count = count_wrong(found)
            wrong, pixels = wrong + count, pixels + found["pixels"]
            report_progress("hard shadow of %s, %s: %d of %d" % (image.name, technique, count, found["pixels"]))
            if count > 0:
                rows.append((image.name, technique, count, found["pixels"]))
        goals.add("hard shadow: wrong receivers in %d, %s" % (RATE_BASE, technique), limit, wrong / pixels * RATE_BASE, "%.2f")
    return [*goals.format(), "", *(format_table(("image", "technique", "wrong", "receivers"), rows) if rows else ["No image has a receiver that is off by more than 0.2."])]


def get_pass_times(result, clock):
    """Return pass name -> ms, without RECEIVERS_PASS. The views of a light are summed. clock: gpu_ms or wall_ms."""
    if all(item["name"] != RECEIVERS_PASS for item in result["passes"]):
        names = ", ".join(item["name"] for item in result["passes"])
        raise SystemExit("ERROR: the measured light has no pass %s. Its passes: %s. Change RECEIVERS_PASS." % (RECEIVERS_PASS, names))
    times = {}
    for item in result["passes"]:
        if item["name"] != RECEIVERS_PASS:
            name = re.sub(r" view \d+$", "", item["name"])
            times[name] = times.get(name, 0.0) + item["wall_ms" if item["is_on_host"] else clock]
    return times


class Timing:
    """Timings of one image. Each round measures edge_count and then pcss, so that the machine's load affects both times
    of a ratio alike."""

    def __init__(self, image):
        self.image = image
        self.rounds = []  # of (result of edge_count, result of pcss)

    def measure(self, folder):
        mask = os.path.join(folder, "mask.exr")
        size = TIME_SIZES[self.image.group]
        results = tuple(
            self.image.draw(GNOMON, technique, settings, size, mask, "--timed-frames", str(TIMED_FRAMES))
            for technique, settings in (("edge_count", ()), PCSS)
        )
        self.rounds.append(results)

    def compute_ratio(self, clock="gpu_ms"):
        sums = [[sum(get_pass_times(result, clock).values()) for result in results] for results in self.rounds]
        return statistics.median(own / pcss for own, pcss in sums)

    def find_passes(self):
        """Return (pass name, median ms) pairs, the longest first."""
        times = [get_pass_times(own, "gpu_ms") for own, _ in self.rounds]
        names = {name for passes in times for name in passes}
        medians = {name: statistics.median(passes.get(name, 0.0) for passes in times) for name in names}
        return sorted(medians.items(), key=lambda item: -item[1])


def measure_times(images, folder, rounds):
    """Measure the time of edge_count divided by that of pcss."""
    is_timed_at_all_sizes = {STUDY: True, PLAIN: True, PACKAGES: False, ARTISTS: False}  # whether a group is timed at all light sizes
    timings = [
        Timing(image)
        for image in images
        if image.scene != GRASS and (is_timed_at_all_sizes[image.group] or image.radius_fraction == LARGE_FRACTION)
    ]
    for index in range(rounds):
        for timing in timings:
            timing.measure(folder)
            report_progress("round %d of %d: %s: %.2f" % (index + 1, rounds, timing.image.name, timing.compute_ratio()))
    goals = Goals()

    def get_ratios(group, light=None, clock="gpu_ms"):
        return {
            timing.image.name: timing.compute_ratio(clock)
            for timing in timings
            if timing.image.group == group and light in (None, timing.image.light)
        }

    goals.add_geometric_mean("time over `pcss`, study scenes", 0.28, get_ratios(STUDY))
    for light, limit in (("Omni", 0.22), ("Spot", 0.2), ("Sun", 0.15)):
        goals.add_worst("the same, one box and one torus, " + light, limit, get_ratios(PLAIN, light))
    goals.add_geometric_mean("the same, package meshes, R = 10 %", 0.3, get_ratios(PACKAGES))
    goals.add_worst("the same, kitbash and rigging", 1.3, get_ratios(ARTISTS))
    goals.add_worst("the same, wall time", 1.3, get_ratios(ARTISTS, clock="wall_ms"))
    rows = []
    for timing in timings:
        passes = timing.find_passes()
        longest = ", ".join("%s %.1f" % item for item in passes[:SHOWN_PASSES])
        rows.append((timing.image.name, "%.1f" % sum(ms for _, ms in passes), "%.2f" % timing.compute_ratio(), longest))
    return [*goals.format(), "", *format_table(("image", "ms", "over `pcss`", "longest passes, ms"), rows)]


def measure_memory(images, folder, _rounds):
    """Measure the memory of a light in MB, beyond what every technique needs."""
    mask = os.path.join(folder, "mask.exr")
    used = {}
    for image in find_sources([image for image in images if math.isclose(image.radius_fraction, LARGE_FRACTION)]):

        def measure_bytes(size, image=image):
            own, baseline = (
                image.draw(GNOMON, technique, settings, size, mask, "--timed-frames", "1")["bytes"]
                for technique, settings in (("edge_count", ()), BASELINE)
            )
            return own - baseline

        # `bytes` counts cached memory once and transient memory twice: for the frame that reads the mask back, and for
        # the timed frames. Only transient memory grows with the image, so the mean of both sizes counts each once.
        used[image.source] = statistics.fmean(map(measure_bytes, (SMALLEST_SIZE, MEMORY_SIZE))) / MB
        report_progress("memory of %s: %.1f MB" % (image.source, used[image.source]))
    goals = Goals()
    goals.add_worst("MB of a light at %s" % MEMORY_SIZE.replace("x", " x "), 48, used, "%.1f")
    return goals.format()


def list_frames(path, count):
    stem, ending = os.path.splitext(path)
    return ["%s.%04d%s" % (stem, index, ending) for index in range(count)]


def compute_rmse(errors, pixels):
    return math.sqrt(statistics.fmean(errors[i] * errors[i] for i in pixels))


def measure_motion(images, folder, _rounds):
    """Measure the temporal error: the RMSE, over penumbra pixels, of the difference between the mask's change from one frame to
    the next and the reference's change. It is compared with that of a reference of few samples whose pattern is random in
    each frame: sqrt(2) times its RMSE in one frame, because its errors in two frames are independent."""
    reference_id = find_reference()
    techniques = {
        "reference": (reference_id, ("%s_samples=%d" % (reference_id, FINE_SAMPLES),)),
        "few": (reference_id, ("%s_samples=%d" % (reference_id, MOTION_SAMPLES),)),
        "edge_count": ("edge_count", ()),
    }
    ratios, rows = {}, []
    for image in images:
        # A sun has no position to move.
        if image.scene not in MOTION_SCENES or image.radius_fraction != LARGE_FRACTION or image.light == SUN:
            continue
        frames = {}
        for name, (technique, settings) in techniques.items():
            out = os.path.join(folder, name + ".exr")
            image.draw(GNOMON, technique, settings, MASK_SIZE, out, "--frames", str(MOTION_FRAMES), "--motion", *MOTION_M)
            frames[name] = [load_mask(path) for path in list_frames(out, MOTION_FRAMES)]
        errors = {
            name: [
                [v - w for v, w in zip(mask.visibility, reference.visibility)]
                for mask, reference in zip(frames[name], frames["reference"])
            ]
            for name in ("few", "edge_count")
        }
        pixels = frames["reference"][0].find_penumbra()
        few = math.sqrt(2) * statistics.fmean(compute_rmse(error, pixels) for error in errors["few"])
        changes = [[b - a for a, b in zip(*pair)] for pair in zip(errors["edge_count"], errors["edge_count"][1:])]
        own = statistics.fmean(compute_rmse(change, pixels) for change in changes)
        ratios[image.source] = own / few
        rows.append((image.source, "%.4f" % own, "%.4f" % few))
        report_progress("temporal error of %s: %.4f, few samples %.4f" % (image.source, own, few))
    goals = Goals()
    what = "temporal error over that of %d samples" % MOTION_SAMPLES
    goals.add_worst(what, 1.1, ratios)
    header = ("image", "temporal error", "of %d samples, a new pattern each frame" % MOTION_SAMPLES)
    return [*goals.format(), "", *format_table(header, rows)]


PARTS = {
    "errors": measure_errors,
    "wrong": measure_wrong,
    "hard": measure_hard,
    "times": measure_times,
    "memory": measure_memory,
    "motion": measure_motion,
}
PARTS_BY_GROUP = ("errors", "wrong")  # slow parts: each group has its own table, written as soon as it is measured


def main():
    parser = argparse.ArgumentParser(description="Measures edge_count against its goals; see doc/benchmarks.md.")
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--groups", default=",".join(GROUPS), metavar="A,B", help="groups of images (default: %(default)s)")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="rounds of timing (default: %(default)s)")
    parser.add_argument("--write", action="store_true", help="write the tables into doc/benchmarks.md")
    arguments = parser.parse_args()
    if arguments.rounds < 1:
        parser.error("--rounds is %d, must be 1 or more" % arguments.rounds)
    unknown = [part for part in arguments.parts if part not in PARTS]
    if unknown:
        parser.error("unknown part %s, must be of: %s" % (", ".join(unknown), ", ".join(PARTS)))
    names = arguments.groups.split(",")
    if any(name not in GROUPS for name in names):
        parser.error("--groups is %s, must be of: %s" % (arguments.groups, ", ".join(GROUPS)))
    groups = [GROUPS[name] for name in names]
    parts = arguments.parts or list(PARTS)
    ungrouped_parts = [part for part in parts if part not in PARTS_BY_GROUP]
    if arguments.write and ungrouped_parts and set(names) != set(GROUPS):
        parser.error("--write needs all groups for %s, whose goals cover all of them. Omit --groups" % ", ".join(ungrouped_parts))
    if not os.path.isfile(GNOMON):
        raise SystemExit("ERROR: %s is missing. Run scons." % GNOMON)
    driver.PROGRAM = GNOMON  # the one that describe_machine() runs
    with tempfile.TemporaryDirectory() as folder:
        images = make_images(groups, folder)
        for part in parts:
            tables = {"edge_count_" + part: images}
            if part in PARTS_BY_GROUP:
                tables = {"edge_count_%s_%s" % (part, name): select(images, GROUPS[name]) for name in names}
            for table, measured in tables.items():
                load = None if part in PARTS_BY_GROUP else os.getloadavg()[0]  # these have no times
                lines = PARTS[part](measured, folder, arguments.rounds)
                publish_tables({table: lines}, describe_machine(load), arguments.write)
    return 0


if __name__ == "__main__":
    sys.exit(main())
