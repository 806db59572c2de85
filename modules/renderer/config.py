def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph"]


def get_layer():
    return 3


def get_description():
    return "G-buffer, lighting, and the interfaces that shadow techniques plug into"
