import shlex
import subprocess


def get_dependencies():
    return ["core", "scene", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4  # the layer of all techniques


def get_description():
    return "Exact area-light visibility by ray tracing: the reference that techniques are measured against"


def get_hosts():
    return ("program",)


def _find_embree(env):
    """Return the newest major version of Embree whose header the compiler finds, or 0."""
    for version in (4, 3):
        command = shlex.split(env["CXX"]) + ["-E", "-x", "c++", "-"]
        source = "#include <embree%d/rtcore.h>\n" % version
        if subprocess.run(command, input=source, text=True, capture_output=True, env=env["ENV"]).returncode == 0:
            return version
    return 0


def can_build(env):
    return _find_embree(env) != 0


def configure(env):
    env.Append(LIBS=["embree%d" % _find_embree(env)])


def get_source():
    return "Area integral over the light's disc, Embree rays"


def get_doc():
    return "doc/techniques/reference.md"
