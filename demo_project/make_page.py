#!/usr/bin/env python3
"""Makes index.html from results.json and the PNGs that measure_demo.py wrote.

    make_page.py [DIR] [--inline]      default: demo_project/out

--inline puts the PNGs into the page, so that the one file can be sent.
"""

import argparse
import base64
import html
import json
import math
import os
import sys

from page_style import SCRIPT, STYLE

FOLDER = os.path.dirname(os.path.abspath(__file__))
# Colours that differ for colour-blind eyes too (Okabe, Ito 2008), distinguished by shape as well.
COLORS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#b8860b", "#56b4e9", "#7f7f7f", "#8a5a44", "#6a3d9a", "#1b9e77", "#e7298a")


def get_error(row):
    return row["error"]["penumbra"]["mae"]


def get_gpu_ms(row):
    return row["time"]["gpu_ms"]


COLUMNS = (
    ("penumbra MAE", get_error, "error"),
    ("RMSE", lambda row: row["error"]["penumbra"]["rmse"], "error"),
    ("p99", lambda row: row["error"]["penumbra"]["p99"], "error"),
    ("bias", lambda row: row["error"]["penumbra"]["bias"], "bias"),
    ("wrong", lambda row: row["error"]["penumbra"]["wrong"], "share"),
    ("too dark", lambda row: row["error"]["penumbra"]["umbra_over"], "share"),
    ("GPU ms", get_gpu_ms, "time"),
    ("p90", lambda row: row["time"]["gpu_ms_p90"], "time"),
    ("wall ms", lambda row: row["time"]["wall_ms"], "time"),
    ("p90", lambda row: row["time"]["wall_ms_p90"], "time"),
)


def escape(text):
    return html.escape(str(text), quote=True)


def get_value(row, get):
    """None where a technique failed or has no reference; JSON's null is None as well."""
    try:
        value = get(row)
    except (TypeError, KeyError):
        return None
    return value if isinstance(value, (int, float)) and math.isfinite(value) else None


def format_value(value, kind):
    if value is None:
        return "&ndash;"
    if kind == "share":
        return "%.1f&thinsp;%%" % (100.0 * value)
    if kind == "time":
        return "%.*f" % (2 if value < 10 else 1 if value < 100 else 0, value)
    return ("%+.4f" if kind == "bias" else "%.4f") % value


def choose_ticks(low, high):
    """1, 2, 5 times powers of ten within a logarithmic axis."""
    ticks = []
    for exponent in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1):
        ticks += [digit * 10.0**exponent for digit in (1, 2, 5)]
    return [tick for tick in ticks if low <= tick <= high]


