"""Finds subgroup operations in divergent control flow, in the NIR that Mesa's drivers report for a shader.

NIR prints for each value whether it is divergent ("div") or the same in all invocations ("con"). An operation is in divergent
flow if an `if` around it has a divergent condition, or if invocations leave a loop around it at different times: at a `break`
or `continue` inside a divergent `if`.
"""

import re

_VALUE = re.compile(r"\s*vec\d+\s+\d+\s+(div|con)\s+(ssa_\d+)\b")
_IF = re.compile(r"if (ssa_\d+) \{")
_INTRINSIC = re.compile(r"\bintrinsic (\w+)")
_SUBGROUP = re.compile(r"ballot|shuffle|reduce|inclusive_scan|exclusive_scan|elect|vote|first_invocation|read_invocation|quad_")
BARRIER = "scoped_barrier"
_MEMORY_ONLY = "execution_scope=NONE"


class NirError(Exception):
    """The text is not NIR as this module reads it."""


class _Scope:
    """A loop or an `if`. A loop becomes divergent at its first divergent exit."""

    def __init__(self, is_loop, is_divergent):
        self.is_loop = is_loop
        self.is_divergent = is_divergent


def _is_subgroup_operation(line):
    found = _INTRINSIC.search(line)
    if not found:
        return False
    name = found.group(1)
    return bool(_SUBGROUP.search(name)) or (name == BARRIER and _MEMORY_ONLY not in line)


def _leave(scopes):
    """Mark the loop that a `break` or `continue` leaves as divergent, if some invocations stay."""
    is_divergent = False
    for scope in reversed(scopes):
        if scope.is_loop:
            scope.is_divergent = scope.is_divergent or is_divergent
            return
        is_divergent = is_divergent or scope.is_divergent


def find_subgroup_operations(text):
    """Return a list of (line number from 1, line, whether it is in divergent flow) of the shader's subgroup operations and
    barriers. Operations between the start of a loop and its divergent exit count as divergent too: some invocations have left
    in an earlier iteration."""
    lines = text.splitlines()
    divergence = {}
    for line in lines:
        found = _VALUE.match(line)
        if found:
            divergence[found.group(2)] = found.group(1) == "div"
    if not divergence:
        raise NirError("There is no value with div or con. Is this NIR of Mesa 22.3?")
    scopes, operations = [], []
    for number, line in enumerate(lines, 1):
        words = line.strip()
        condition = _IF.match(words)
        if condition:
            if condition.group(1) not in divergence:
                raise NirError("Line %d: %s has no div or con." % (number, condition.group(1)))
            scopes.append(_Scope(False, divergence[condition.group(1)]))
        elif words == "loop {":
            scopes.append(_Scope(True, False))
        elif words.endswith("{") and words != "} else {" and not words.startswith(("impl ", "decl_function ")):
            raise NirError("Line %d begins an unknown block: %s" % (number, words))
        elif words.startswith("}") and words != "} else {" and scopes:
            scopes.pop()
        elif words in ("break", "continue"):
            _leave(scopes)
        elif _is_subgroup_operation(words):
            operations.append((number, words, list(scopes)))
    return [(number, words, any(scope.is_divergent for scope in around)) for number, words, around in operations]
