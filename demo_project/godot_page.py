"""The page of the Godot demo."""

import html

from page_style import STYLE

NAMES = {"gnomon": "Gnomon, edge_count", "low": "Godot, Soft Low", "ultra": "Godot, Soft Ultra"}
BODY = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Gnomon inside Godot</title><style>%(style)s</style></head><body>
<header><h1>Gnomon inside Godot</h1>
<p>Shadows that the add-on made in %(godot)s, next to Godot's own and the traced reference: what share of the light the image shows.
%(size)d x %(size)d pixels.</p></header><main>
<section id="lights"><h2>Three lights</h2>
<p>The image, then each light's mask as <code>show_mask</code> draws it: white is lit.</p>
<div class="strip" style="--aspect: 1; grid-template-columns: repeat(4, 1fr)">%(lights)s</div></section>
<section id="figures"><h2>Error and time</h2>
<p>Error: root mean square over the penumbra's pixels, against the reference. Time: what a moving light adds to a frame
without shadows, median of %(frames)d frames.</p>
<div class="table"><table><tr><th>Light and caster</th>%(heads)s</tr>%(rows)s</table></div></section>
%(cases)s</main></body></html>
"""


def _figure(source, caption):
    text = html.escape(caption)
    return '<figure><img src="%s" alt="%s" loading="lazy"><figcaption>%s</figcaption></figure>' % (source, text, text)


def _cells(row):
    least = min(row["rmse"].values())
    cells = []
    for mode in NAMES:
        kind = ' class="best"' if row["rmse"][mode] == least else ""
        cells.append("<td%s>%.4f</td><td>%+.1f ms</td>" % (kind, row["rmse"][mode], row["added_ms"][mode]))
    return "".join(cells)


def _case(case):
    shadows = [_figure("%s_reference.png" % case, "Reference")]
    errors = []
    for mode, name in NAMES.items():
        shadows.append(_figure("%s_%s.png" % (case, mode), name))
        errors.append(_figure("%s_%s_error.png" % (case, mode), name + ": error (blue too dark, red too light)"))
    title = html.escape(case.replace("_", ", "))
    strip = '<div class="strip" style="--aspect: 1; grid-template-columns: repeat(%d, 1fr)">%s</div>'
    return '<section id="%s"><h2>%s</h2>%s%s</section>' % (
        case,
        title,
        strip % (4, "".join(shadows)),
        strip % (3, "".join(errors)),
    )


def write_page(path, results):
    """results: of measure_godot.py."""
    names = [("three_lights.png", "The image")]
    names += [("three_lights_%s.png" % light, light.capitalize()) for light in ("spot", "omni", "sun")]
    page = BODY % {
        "style": STYLE,
        "godot": "Godot " + html.escape(results["godot"]),
        "size": results["size"],
        "frames": results["frames"],
        "lights": "".join(_figure(*name) for name in names),
        "heads": "".join("<th>%s</th><th>added</th>" % name for name in NAMES.values()),
        "rows": "".join(
            '<tr><td><a href="#%s">%s</a></td>%s</tr>' % (row["case"], row["case"].replace("_", ", "), _cells(row))
            for row in results["rows"]
        ),
        "cases": "".join(_case(row["case"]) for row in results["rows"]),
    }
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)
