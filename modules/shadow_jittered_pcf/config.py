def get_dependencies():
    return ["core", "scene", "rendering_device", "render_graph", "shadows"]


def get_layer():
    return 4


def get_description():
    return "A shadow map filtered with jittered taps over a disc, the outermost first"


def get_source():
    return "OpenGL 4 Shading Language Cookbook, chapter 7, random sampling"


def get_doc():
    return "doc/techniques/jittered_pcf.md"
