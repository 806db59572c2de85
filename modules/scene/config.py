def get_dependencies():
    return ["core"]


def get_layer():
    return 1


def get_description():
    return "Nodes, meshes, lights, cameras and the immutable snapshot of a frame"
