"""Cards whose alpha is a grid of small shapes: discs, squares, rings and mixtures, as in perforated sheets and dense foliage.

Their outlines have hundreds of small loops close to each other: the smaller a shape is compared with an outline's tolerance, the more
area lines between its corners would lose.
"""

import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from foliage_shapes import make_card  # noqa: E402
from gltf_writer import Document, encode_png, quaternion_about  # noqa: E402
from shapes import make_quad  # noqa: E402
from volume_scenes import save  # noqa: E402

KINDS = ("disc", "square", "diamond", "ring", "mixed", "inverse")
TEXEL_M = 2.4 / 256
CARD_HEIGHT_M = 8.0


def is_inside(kind, radius, x, y, turn):
    """Whether a point is inside a shape around the origin; turn: angle of squares in radians."""
    if kind in ("disc", "inverse"):
        return math.hypot(x, y) <= radius
    if kind == "ring":
        return 0.6 * radius <= math.hypot(x, y) <= radius
    u, v = x * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - x * math.sin(turn)
    return max(abs(u), abs(v)) <= radius


def make_shapes_png(kind, radius, spacing, size_px, seed):
    """Return an RGBA PNG of shapes of a radius, one each `spacing` texels; all in texels.

    "inverse": holes. "mixed": discs, squares and rings of random sizes up to the radius, at random positions.
    """
    generator = random.Random(seed)
    width, height = size_px
    alpha = [bytearray(width) for _ in range(height)]
    for row in range(height // spacing):
        for column in range(width // spacing):
            shape, size, turn, x, y = kind, radius, 0.0, (column + 0.5) * spacing, (row + 0.5) * spacing
            if kind == "diamond":
                shape, turn = "square", 0.25 * math.pi
            if kind == "mixed":
                shape = generator.choice(("disc", "square", "ring"))
                size, turn = radius * generator.uniform(0.4, 1.0), generator.uniform(0, math.pi)
                slack = max(0.5 * spacing - 1.5 * size, 0.0)
                x, y = x + generator.uniform(-slack, slack), y + generator.uniform(-slack, slack)
            for texel_y in range(max(int(y - 2 * size), 0), min(int(y + 2 * size) + 1, height)):
                for texel_x in range(max(int(x - 2 * size), 0), min(int(x + 2 * size) + 1, width)):
                    if is_inside(shape, size, texel_x + 0.5 - x, texel_y + 0.5 - y, turn):
                        alpha[texel_y][texel_x] = 255
    if kind == "inverse":
        alpha = [bytearray(255 - value for value in row) for row in alpha]
    return encode_png(width, height, [b"".join(b"\x59\x8c\x3c" + bytes((value,)) for value in row) for row in alpha])


def make_shape_card(folder, kind, radius=6.0, spacing=16, size_px=(256, 512), seed=1):
    """Write a scene with one such card above a ground, and a sun, a spot and an omni light. Return its path."""
    document = Document(12.0)
    document.add_camera("Camera", (-2.6, 5.2, 4.6), (-3.6, 0.0, -2.4), math.radians(60.0))
    grey = document.add_material("Grey", (0.6, 0.6, 0.6))
    green = document.add_material("Shapes", (1.0, 1.0, 1.0), is_double_sided=True)
    png = make_shapes_png(kind, radius, spacing, size_px, seed)
    document.set_texture(green, document.add_texture("shapes.png", png), is_cut_out=True)
    card = make_card(0.5 * size_px[0] * TEXEL_M, 0.5 * size_px[1] * TEXEL_M)
    document.add_object("Card", card, green, (0.0, CARD_HEIGHT_M, 0.0), quaternion_about((1.0, 0.0, 0.0), -0.5 * math.pi))
    document.add_object("Ground", make_quad(40.0, 40.0), grey, rotation=quaternion_about((1.0, 0.0, 0.0), -0.5 * math.pi))
    shadow = {"shadow_enabled": True, "light_size": 0.4}
    sun = {"type": "directional", "intensity": 3.0}
    document.add_light("Sun", sun, (4.0, 10.0, 3.6), (0.0, 0.0, 0.0), {"shadow_enabled": True})
    spot = {"type": "spot", "intensity": 2000.0, "spot": {"outerConeAngle": 0.6}}
    document.add_light("Spot", spot, (2.6, 14.0, 2.2), (-1.5, 0.0, -1.0), shadow)
    document.add_light("Omni", {"type": "point", "intensity": 2000.0}, (2.6, 14.0, 2.2), None, shadow)
    return save(document, "shapes", folder)
