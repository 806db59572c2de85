def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "rendering_device_godot", "render_graph", "shadows"]


def get_layer():
    return 6


def get_description():
    return "The add-on for Godot: reads its scenes and puts masks into its frames"


def get_doc():
    return "doc/godot.md"


def get_hosts():
    return ("godot",)


def is_program():
    return True


def can_disable():
    return False


def get_include_folders(env):
    import godot_builders  # importable only during a build

    return [godot_builders.get_api_folder(env)]
