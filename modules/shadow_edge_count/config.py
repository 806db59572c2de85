def get_dependencies():
    return ["core", "scene", "mesh_tools", "rendering_device"]


def get_layer():
    return 4


def get_description():
    return "Soft shadows counted from silhouette edges per receiver"
