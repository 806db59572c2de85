def get_dependencies():
    return ["core", "scene", "mesh_tools", "masks", "error_report"]


def get_layer():
    return 5


def get_description():
    return "The report's sweeps into extreme cases, and what breaks in them"


def can_disable():
    return False  # a report that lacks it on one machine cannot be merged with those that have it


def get_report_options():
    return ["--stability", "--sweeps"]


def get_doc():
    return "doc/stability.md"
