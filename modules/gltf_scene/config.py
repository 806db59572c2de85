def get_dependencies():
    return ["core", "scene"]


def get_layer():
    return 4


def get_description():
    return "glTF 2.0 files in and out, with the shadow properties of their lights"


def get_hosts():
    return ("program",)


def can_disable():
    return False  # without it there is no scene to show


def configure(env):
    env.Append(LIBS=["tinygltf", "png", "turbojpeg", "z"])
