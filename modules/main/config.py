def get_dependencies():
    return ["core", "rendering_device", "rendering_device_vulkan", "scene", "mesh_tools", "render_graph", "renderer", "shadows", "gltf_scene"]


def get_optional_dependencies():
    # Each adds features to the program (see SCsub). desktop: the window. masks: the command `visibility`, and `run` with
    # --reference, --time and --still. error_report: the command `report`.
    return ["desktop", "masks", "error_report"]


def get_layer():
    return 6


def get_description():
    return "The command line and the game window"


def get_hosts():
    return ("program",)


def is_program():
    return True


def can_disable():
    return False
