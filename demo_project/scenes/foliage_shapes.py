"""Cards (single quads), and textures whose alpha cuts leaves and chain link out of them. Standard library only.

The edge of each alpha mask is known in closed form: alpha is 1/2 there, and changes by 1 over two texels (star:
1.1 to 2.9).
"""

import math

from gltf_writer import Mesh, add, cross, encode_png, normalize, scale

WIRE_HALF_WIDTH = 0.075  # of chain link, in tiles


def make_card(half_x, half_y, repeats=(1.0, 1.0)):
    """Return a card in the plane z = 0 whose image is upright. repeats: how often the image repeats along x and y."""
    mesh = Mesh(is_closed=False)
    for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        uv = (0.5 * (x + 1) * repeats[0], 0.5 * (1 - y) * repeats[1])
        mesh.add_vertex((x * half_x, y * half_y, 0.0), (0.0, 0.0, 1.0), uv)
    mesh.add_quad(0, 1, 2, 3)
    return mesh


def get_leaf_depth(shape, x, y):
    """Return a point's depth inside a leaf, in image widths (star: approximate); negative outside. shape: oval or star. x, y: -0.5 .. 0.5."""
    if shape == "oval":  # a lens: where two discs meet
        radius, offset = 0.52, 0.28
        return radius - max(math.hypot(x - offset, y), math.hypot(x + offset, y))
    lobes = 0.30 + 0.13 * math.cos(5.0 * math.atan2(x, y))  # a star of five lobes
    return (lobes - math.hypot(x, y)) * 0.7  # roughly the distance, as the edge is oblique to the radius


def get_chain_depth(u, v):
    """Return a point's depth inside a chain-link wire, in tiles; both wires of a tile run from corner to corner."""
    distance = min(abs((along + 0.5) % 1.0 - 0.5) for along in (u + v, u - v)) / math.sqrt(2.0)
    return WIRE_HALF_WIDTH - distance


def make_mask_png(size_px, get_depth, get_color):
    """Return a texture. get_depth(u, v): depth inside the mask in image widths, negative outside. get_color(u, v): sRGB."""
    rows = []
    for y in range(size_px):
        row = []
        for x in range(size_px):
            u, v = (x + 0.5) / size_px, (y + 0.5) / size_px
            alpha = 0.5 + 0.5 * get_depth(u, v) * size_px
            row += [round(255 * min(max(value, 0.0), 1.0)) for value in (*get_color(u, v), alpha)]
        rows.append(row)
    return encode_png(size_px, size_px, rows)


def make_leaf_png(shape, color, size_px=64):
    """Return the texture of a leaf. shape: as in get_leaf_depth. color: sRGB, darkened at the veins."""

    def get_color(u, v):
        vein = 1.0 - 0.25 * math.exp(-(((u - 0.5) * 24) ** 2)) - 0.1 * math.cos(40.0 * (v + abs(u - 0.5)))
        return [value * vein for value in color]

    return make_mask_png(size_px, lambda u, v: get_leaf_depth(shape, u - 0.5, 0.5 - v), get_color)


def make_chain_png(size_px=64):
    def get_color(u, v):
        return [0.55 + 0.35 * max(get_chain_depth(u, v), 0.0) / WIRE_HALF_WIDTH] * 3

    return make_mask_png(size_px, get_chain_depth, get_color)


def make_stone_png(generator, size_px=128, rows=8, columns=4):
    """Return an opaque texture of stone blocks."""
    shades = {(row, column): 0.75 + 0.25 * generator.random() for row in range(rows) for column in range(columns)}
    grain = [[generator.uniform(-0.03, 0.03) for _x in range(size_px)] for _y in range(size_px)]

    def get_color(u, v):
        row = int(v * rows) % rows
        across = u * columns + (0.5 if row % 2 else 0.0)
        # Distance to the nearest joint, in block heights: with two rows per column, blocks are twice as
        # wide as high.
        to_joint = min(v * rows % 1.0, 1.0 - v * rows % 1.0, 2 * (across % 1.0), 2 * (1.0 - across % 1.0))
        shade = shades[row, int(across) % columns] * (0.55 if to_joint < 0.06 else 1.0)
        shade += grain[int(v * size_px) % size_px][int(u * size_px) % size_px]
        return 0.80 * shade, 0.72 * shade, 0.60 * shade

    return make_mask_png(size_px, lambda _u, _v: 1.0, get_color)


def add_rotated_card(mesh, card, center, normal, up_angle_rad):
    """Add a card that faces along the normal and is rotated about it by up_angle_rad."""
    n = normalize(normal)
    side = normalize(cross((0.0, 1.0, 0.0) if abs(n[1]) < 0.9 else (1.0, 0.0, 0.0), n))
    up = cross(n, side)
    c, s = math.cos(up_angle_rad), math.sin(up_angle_rad)
    x_axis = add(scale(side, c), scale(up, s))
    y_axis = add(scale(up, c), scale(side, -s))
    first = len(mesh.positions)
    for (x, y, _z), uv in zip(card.positions, card.uvs):
        mesh.add_vertex(add(center, add(scale(x_axis, x), scale(y_axis, y))), n, uv)
    mesh.triangles += [(a + first, b + first, c + first) for a, b, c in card.triangles]


def make_leaves(generator, count, half_size_m, center, radius_m):
    """Return cards in an ellipsoid 0.8 as high as wide that face up and outwards; density falls as distance ** -0.5."""
    mesh = Mesh(is_closed=False, is_manifold=False)
    card = make_card(half_size_m, half_size_m)
    for _leaf in range(count):
        direction = normalize([generator.gauss(0.0, 1.0) for _axis in range(3)])
        distance = radius_m * generator.random() ** 0.4
        position = add(center, scale((direction[0], 0.8 * direction[1], direction[2]), distance))
        normal = add(scale(direction, 0.7), (generator.gauss(0.0, 0.4), 0.7 + generator.gauss(0.0, 0.4), generator.gauss(0.0, 0.4)))
        add_rotated_card(mesh, card, position, normal, generator.uniform(0.0, 2.0 * math.pi))
    return mesh
