def get_dependencies():
    return ["core", "rendering_device"]


def get_layer():
    return 2


def get_description():
    return "The device on Vulkan, the only module that includes Vulkan: memory, pipelines, timers, windows"


def get_hosts():
    return ("program",)


def configure(env):
    env.Append(LIBS=["vulkan"])
