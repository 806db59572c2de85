def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "Depth peeling and penumbra fins, inner and outer, with widths r and t"


def get_source():
    return "Sun, Lü, Liu, Wu 2010, 1006-8961(2010)09-1391-07"


def get_doc():
    return "doc/techniques/penumbra_fins.md"
