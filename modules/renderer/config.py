def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "G-buffer, lighting with shadow masks, tone mapping and debug views"


def can_disable():
    return False


def get_hosts():
    return ("program",)
