def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4  # the layer of all techniques


def get_description():
    return "Planar shadows: casters projected on declared planes"


def get_source():
    return "Blinn 1988, Me and my (fake) shadow"


def get_doc():
    return "doc/techniques/planar.md"
