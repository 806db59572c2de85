"""A waving flag: an open mesh whose morph targets are two waves along it and the sag of its free end. Standard library only.

At rest the flag is in the plane z = 0, from the pole at x = 0 towards +X, with its middle at y = 0. Parameters of its points
are s, 0 at the pole to 1 at the free end, and t, 0 at the lower to 1 at the upper edge.
"""

import math

from gltf_writer import Mesh, cross, normalize, subtract, to_float32

WIDTH_M, HEIGHT_M = 0.78, 0.52
COLUMNS, ROWS = 24, 16
WAVE_COUNT = 1.25  # along the flag
WAVE_M = 0.085  # amplitude at the free end
SAG_M = 0.11  # by which the free end hangs lower
CYCLE_S = 1.0
STEP = 1e-4  # of s and t, for derivatives


def get_rest(s, t):
    """Return the position at rest."""
    return (s * WIDTH_M, (t - 0.5) * HEIGHT_M, 0.0)


def get_wave(s, t, offset_rad):
    """Return the wave's z: its amplitude grows from the pole, and the crests of the running wave are further along at the upper edge."""
    return WAVE_M * s**1.3 * math.sin(2.0 * math.pi * WAVE_COUNT * s - 0.9 * t + offset_rad)


def get_deltas(name, s, t):
    """Return how far a morph target, one of TARGETS, moves a point."""
    if name == "Wave":
        return (0.0, 0.0, get_wave(s, t, 0.0))
    if name == "Wave, a quarter on":
        return (0.0, 0.0, get_wave(s, t, 0.5 * math.pi))
    return (-0.35 * SAG_M * s * s * (1.0 - t), -SAG_M * s * s, 0.05 * s * s * (1.0 - t))


# The second wave is the first one a quarter of its period earlier.
TARGETS = ("Wave", "Wave, a quarter on", "Sag")


def get_normal(get_point, s, t):
    # One-sided at the pole: get_wave() has no real value at s < 0.
    along = subtract(get_point(s + STEP, t), get_point(s - STEP if s > STEP else s, t))
    return normalize(cross(along, subtract(get_point(s, t + STEP), get_point(s, t - STEP))))


def make_flag():
    mesh = Mesh(is_closed=False)
    parameters = [(i / COLUMNS, j / ROWS) for j in range(ROWS + 1) for i in range(COLUMNS + 1)]
    for s, t in parameters:
        mesh.add_vertex(get_rest(s, t), (0.0, 0.0, 1.0), (s, 1.0 - t))
    for name in TARGETS:

        def get_point(s, t, name=name):
            return tuple(a + b for a, b in zip(get_rest(s, t), get_deltas(name, s, t)))

        normals = [subtract(get_normal(get_point, s, t), (0.0, 0.0, 1.0)) for s, t in parameters]
        deltas = [get_deltas(name, s, t) for s, t in parameters]
        # + 0.0 turns -0.0 into 0.0.
        mesh.targets.append((name, *([tuple(to_float32(value) + 0.0 for value in row) for row in rows] for rows in (deltas, normals))))
    for j in range(ROWS):
        for i in range(COLUMNS):
            first = j * (COLUMNS + 1) + i
            mesh.add_quad(first, first + 1, first + COLUMNS + 2, first + COLUMNS + 1)
    return mesh


def get_weights(time_s, loop_s):
    """Return the weights of TARGETS. Two waves a quarter period apart add up to one that runs from the pole to the free end; the
    sag changes once per loop."""
    phase_rad = 2.0 * math.pi * time_s / CYCLE_S
    return (math.cos(phase_rad), -math.sin(phase_rad), 0.55 + 0.35 * math.sin(2.0 * math.pi * time_s / loop_s))
