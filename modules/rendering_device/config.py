def get_dependencies():
    return ["core"]


def get_layer():
    return 1


def get_description():
    return "Interface of GPU devices: resources, pipelines, command lists, timers; a backend implements it"


def configure(env):
    env.Append(LIBS=["spirv-cross-core"])
