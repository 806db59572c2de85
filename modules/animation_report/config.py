def get_dependencies():
    return ["core", "scene", "masks", "error_report"]


def get_layer():
    return 5


def get_description():
    return "The report's errors and temporal errors while an animation plays"


def can_disable():
    return False  # a report that lacks it on one machine cannot be merged with those that have it


def get_report_options():
    return ["--change"]


def get_doc():
    return "doc/animation.md"
