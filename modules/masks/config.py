import subprocess


def get_dependencies():
    return ["core"]


def get_layer():
    return 1


def get_description():
    return "Masks as files and images, their error against a reference, and what they cost"


def get_hosts():
    return ("program",)


def can_disable():
    return False  # commands and the editor's error panel need it


def can_build(env):
    return subprocess.run(["pkg-config", "--exists", "OpenEXR"], env=env["ENV"]).returncode == 0


def configure(env):
    env.Append(LIBS=env.ParseFlags("!%s OpenEXR --libs" % env["PKG_CONFIG"])["LIBS"])


def get_include_folders(env):
    return env.ParseFlags("!%s OpenEXR --cflags" % env["PKG_CONFIG"])["CPPPATH"]
