def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "Shadow volumes, z-pass and z-fail, robust for meshes of any kind"


def get_source():
    return "GPU Gems 3, chapter 11; DOOM 3"


def get_doc():
    return "doc/techniques/shadow_volume.md"
