def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph"]


def get_layer():
    return 3


def get_description():
    return "Soft shadows for any host: one mask per light, from techniques and filters that plug in"
