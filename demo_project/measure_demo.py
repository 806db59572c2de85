#!/usr/bin/env python3
"""Renders the demo scenes and measures every technique; writes PNGs and results.json for make_page.py.

A scene or technique that fails is written down as such and the rest goes on; exit code 1 then.
"""

import argparse
import fnmatch
import json
import os
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes"))
from fin_widths import get_fin_settings  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROJECT = os.path.join(ROOT, "demo_project")
QUICK_SCENE_COUNT = 3
TIMEOUT_S = 900


class CommandFailed(Exception):
    """The text is what the program printed."""


def load_config(path):
    """Sections of a Godot ConfigFile; values are JSON (strings, numbers, true, lists)."""
    sections, current = {}, {}
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            line = line.strip()
            if not line or line.startswith(";"):
                continue
            if line.startswith("[") and line.endswith("]"):
                current = sections.setdefault(line[1:-1], {})
                continue
            key, separator, value = line.partition("=")
            try:
                current[key.strip()] = json.loads(value)
            except ValueError:
                separator = ""
            if not separator:
                raise SystemExit("ERROR: %s:%d: %r is neither [section] nor key=value." % (path, number, line))
    return sections


def find_lights(scene_path):
    """(name, type) of the lights of a glTF scene whose shadow is on, in file order."""
    with open(scene_path, encoding="utf-8") as file:
        scene = json.load(file)
    lights = scene.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
    found = []
    for node in scene.get("nodes", []):
        index = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if index is None:
            continue
        extras = {**lights[index].get("extras", {}), **node.get("extras", {})}
        if extras.get("shadow_enabled", True):
            found.append((node.get("name", lights[index].get("name", "")), lights[index]["type"]))
    return found


class Gnomon:
    """bin/gnomon with the options that every command shares."""

    def __init__(self, program, device):
        self.program = program
        self.device = ["--device", device] if device else []

    def run(self, *arguments):
        """Standard output. Raises CommandFailed with the program's last error line."""
        command = [self.program, *map(str, arguments), *self.device]
        try:
            result = subprocess.run(
                command, cwd=ROOT, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
            )
        except OSError as error:
            raise CommandFailed("%s cannot be run: %s" % (self.program, error)) from error
        except subprocess.TimeoutExpired as error:
            raise CommandFailed("no answer from `gnomon %s` within %d s" % (arguments[0], TIMEOUT_S)) from error
        if result.returncode != 0:
            lines = [line for line in result.stderr.splitlines() if line.strip()]
            errors = [line for line in lines if line.startswith("ERROR")] or lines
            text = errors[-1] if errors else "no message"
            raise CommandFailed("`gnomon %s` ended with %d: %s" % (arguments[0], result.returncode, text))
        return result.stdout

    def load_json(self, *arguments):
        text = self.run(*arguments)
        try:
            return json.loads(text)
        except ValueError as error:
            raise CommandFailed("`gnomon %s` printed no JSON: %s" % (arguments[0], error)) from error


