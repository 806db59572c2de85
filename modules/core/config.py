def get_dependencies():
    return []


def get_layer():
    return 0


def get_description():
    return "Errors, log, properties, module registry, files"


def configure(env):
    import modules_builders

    env.Append(LIBS=[modules_builders.find_library(env, "stb")])  # PNG
