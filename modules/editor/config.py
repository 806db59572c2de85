def get_dependencies():
    return ["core", "rendering_device", "scene", "mesh_tools", "render_graph", "renderer", "shadows", "gltf_scene", "masks", "desktop", "shader_reload"]


def get_layer():
    return 5


def get_description():
    return "Scene editor: scene tree, viewport and an inspector generated from property lists"


def get_systems():
    return ("linux",)


def can_disable():
    return False  # it runs only on `gnomon edit`, and a running editor cannot disable itself


def get_doc():
    return "doc/editor.md"


def configure(env):
    env.Append(LIBS=["imgui", "stb", "glfw"])  # imgui uses stb


def get_include_folders(env):
    return ["/usr/include/imgui"]
