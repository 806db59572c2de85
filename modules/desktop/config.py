def get_dependencies():
    return ["core", "rendering_device", "rendering_device_vulkan"]


def get_layer():
    return 3


def get_description():
    return "Desktop window with keyboard and mouse input"


def get_systems():
    return ("linux",)


def can_disable():
    return False


def configure(env):
    env.Append(LIBS=["glfw"])
