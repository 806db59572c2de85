def get_dependencies():
    return ["core", "scene", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "Percentage-closer soft shadows: blocker search, then a filter as wide as the penumbra"


def get_source():
    return "Fernando 2005, Percentage-closer soft shadows"


def get_doc():
    return "doc/techniques/pcss.md"
