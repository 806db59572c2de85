import subprocess


def get_dependencies():
    return ["core", "scene", "mesh_tools"]


def get_layer():
    return 4


def get_description():
    return "Masks and their error against a truth; reports of error against run time"


def can_disable():
    return False  # the report and the editor's error panel are made of it


def can_build(env):
    return subprocess.run(["pkg-config", "--exists", "OpenEXR"]).returncode == 0


def configure(env):
    flags = env.ParseFlags("!pkg-config OpenEXR --cflags --libs")
    for folder in flags["CPPPATH"]:
        # A system folder: warnings in headers of others are not ours to fix.
        env.Append(CCFLAGS=[("-isystem", folder)])
    flags["CPPPATH"] = []
    env.MergeFlags(flags)
