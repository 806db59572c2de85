def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "Soft shadows counted from silhouette edges per receiver"


def get_source():
    return "Own; after Sun, Lü, Liu, Wu 2010"


def get_doc():
    return "doc/techniques/edge_count.md"
