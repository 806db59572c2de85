"""Makes C++ strings of the add-on's shader text, for materials that get it at run time.

Godot's RenderingServer knows no preprocessor, and wants declarations before the first function: defines are put in, and
each file's text is divided.
"""

import re

DECLARATION = re.compile(r"(?:global uniform|varying|const) .*;\n", re.MULTILINE)
DEFINE = re.compile(r"^#define (\w+) (.*)\n", re.MULTILINE)
COMMENT = re.compile(r"^\t*//.*\n|^\n", re.MULTILINE)
LIGHT = "void light()"
FRAGMENT_MARK = "// fragment\n"
FRAGMENT = FRAGMENT_MARK + "GNOMON_FRAGMENT\n"


def divide(texts):
    """(declarations, functions, light(), the end of fragment()) of files behind one another."""
    text = COMMENT.sub("", "".join(texts))
    defines = dict(DEFINE.findall(text))
    text = DEFINE.sub("", text) + FRAGMENT
    names = re.compile(r"\b(%s)\b" % "|".join(defines))
    while names.search(text):
        text = names.sub(lambda match: defines[match[1]], text)
    text, fragment = text.split(FRAGMENT_MARK)
    declarations = "".join(DECLARATION.findall(text))
    functions, light = DECLARATION.sub("", text).split(LIGHT)
    return declarations, functions, LIGHT + light, fragment


def write_header(sources, target):
    texts = []
    for path in sources:
        with open(path, encoding="utf-8") as file:
            texts.append(file.read())
    names = ("RECEIVER_DECLARATIONS", "RECEIVER_FUNCTIONS", "RECEIVER_LIGHT", "RECEIVER_FRAGMENT")
    lines = ["#pragma once", "", "namespace gnomon {", ""]
    for name, text in zip(names, divide(texts)):
        lines.append('inline const char %s[] = R"shader(%s)shader";' % (name, text))
    lines += ["", "} // namespace gnomon", ""]
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
