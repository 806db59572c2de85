def get_dependencies():
    return ["core", "rendering_device"]


def get_layer():
    return 2


def get_description():
    return "Passes, transient textures, derived barriers, pass timings"