class Page:
    """Collects the parts of the page."""

    def __init__(self, results, folder, is_inline):
        self.results = results
        self.folder = folder
        self.is_inline = is_inline
        self.techniques = {item["id"]: item for item in results.get("techniques", [])}
        width, height = results["size"].split("x")
        self.aspect = "%d / %d" % (int(width), int(height))
        shown = [item["id"] for item in results.get("techniques", []) if not item.get("is_reference")]
        self.colors = {name: COLORS[index % len(COLORS)] for index, name in enumerate(shown)}
        defaults = [item["id"] for item in results.get("techniques", []) if item.get("is_default")]
        self.default = defaults[0] if defaults else None

    def image_source(self, name):
        """Address of a PNG; empty when it is not there."""
        path = os.path.join(self.folder, name) if name else ""
        if not os.path.isfile(path):
            return ""
        if not self.is_inline:
            return escape(name)
        with open(path, "rb") as file:
            return "data:image/png;base64," + base64.b64encode(file.read()).decode("ascii")

    def get_rows(self):
        """(scene, light, row) of every measured technique."""
        for scene in self.results["scenes"]:
            for light in scene["lights"]:
                for row in light["techniques"]:
                    yield scene, light, row

    def compute_means(self):
        """(id, mean penumbra MAE, geometric mean of GPU ms, count), over the configurations it has."""
        means = []
        for name in self.colors:
            errors, times = [], []
            for _, _, row in self.get_rows():
                if row["id"] == name:
                    error, milliseconds = get_value(row, get_error), get_value(row, get_gpu_ms)
                    if error is not None and milliseconds is not None and milliseconds > 0.0:
                        errors.append(error)
                        times.append(milliseconds)
            if errors:
                mean_time = math.exp(sum(math.log(value) for value in times) / len(times))
                means.append((name, sum(errors) / len(errors), mean_time, len(errors)))
        return sorted(means, key=lambda item: item[1])

    def build_plot(self, means):
        """Error against time, both logarithmic, as SVG: faint dots are single lights, big ones means."""
        points = []
        for _, _, row in self.get_rows():
            error, milliseconds = get_value(row, get_error), get_value(row, get_gpu_ms)
            if error and milliseconds:
                points.append((row["id"], max(error, 1e-5), milliseconds))
        if not points:
            return ""
        low_x, high_x = min(p[2] for p in points) / 1.3, max(p[2] for p in points) * 1.6
        low_y, high_y = min(p[1] for p in points) / 1.3, max(p[1] for p in points) * 1.3
        width, height, left, right, top, bottom = 640, 420, 64, 16, 14, 46

        def find_x(value):
            return left + (width - left - right) * math.log(value / low_x) / math.log(high_x / low_x)

        def find_y(value):
            return height - bottom - (height - top - bottom) * math.log(value / low_y) / math.log(high_y / low_y)

        parts = ['<svg viewBox="0 0 %d %d" role="img" aria-label="Error against time of every technique">' % (width, height)]
        for tick in choose_ticks(low_x, high_x):
            x = find_x(tick)
            parts.append('<line class="axis" x1="%.1f" x2="%.1f" y1="%d" y2="%d"/>' % (x, x, top, height - bottom))
            parts.append('<text class="tick" x="%.1f" y="%d" text-anchor="middle">%g</text>' % (x, height - bottom + 18, tick))
        for tick in choose_ticks(low_y, high_y):
            y = find_y(tick)
            parts.append('<line class="axis" x1="%d" x2="%d" y1="%.1f" y2="%.1f"/>' % (left, width - right, y, y))
            parts.append('<text class="tick" x="%d" y="%.1f" text-anchor="end">%g</text>' % (left - 7, y + 4, tick))
        parts.append('<text class="tick" x="%d" y="%d" text-anchor="end">GPU time of one mask, ms</text>' % (width - right, height - 8))
        parts.append('<text class="tick" transform="translate(14 %d) rotate(-90)" text-anchor="end">penumbra MAE</text>' % top)
        for name, error, milliseconds in points:
            parts.append(
                '<circle cx="%.1f" cy="%.1f" r="2.6" fill="%s" opacity="0.4"/>'
                % (find_x(milliseconds), find_y(error), self.colors[name])
            )
        # A label avoids the other labels and the large dots: (left, middle, width) of each.
        taken = [(find_x(item[2]) - 8, find_y(max(item[1], 1e-5)) + 4, 16) for item in means]
        for name, error, milliseconds, _ in means:
            x, y = find_x(milliseconds), find_y(max(error, 1e-5))
            parts.append(
                '<circle cx="%.1f" cy="%.1f" r="7" fill="%s" stroke="var(--card)" stroke-width="2"/>'
                % (x, y, self.colors[name])
            )
            label_width = 7.6 * len(name)
            to_left = x + 12 + label_width > width - right
            label_x = x - 12 - label_width if to_left else x + 12
            label_y = y + 4
            for step in range(24):
                # Down, up, farther down ...: the first position where no label is yet.
                offset = (step + 1) // 2 * 8 * (1 if step % 2 else -1)
                label_y = y + 4 + offset
                inside = top + 8 < label_y < height - bottom
                clash = any(abs(label_y - b) < 15 and label_x < a + w + 4 and a < label_x + label_width + 4 for a, b, w in taken)
                if inside and not clash:
                    break
            taken.append((label_x, label_y, label_width))
            parts.append(
                '<text class="halo" x="%.1f" y="%.1f" style="fill: %s" font-weight="600">%s</text>'
                % (label_x, label_y, self.colors[name], escape(name))
            )
        return "\n".join(parts + ["</svg>"])

    def build_summary(self):
        means = self.compute_means()
        if not means:
            return ""
        rows = [
            '<tr><td>%s</td><td>%.4f</td><td>%s</td><td>%d</td><td class="text">%s</td></tr>'
            % (escape(name), error, format_value(milliseconds, "time"), count, escape(self.name_of(name)))
            for name, error, milliseconds, count in means
        ]
        return (
            '<section id="summary"><h2>Error against time</h2>'
            "<p>Lower is closer to the exact shadow, left is faster. Small dots are single lights, large ones their mean"
            " (of the times: the geometric mean).</p>"
            '<div class="table">%s</div>'
            '<div class="table"><table><tr><th>technique</th><th>penumbra MAE</th><th>GPU ms</th><th>lights</th>'
            '<th class="text">name</th></tr>%s'
            "</table></div></section>" % (self.build_plot(means), "".join(rows))
        )

    def name_of(self, technique):
        name = self.techniques.get(technique, {}).get("name", technique)
        return name + " (default)" if technique == self.default else name

    def build_table(self, light):
        head = "".join("<th>%s</th>" % escape(title) for title, _, _ in COLUMNS)
        best = []
        for _, get, kind in COLUMNS:
            values = [get_value(row, get) for row in light["techniques"]]
            values = [abs(value) for value in values if value is not None]
            best.append(min(values) if values and kind != "share" else None)
        rows = []
        for row in light["techniques"]:
            label = escape(row["id"])
            if row["mask"] and row["heat"]:
                label = '<button data-mask="%s" data-heat="%s" aria-pressed="%s" data-name="%s">%s</button>' % (
                    self.image_source(row["mask"]),
                    self.image_source(row["heat"]),
                    "true" if row is self.choose_shown(light) else "false",
                    escape(self.name_of(row["id"])),
                    label,
                )
            if row["failure"]:
                cells = '<td class="failure" colspan="%d">%s</td>' % (len(COLUMNS), escape(row["failure"]))
            else:
                cells = ""
                for (_, get, kind), lowest in zip(COLUMNS, best):
                    value = get_value(row, get)
                    is_best = value is not None and lowest is not None and abs(value) <= lowest
                    cells += '<td%s>%s</td>' % (' class="best"' if is_best else "", format_value(value, kind))
            rows.append("<tr><td>%s</td>%s</tr>" % (label, cells))
        return (
            '<p class="soft">Tap a technique to see its mask. All errors over penumbra pixels;'
            ' &ldquo;wrong&rdquo; = off by more than 0.2, &ldquo;too dark&rdquo; = shown as umbra though lit by more than 5&thinsp;%%.</p>'
            '<div class="table"><table><tr><th>technique</th>%s</tr>%s'
            "</table></div>" % (head, "".join(rows))
        )

    def choose_shown(self, light):
        """The default technique's row, else the first that has images."""
        rows = [row for row in light["techniques"] if row["mask"] and row["heat"]]
        return next((row for row in rows if row["id"] == self.default), rows[0] if rows else None)

    def build_light(self, light, is_single):
        parts = ['<div class="light">']
        if not is_single:
            parts.append("<h3>Light %s (%s)</h3>" % (escape(light["name"]), escape(light["type"])))
        else:
            parts.append("<h3>Visibility of the light (%s)</h3>" % escape(light["type"]))
        if light["failure"]:
            parts.append('<p class="failure">%s</p>' % escape(light["failure"]))
        shown = self.choose_shown(light)
        if light["truth"] and shown:
            parts.append(
                '<div class="strip">'
                '<figure><img loading="lazy" alt="Exact visibility" src="%s"><figcaption>reference, %.1f s</figcaption></figure>'
                '<figure><img loading="lazy" class="mask" alt="Visibility by the technique" src="%s">'
                '<figcaption class="shown">%s</figcaption></figure>'
                '<figure><img loading="lazy" class="heat" alt="Signed error" src="%s">'
                "<figcaption>error: red too bright, blue too dark</figcaption></figure></div>"
                % (
                    self.image_source(light["truth"]["png"]),
                    light["truth"]["seconds"],
                    self.image_source(shown["mask"]),
                    escape(self.name_of(shown["id"])),
                    self.image_source(shown["heat"]),
                )
            )
        parts.append(self.build_table(light))
        return "\n".join(parts + ["</div>"])

    def build_scene(self, scene):
        parts = ['<section id="%s"><h2>%s</h2>' % (escape(scene["name"]), escape(scene["name"].replace("_", " ").capitalize()))]
        for failure in scene["failures"]:
            parts.append('<p class="failure">%s</p>' % escape(failure))
        without, with_soft = (self.image_source(scene["pictures"].get(key)) for key in ("without", "with"))
        if without and with_soft:
            parts.append(
                '<div class="compare"><img alt="%s without shadows" src="%s"><img class="over" alt="%s with soft shadows" src="%s">'
                '<i></i><b class="left">without</b><b class="right">soft shadows%s</b>'
                '<input type="range" min="0" max="100" value="45" aria-label="Slide between without and with shadows"></div>'
                % (escape(scene["name"]), without, escape(scene["name"]), with_soft,
                   ": " + escape(scene["shown_technique"]) if scene.get("shown_technique") else "")  # fmt: skip
            )
        elif with_soft or without:
            parts.append('<div class="compare"><img alt="%s" src="%s"></div>' % (escape(scene["name"]), with_soft or without))
        for light in scene["lights"]:
            parts.append(self.build_light(light, len(scene["lights"]) == 1))
        return "\n".join(parts + ["</section>"])

    def build_machine(self):
        info = self.results["info"]
        lines = [("Gnomon", info.get("version", "?"))]
        devices = info.get("devices", [])
        chosen = info.get("chosen")
        device = next((item for item in devices if item.get("index") == chosen), None)
        if device:
            lines.append(("Device", "%s (%s)" % (device.get("name", "?"), device.get("type", "?"))))
            lines.append(("Driver", "%s, Vulkan %s" % (device.get("driver", "?"), device.get("api_version", "?"))))
        lines.append(("CPU", "%s, %s threads" % (info.get("cpu", "?"), info.get("threads", "?"))))
        samples = self.results.get("samples") or "default"
        lines.append(("Masks", "%s, reference with %s samples of the light" % (self.results["size"].replace("x", " × "), samples)))
        lines.append(("Run", "%.0f s, %d failed" % (self.results.get("seconds", 0.0), self.results.get("failure_count", 0))))
        rows = "".join("<dt>%s</dt><dd>%s</dd>" % (escape(key), escape(value)) for key, value in lines)
        return '<section id="machine"><h2>Machine</h2><dl>%s</dl></section>' % rows

    def build(self):
        scenes = self.results["scenes"]
        links = "".join('<a href="#%s">%s</a>' % (escape(s["name"]), escape(s["name"].replace("_", " "))) for s in scenes)
        failures = self.results.get("failure_count", 0)
        notice = '<p class="failure"><strong>%d failed.</strong> The rows below list what and why.</p>' % failures if failures else ""
        return (
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1"><title>Gnomon demo</title>'
            "<style>%s:root { --aspect: %s; }</style></head>\n<body><header><h1>Soft shadows, measured</h1>"
            "<p>Every scene without and with its soft shadows, and every technique of this build against the exact"
            " visibility of the light: how far off it is, and what it costs on this machine.</p>%s<nav>%s"
            '<a href="#machine">machine</a></nav></header>\n<main>%s\n%s\n%s</main>\n<script>%s</script></body></html>\n'
            % (
                STYLE,
                self.aspect,
                notice,
                links,
                self.build_summary(),
                "\n".join(self.build_scene(scene) for scene in scenes),
                self.build_machine(),
                SCRIPT,
            )
        )


def main():
    parser = argparse.ArgumentParser(description="Makes the demo page.")
    parser.add_argument("folder", nargs="?", default=os.path.join(FOLDER, "out"), metavar="DIR")
    parser.add_argument("--inline", action="store_true", help="put the PNGs into the page")
    arguments = parser.parse_args()
    path = os.path.join(arguments.folder, "results.json")
    try:
        with open(path, encoding="utf-8") as file:
            results = json.load(file)
    except (OSError, ValueError) as error:
        raise SystemExit("ERROR: %s: %s. Run demo_project/run_demo.sh first." % (path, error)) from error
    text = Page(results, arguments.folder, arguments.inline).build()
    with open(os.path.join(arguments.folder, "index.html"), "w", encoding="utf-8") as file:
        file.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
