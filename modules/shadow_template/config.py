def get_dependencies():
    return ["core", "scene", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4  # the layer of all techniques


def is_example():  # delete in a copy
    return True


def get_description():
    return "The smallest technique that builds and passes; copy it to start a new one"


def get_doc():
    return "doc/add_a_technique.md"
