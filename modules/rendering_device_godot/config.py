def get_dependencies():
    return ["core", "rendering_device"]


def get_layer():
    return 2


def get_description():
    return "The device inside Godot, implemented on Godot's RenderingDevice"


def get_hosts():
    return ("godot",)


def get_include_folders(env):
    import godot_builders  # only available during a build

    return [godot_builders.get_api_folder(env)]
