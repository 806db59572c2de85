def get_dependencies():
    return ["core"]


def get_layer():
    return 1


def get_description():
    return "Shaders recompiled from their sources while the program runs"


def get_hosts():
    return ("program",)


def get_systems():
    return ("linux",)


def can_disable():
    return False


def configure(env):
    # Static libraries in link order: each before its dependencies.
    env.Append(
        LIBS=["SPIRV", "glslang-default-resource-limits", "glslang", "MachineIndependent", "GenericCodeGen", "OSDependent"]
        + ["OGLCompiler", "SPIRV-Tools-opt", "SPIRV-Tools"]
    )
