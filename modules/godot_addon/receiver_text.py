"""Writes the add-on's shader code as C++ strings, which are inserted into shaders at run time.

Godot's RenderingServer has no preprocessor, so macros are expanded here. The code is split into four parts: declarations and
functions, which are inserted before a shader's first function; light(), which is appended; and code for the end of fragment().
"""

import re

DECLARATION = re.compile(r"(?:global uniform|varying|const) .*;\n", re.MULTILINE)
DEFINE = re.compile(r"^#define (\w+) (.*)\n", re.MULTILINE)
COMMENT = re.compile(r"^\t*//.*\n|^\n", re.MULTILINE)
LIGHT = "void light()"
FRAGMENT_MARK = "// fragment\n"
FRAGMENT = FRAGMENT_MARK + "GNOMON_FRAGMENT\n"


def split_code(texts):
    """Expand the macros of the concatenated texts. Return (declarations, functions, light(), code for the end of fragment())."""
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
    """Write the four parts of the shader files `sources` as strings into the header `target`."""
    texts = []
    for path in sources:
        with open(path, encoding="utf-8") as file:
            texts.append(file.read())
    names = ("RECEIVER_DECLARATIONS", "RECEIVER_FUNCTIONS", "RECEIVER_LIGHT", "RECEIVER_FRAGMENT")
    lines = ["#pragma once", "", "namespace gnomon {", ""]
    for name, text in zip(names, split_code(texts)):
        lines.append('inline const char %s[] = R"shader(%s)shader";' % (name, text))
    lines += ["", "} // namespace gnomon", ""]
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
