"""Writes the HTML page of the Godot demo."""

import html

from page_style import STYLE

# Mode of measure_godot.py -> name on the page.
NAMES = {"gnomon": "Gnomon, edge_count", "low": "Godot, Soft Low", "ultra": "Godot, Soft Ultra"}
BODY = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Gnomon inside Godot</title><style>%(style)s</style></head><body>
<header><h1>Gnomon inside Godot</h1>
<p>Shadows that the add-on made in %(godot)s, next to Godot's own and the traced reference: the
fraction of the light that reaches each pixel. %(size)d x %(size)d pixels.</p></header><main>
<section id="lights"><h2>Three lights</h2>
<p>The image, then each light's mask as <code>show_mask</code> draws it: white is lit.</p>
<div class="strip" style="--aspect: 1; grid-template-columns: repeat(4, 1fr)">%(lights)s</div></section>
<section id="room"><h2>A room with %(light_count)d lights</h2>
<p>The reference is the sum of the images with one light each, times the traced visible fraction of that light. Error: root
mean square of the fraction image / unshadowed image, over the penumbra's pixels. Time: of a whole frame in which lights, things
and shadows move, median of %(frames)d frames; with 1 light that of the swinging lamp.</p>
%(room_images)s
<div class="table"><table><tr><th></th><th>Error</th>%(room_heads)s</tr>%(room_rows)s</table></div></section>
<section id="figures"><h2>Error and time</h2>
<p>Error: root mean square over the penumbra's pixels, against the reference. Time: what the shadow of a moving light
adds to a frame, the difference of medians of %(frames)d frames.</p>
<div class="table"><table><tr><th>Light and caster</th>%(heads)s</tr>%(rows)s</table></div></section>
%(cases)s</main></body></html>
"""


def _figure(source, caption):
    text = html.escape(caption)
    return '<figure><img src="%s" alt="%s" loading="lazy"><figcaption>%s</figcaption></figure>' % (source, text, text)


def _cells(row):
    min_rmse = min(row["rmse"].values())
    cells = []
    for mode in NAMES:
        kind = ' class="best"' if row["rmse"][mode] == min_rmse else ""
        cells.append("<td%s>%.4f</td><td>%+.1f ms</td>" % (kind, row["rmse"][mode], row["added_ms"][mode]))
    return "".join(cells)


def _images(case, columns):
    """Return the shadows of each mode in rows of that many columns, and a row of their errors."""
    shadows = [_figure("%s_reference.png" % case, "Reference")]
    errors = []
    for mode, name in NAMES.items():
        shadows.append(_figure("%s_%s.png" % (case, mode), name))
        errors.append(_figure("%s_%s_error.png" % (case, mode), name + ": error (blue too dark, red too light)"))
    strip = '<div class="strip" style="--aspect: 1; grid-template-columns: repeat(%d, 1fr)">%s</div>'
    return strip % (columns, "".join(shadows)) + strip % (len(NAMES), "".join(errors))


def _case(case):
    return '<section id="%s"><h2>%s</h2>%s</section>' % (case, html.escape(case.replace("_", ", ")), _images(case, 4))


def _room_rows(room):
    rows = []
    for mode, name in dict(NAMES, off="Without shadows").items():
        cells = "".join("<td>%.0f ms</td>" % times[mode] for times in room["times"].values())
        error = "%.4f" % room["rmse"][mode] if mode in room["rmse"] else ""
        rows.append("<tr><td>%s</td><td>%s</td>%s</tr>" % (html.escape(name), error, cells))
    return "".join(rows)


def write_page(path, results):
    """results: the contents of results.json, see measure_godot.py."""
    room = results["room"]
    figures = [("three_lights.png", "The image")]  # (file, caption)
    figures += [("three_lights_%s.png" % light, light.capitalize()) for light in ("spot", "omni", "sun")]
    page = BODY % {
        "style": STYLE,
        "godot": "Godot " + html.escape(results["godot"]),
        "size": results["size"],
        "frames": results["frames"],
        "light_count": len(room["lights"]),
        "room_images": _images("room", 2),
        "room_heads": "".join("<th>%s light%s</th>" % (count, "" if count == "1" else "s") for count in room["times"]),
        "room_rows": _room_rows(room),
        "lights": "".join(_figure(*figure) for figure in figures),
        "heads": "".join("<th>%s</th><th>added</th>" % name for name in NAMES.values()),
        "rows": "".join(
            '<tr><td><a href="#%s">%s</a></td>%s</tr>' % (row["case"], row["case"].replace("_", ", "), _cells(row))
            for row in results["rows"]
        ),
        "cases": "".join(_case(row["case"]) for row in results["rows"]),
    }
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)
