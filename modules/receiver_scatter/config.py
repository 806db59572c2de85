def get_dependencies():
    return ["core", "scene", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "Shadows on translucent surfaces: light spreads below them, and so does its shadow"


def get_source():
    return "Wang, Xiao 2015, 1671-0444(2015)05-0646-04; Jensen et al. 2001, section 2.1"


def get_doc():
    return "doc/techniques/receiver_scatter.md"
