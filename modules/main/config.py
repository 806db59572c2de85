def get_dependencies():
    return ["core", "rendering_device", "scene", "mesh_tools", "render_graph", "renderer", "gltf_scene", "error_report", "desktop"]


def get_optional_dependencies():
    return ["editor"]  # without it there is no command `edit`


def get_layer():
    return 6


def get_description():
    return "The command line and the game window"


def is_program():
    return True


def can_disable():
    return False


def configure(env):
    env.Append(LIBS=["glfw"])
