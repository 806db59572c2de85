"""Reads the list of scenes in demo_project/project.cfg."""

import configparser
import json
import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def list_project_scenes():
    """Return the paths of the scenes, relative to demo_project."""
    parser = configparser.ConfigParser(delimiters="=", interpolation=None)
    parser.read(os.path.join(ROOT, "demo_project", "project.cfg"), encoding="utf-8")
    return json.loads(parser["project"]["scenes"])
