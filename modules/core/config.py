def get_dependencies():
    return []


def get_layer():
    return 0


def get_description():
    return "Errors, log, properties, module registry, files"


def configure(env):
    if not env["godot"]:
        env.Append(LIBS=["png", "z"])
