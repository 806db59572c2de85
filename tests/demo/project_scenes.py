"""What demo_project/project.cfg lists."""

import configparser
import json
import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def list_project_scenes():
    """Paths below demo_project."""
    parser = configparser.ConfigParser(delimiters="=", interpolation=None)
    parser.read(os.path.join(ROOT, "demo_project", "project.cfg"), encoding="utf-8")
    return json.loads(parser["project"]["scenes"])
