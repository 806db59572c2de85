def get_dependencies():
    return ["core", "scene"]


def get_layer():
    return 2


def get_description():
    return "Welding, edges, adjacency, silhouettes and a BVH; pure functions without a GPU"
