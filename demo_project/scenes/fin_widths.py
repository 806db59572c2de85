"""Widths (r, t) in metres of the penumbra fins for each scene and light, near the best ones that
tests/benchmark/search_fins.py found. They are not stored in the scenes, because other techniques derive the light's size
from r and t, and fins look best when they are narrower than that size.
"""

FIN_TECHNIQUES = ("penumbra_fins", "outer_fins")

FIN_WIDTHS_M = {
    ("sphere", "Light"): (0.08, 0.17),
    ("contact_box", "Light"): (0.14, 0.28),
    ("torus_knot", "Light"): (0.08, 0.17),
    ("stacked_layers", "Light"): (0.14, 0.56),
    ("clutter", "Light"): (0.1, 0.48),
    ("terrain", "Light"): (0.06, 0.1),
    ("open_sheets", "Light"): (0.1, 0.2),
    ("three_lights", "Spot"): (0.08, 0.13),
    ("three_lights", "Omni"): (0.06, 0.14),
    ("three_lights", "Sun"): (0.06, 0.13),
    ("stained_glass", "Light"): (0.1, 0.25),
    ("teapot_s15", "Light"): (0.01, 0.01),  # a light without size
    ("teapot_s50", "Light"): (0.01, 0.01),
    ("teapot_s80", "Light"): (0.01, 0.01),
    ("bunny", "Light"): (0.1, 0.17),
    ("bunny_wax", "Light"): (0.01, 0.01),
}


def get_fin_settings(technique, scene, light):
    """Return light properties as arguments of `gnomon --set`; an empty list for techniques without fins and for other lights."""
    widths_m = FIN_WIDTHS_M.get((scene, light))
    if technique not in FIN_TECHNIQUES or widths_m is None:
        return []
    return ["penumbra_outer_width=%g" % widths_m[0], "penumbra_inner_width=%g" % widths_m[1]]
