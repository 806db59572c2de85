def get_dependencies():
    return ["core", "scene", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "Shadow maps, hard or n x n filtered, and the mean of many hard ones"


def get_source():
    return "Williams 1978; Reeves, Salesin, Cook 1987 (percentage-closer filter)"


def get_doc():
    return "doc/techniques/shadow_map.md"