class Measurement:
    """One run over all scenes."""

    def __init__(self, gnomon, options, techniques, work_folder):
        self.gnomon = gnomon
        self.options = options
        self.work_folder = work_folder
        self.reference = next((item for item in techniques if item.get("is_reference")), None)
        self.techniques = [item for item in techniques if not item.get("is_reference")]
        self.failure_count = 0
        self.done_count = 0
        self.total_count = 0

    def report(self, text):
        print("[%3d/%d] %s" % (self.done_count, self.total_count, text), flush=True)

    def fail(self, what, error):
        self.failure_count += 1
        print("FAILED: %s: %s" % (what, error), file=sys.stderr, flush=True)
        return str(error)

    def count_steps(self, scenes):
        for _, path in scenes:
            try:
                light_count = len(find_lights(path))
            except (OSError, ValueError, KeyError, IndexError):
                light_count = 0
            self.total_count += 1 + light_count * (1 + len(self.techniques))

    def capture(self, scene_path, name, *settings):
        """The lit image; its path in the out folder."""
        path = os.path.join(self.options.out, name)
        self.gnomon.run(
            "run", scene_path, "--headless", "--frames", 2, "--size", self.options.size, "--capture", path, *settings
        )
        return name

    def measure_scene(self, name, path):
        scene = {"name": name, "pictures": {}, "failures": [], "lights": []}
        self.done_count += 1
        try:
            lights = find_lights(path)
        except (OSError, ValueError, KeyError, IndexError) as error:
            scene["failures"].append(self.fail(name, "cannot read %s: %s" % (path, error)))
            return scene
        for light, kind in lights:
            scene["lights"].append(self.measure_light(name, path, light, kind))
        off = [word for light, _ in lights for word in ("--set", "light.%s.shadow_enabled=false" % light)]
        # The image shows the best that this build can do, not only what it does by default.
        scene["shown_technique"] = self.find_best_technique(scene["lights"])
        best = ["--technique", scene["shown_technique"]] if scene["shown_technique"] else []
        for kind, settings in (("with", best), ("without", off)):
            try:
                image = self.capture(path, "%s.%s.png" % (name, kind), *settings)
                scene["pictures"][kind] = image
            except CommandFailed as error:
                scene["failures"].append(self.fail("%s, %s shadows" % (name, kind), error))
        self.report("%s: images" % name)
        return scene

    def find_best_technique(self, lights):
        """The id with the least penumbra error summed over a scene's lights; None without a reference."""
        sums = {}
        for item in (item for light in lights for item in light["techniques"] if item["error"]):
            sums.setdefault(item["id"], []).append(item["error"]["penumbra"]["mae"])
        complete = {name: sum(errors) for name, errors in sums.items() if len(errors) == len(lights)}
        return min(complete, key=complete.get, default=None)

    def compute_mask(self, stem, scene_path, light, technique, *arguments):
        """Path of the EXR; the PNG next to the page is named stem.png."""
        mask = os.path.join(self.work_folder, stem + ".exr")
        self.gnomon.run(
            "visibility", scene_path, "--technique", technique, "--light", light, "--size", self.options.size,
            "--out", mask, "--png", os.path.join(self.options.out, stem + ".png"), *arguments,
        )  # fmt: skip
        return mask

    def measure_light(self, scene_name, scene_path, light, kind):
        what = "%s, light %s" % (scene_name, light)
        stem = "%s.%s" % (scene_name, re.sub(r"\W+", "_", light).lower())
        row = {"name": light, "type": kind, "truth": None, "failure": None, "techniques": []}
        reference_path = None
        self.done_count += 1
        if self.reference is None:
            row["failure"] = self.fail(what, "no technique of this build is a reference")
        else:
            samples = []
            if self.options.samples:
                samples = ["--set", "%s_samples=%d" % (self.reference["id"], self.options.samples)]
            try:
                begin = time.monotonic()
                reference_path = self.compute_mask(stem + ".reference", scene_path, light, self.reference["id"], *samples)
                row["truth"] = {"png": stem + ".reference.png", "seconds": time.monotonic() - begin}
                self.report("%s: reference in %.1f s" % (what, row["truth"]["seconds"]))
            except CommandFailed as error:
                row["failure"] = self.fail(what, error)
        for technique in self.techniques:
            self.done_count += 1
            settings = get_fin_settings(technique["id"], scene_name, light)
            row["techniques"].append(
                self.measure_technique(stem, scene_path, light, technique["id"], settings, reference_path)
            )
            result = row["techniques"][-1]
            if result["failure"]:
                self.fail("%s, %s" % (what, technique["id"]), result["failure"])
                continue
            error = result["error"]["penumbra"]["mae"] if result["error"] else None
            shown = "no reference" if error is None else "penumbra MAE %.4f" % error
            self.report("%s: %s: %s, %.2f ms" % (what, technique["id"], shown, result["time"]["gpu_ms"]))
        if reference_path:
            os.remove(reference_path)
        return row

    def measure_technique(self, stem, scene_path, light, technique, settings, reference_path):
        stem = "%s.%s" % (stem, technique)
        row = {"id": technique, "mask": None, "heat": None, "error": None, "time": None, "failure": None}
        times = os.path.join(self.work_folder, "time.json")
        try:
            words = [word for setting in settings for word in ("--set", setting)]
            if self.options.frames:
                words += ["--timed-frames", str(self.options.frames)]
            mask = self.compute_mask(stem, scene_path, light, technique, "--time", times, *words)
            row["mask"] = stem + ".png"
            with open(times, encoding="utf-8") as file:
                row["time"] = json.load(file)["total"]
            if reference_path:
                heat = stem + ".heat.png"
                row["error"] = self.gnomon.load_json(
                    "compare", reference_path, mask, "--heatmap", os.path.join(self.options.out, heat)
                )
                row["heat"] = heat
            os.remove(mask)
        except (CommandFailed, OSError, ValueError, KeyError) as error:
            row["failure"] = "%s: %s" % (type(error).__name__, error) if not isinstance(error, CommandFailed) else str(error)
        return row


