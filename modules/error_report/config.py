def get_dependencies():
    return ["core", "scene", "mesh_tools", "masks"]


def get_layer():
    return 4


def get_description():
    return "Reports of error against run time, with what modules add to them"


def can_disable():
    return False  # the module main calls its functions
