def get_dependencies():
    return ["core"]


def get_layer():
    return 1


def get_description():
    return "The only code that includes Vulkan: device, memory, pipelines, timers"


def configure(env):
    env.Append(LIBS=["vulkan"])
