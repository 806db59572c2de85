"""Finds phi instructions of aggregate types in SPIR-V.

A phi of a structure or array is legal, but compilers rarely meet one: glslang never makes any, and drivers are tested with
glslang's output. spirv-opt makes them if it promotes a variable to a value before it has split the variable into scalars and
vectors. Debian has no Python library for SPIR-V.
"""

import struct

MAGIC = 0x07230203
HEADER_WORDS = 5
OP_TYPE_ARRAY = 28
OP_TYPE_RUNTIME_ARRAY = 29
OP_TYPE_STRUCT = 30
OP_PHI = 245


def load_words(path):
    """Return the words of a SPIR-V file; a ValueError names a file that holds none."""
    with open(path, "rb") as file:
        data = file.read()
    words = struct.unpack("<%dI" % (len(data) // 4), data[: len(data) // 4 * 4])
    if len(words) < HEADER_WORDS or words[0] != MAGIC:
        raise ValueError("%s holds no SPIR-V. Build it again." % path)
    return words


def count_aggregate_phis(words):
    """Return how many phi instructions have the type of a structure or an array."""
    aggregates = set()
    count = 0
    at = HEADER_WORDS
    while at < len(words):
        length, op = words[at] >> 16, words[at] & 0xFFFF
        if length == 0:
            raise ValueError("The SPIR-V is damaged at word %d. Build it again." % at)
        if op in (OP_TYPE_ARRAY, OP_TYPE_RUNTIME_ARRAY, OP_TYPE_STRUCT):
            aggregates.add(words[at + 1])  # types come before functions
        elif op == OP_PHI and words[at + 1] in aggregates:
            count += 1
        at += length
    return count
