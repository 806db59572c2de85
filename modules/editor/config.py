def get_dependencies():
    return ["core", "rendering_device", "scene", "mesh_tools", "render_graph", "renderer", "shadows", "gltf_scene", "masks", "desktop", "shader_reload"]


def get_layer():
    return 5


def get_description():
    return "Scene tree, viewport and inspector, made from property lists"


def can_disable():
    return False  # it runs only on request, and then it cannot end itself


def get_doc():
    return "doc/editor.md"


def configure(env):
    env.Append(LIBS=["imgui", "stb", "glfw"])


def get_include_folders(env):
    return ["/usr/include/imgui"]