def select_scenes(project, options):
    """(name, path) of the scenes to do; one that is missing is skipped with a warning."""
    requested = [name for name in options.scenes.split(",") if name]
    skipped = [pattern for pattern in options.skip.split(",") if pattern]
    selected = []
    names = []
    for item in project["project"]["scenes"]:
        name = os.path.splitext(os.path.basename(item))[0]
        names.append(name)
        path = os.path.join(PROJECT, item)
        if requested and name not in requested:
            continue
        if any(fnmatch.fnmatchcase(name, pattern) for pattern in skipped):
            continue
        if not os.path.isfile(path):
            print("WARNING: %s does not exist, skipped." % path, file=sys.stderr)
            continue
        selected.append((name, path))
    unknown = [name for name in requested if name not in names]
    if unknown:
        print("ERROR: unknown scene %s. The project has: %s." % (", ".join(unknown), ", ".join(names)), file=sys.stderr)
        sys.exit(2)
    return selected[:QUICK_SCENE_COUNT] if options.quick else selected


def main():
    parser = argparse.ArgumentParser(description="Renders and measures the demo scenes.")
    parser.add_argument("--out", default=os.path.join(PROJECT, "out"), help="folder for PNGs and results.json")
    parser.add_argument("--size", default="512x512", help="WxH of images and masks")
    parser.add_argument("--samples", type=int, default=0, help="light samples of the reference (0 = its default)")
    parser.add_argument("--frames", type=int, default=0, help="frames that are timed (0 = the program's default)")
    parser.add_argument("--scenes", default="", help="A,B: these scenes only")
    parser.add_argument("--skip", default="", help="A,B*: all scenes but these")
    parser.add_argument("--quick", action="store_true", help="the first %d scenes only" % QUICK_SCENE_COUNT)
    parser.add_argument("--device", default="", help="Vulkan device, by name or index")
    options = parser.parse_args()
    options.out = os.path.abspath(options.out)
    os.makedirs(options.out, exist_ok=True)

    gnomon = Gnomon(os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon")), options.device)
    scenes = select_scenes(load_config(os.path.join(PROJECT, "project.cfg")), options)
    begin = time.monotonic()
    try:
        info = gnomon.load_json("info", "--json")
        techniques = gnomon.load_json("techniques", "--json")
    except CommandFailed as error:
        raise SystemExit("ERROR: %s" % error) from error
    results = {
        "info": info,
        "size": options.size,
        "samples": options.samples,
        "techniques": [{key: value for key, value in item.items() if key != "properties"} for item in techniques],
        "scenes": [],
    }
    with tempfile.TemporaryDirectory() as work_folder:
        measurement = Measurement(gnomon, options, techniques, work_folder)
        measurement.count_steps(scenes)
        for name, path in scenes:
            results["scenes"].append(measurement.measure_scene(name, path))
            results["failure_count"] = measurement.failure_count
            results["seconds"] = time.monotonic() - begin
            # After every scene, so that an interrupted run still gives a page.
            with open(os.path.join(options.out, "results.json"), "w", encoding="utf-8") as file:
                json.dump(results, file, indent="\t")
    print("%d steps in %.0f s, %d failed" % (measurement.done_count, time.monotonic() - begin, measurement.failure_count))
    return 1 if measurement.failure_count or not scenes else 0


if __name__ == "__main__":
    sys.exit(main())
