"""Meshes with the usual flaws of artists' work: intersecting parts in one mesh, open, duplicated and non-manifold faces.

Functions take random numbers from a seeded generator and return a gltf_writer.Mesh in metres with the ground at y = 0.
Only finite positions, normals of unit length, and triangles with an area are guaranteed.
"""

import math

from gltf_writer import Mesh, add, cross, dot, normalize, quaternion_about, quaternion_from_y, rotate, scale, subtract
from shapes import make_box, make_quad


def make_open_tube(points, radius, side_count, angle_rad=0.0):
    """Return a tube with smooth normals and without caps along a polyline. It twists where the direction's |x| crosses 0.8."""
    mesh = Mesh(is_closed=False)
    for i, point in enumerate(points):
        along = normalize(subtract(points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)]))
        helper = (1.0, 0.0, 0.0) if abs(along[0]) < 0.8 else (0.0, 0.0, 1.0)
        right = normalize(cross(along, helper))
        up = cross(right, along)
        for j in range(side_count):
            angle = angle_rad + 2.0 * math.pi * j / side_count
            normal = add(scale(right, math.cos(angle)), scale(up, math.sin(angle)))
            mesh.add_vertex(add(point, scale(normal, radius)), normal)
    for i in range(len(points) - 1):
        for j in range(side_count):
            k = (j + 1) % side_count
            first, second = i * side_count, (i + 1) * side_count
            mesh.add_quad(first + j, second + j, second + k, first + k)
    return mesh


def make_strip(left, right):
    """Return quads with flat normals between two polylines. Seen from their front, along the polylines, `left` is on
    the left."""
    mesh = Mesh(is_closed=False)
    for i in range(len(left) - 1):
        corners = (left[i], right[i], right[i + 1], left[i + 1])
        normal = cross(subtract(corners[2], corners[0]), subtract(corners[3], corners[1]))
        mesh.add_quad(*(mesh.add_vertex(corner, normal) for corner in corners))
    return mesh


def mix(a, b, t):
    return add(scale(a, 1.0 - t), scale(b, t))


def pick_rotation(generator):
    """Return a random rotation: upright with any yaw in three of four cases, else tilted in any upward direction."""
    yaw = quaternion_about((0.0, 1.0, 0.0), 2.0 * math.pi * generator.random())
    if generator.random() < 0.75:
        return yaw
    direction = normalize((generator.uniform(-1.0, 1.0), generator.uniform(0.1, 1.0), generator.uniform(-1.0, 1.0)))
    return quaternion_from_y(direction)


def make_kitbash_part(generator):
    """Return a box, an open tube, a plank or a card, centred at the origin."""
    kind = generator.choice(("box", "tube", "plank", "card"))
    if kind == "box":
        mesh = make_box([generator.uniform(0.05, 0.16) for _ in range(3)])
        if generator.random() < 0.3:  # with its last face deleted, as artists do with hidden faces
            mesh.triangles = mesh.triangles[:-2]
        return mesh
    if kind == "tube":
        half = generator.uniform(0.15, 0.5)
        side_count = generator.choice((8, 12, 24))
        return make_open_tube([(0.0, -half, 0.0), (0.0, half, 0.0)], generator.uniform(0.02, 0.09), side_count)
    if kind == "plank":
        return make_box((generator.uniform(0.2, 0.5), generator.uniform(0.005, 0.015), generator.uniform(0.04, 0.1)))
    return make_quad(generator.uniform(0.1, 0.3), generator.uniform(0.1, 0.3))


# One part in DUPLICATE_STEP is duplicated, and one in THIRD_FACE_STEP has a third face on one of its edges.
DUPLICATE_STEP, THIRD_FACE_STEP = 30, 20


def make_kitbash(generator, part_count):
    """Return a mound of parts in one mesh: closed and open, intersecting each other and the ground, some duplicated, some
    with an edge of three faces. The first twentieth of them are broad slabs and cards on which the others cast shadows."""
    mesh = Mesh(is_closed=False, is_manifold=False)
    for index in range(part_count):
        # Uniform over a disc, and higher towards its centre.
        distance = 1.55 * math.sqrt(generator.random())
        angle = 2.0 * math.pi * generator.random()
        height = (1.75 - distance) * generator.random()
        position = (distance * math.cos(angle), height, distance * math.sin(angle))
        if index < part_count // 20:
            tilt = generator.uniform(-0.3, 0.3)
            if index % 2:
                part = make_box((generator.uniform(0.3, 0.5), 0.03, generator.uniform(0.25, 0.4)))
                rotation = quaternion_about((1.0, 0.0, 0.6), tilt)
            else:
                part, rotation = make_quad(0.45, 0.35), quaternion_about((1.0, 0.0, 0.3), tilt - 0.5 * math.pi)
        else:
            part, rotation = make_kitbash_part(generator), pick_rotation(generator)
        first_vertex = len(mesh.positions)
        mesh.add_mesh(part, rotation, position)
        if index % DUPLICATE_STEP == 0:
            mesh.triangles += [tuple(corner + first_vertex for corner in triangle) for triangle in part.triangles]
        if index % THIRD_FACE_STEP == 0:
            add_third_face(mesh, mesh.triangles[-1], generator.uniform(0.05, 0.2))
    return mesh


def add_third_face(mesh, triangle, height):
    """Add a third face to the triangle's first edge, in the direction of the triangle's normal."""
    a, b, c = (mesh.positions[index] for index in triangle)
    triangle_normal = normalize(cross(subtract(b, a), subtract(c, a)))
    normal = cross(subtract(b, a), triangle_normal)
    corners = (b, a, add(a, scale(triangle_normal, height)))
    if dot(cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0])), normal) < 0.0:
        normal = scale(normal, -1.0)
    mesh.add_triangle(*(mesh.add_vertex(corner, normal) for corner in corners))


def make_rope_points(start, end, sag, segment_count):
    """Return points of a parabola from start to end that hangs down by sag, in metres, halfway."""
    points = []
    for i in range(segment_count + 1):
        t = i / segment_count
        points.append(subtract(mix(start, end, t), (0.0, 4.0 * sag * t * (1.0 - t), 0.0)))
    return points


HULL_HALF_LENGTH, HULL_HALF_BEAM, RAIL_HEIGHT, KEEL_HEIGHT = 1.6, 0.45, 0.55, 0.03  # the rail: amidships
MASTS = ((-0.85, 1.75), (0.05, 2.1), (0.9, 1.6))  # x, height of the top
YARD_HALF_WIDTH = 0.6
YARD_HEIGHT_FRACTIONS = (0.62, 0.88)  # of the mast's height


def find_rail(x, side):
    """Return the point of the hull's upper edge at x; side: -1 or 1."""
    t = x / HULL_HALF_LENGTH
    return (x, RAIL_HEIGHT + 0.12 * t * t, side * HULL_HALF_BEAM * math.sqrt(max(0.0, 1.0 - t**4)))


def make_hull(strake_count=6, station_count=24):
    """Return a ship's hull: strakes (rows of planks) with separate vertices, a deck with hatches, masts and yards, all open.

    Planks and deck are inside out, which a double-sided material hides.
    """
    mesh = Mesh(is_closed=False, is_manifold=False)
    # Not quite to the ends, where the hull has no width and its quads would have no area.
    stations = [HULL_HALF_LENGTH * 0.985 * (2.0 * i / station_count - 1.0) for i in range(station_count + 1)]

    def find_point(x, side, t):
        # From the keel (t = 0) along a round section to the rail (t = 1).
        rail = find_rail(x, side)
        angle = 0.5 * math.pi * t
        return (x, KEEL_HEIGHT + (rail[1] - KEEL_HEIGHT) * (1.0 - math.cos(angle)), rail[2] * math.sin(angle))

    for side in (-1.0, 1.0):
        for strake in range(strake_count):
            lower = [find_point(x, side, strake / strake_count) for x in stations]
            # Each strake overlaps the next one a little, as on a clinker-built ship.
            upper = [find_point(x, side, min(1.0, (strake + 1.08) / strake_count)) for x in stations]
            mesh.add_mesh(make_strip(upper, lower) if side < 0.0 else make_strip(lower, upper))
    for i in range(station_count):
        if i % 7 == 3:
            continue  # a hatch
        # The deck, below the rail.
        port, starboard = ([find_point(x, side, 0.8) for x in stations[i : i + 2]] for side in (-1.0, 1.0))
        mesh.add_mesh(make_strip(starboard, port))
    for x, top in MASTS:
        mesh.add_mesh(make_open_tube([(x, 0.1, 0.0), (x, top, 0.0)], 0.028, 10))
        for height_fraction in YARD_HEIGHT_FRACTIONS:
            y = top * height_fraction
            mesh.add_mesh(make_open_tube([(x, y, -YARD_HALF_WIDTH), (x, y, YARD_HALF_WIDTH)], 0.015, 6))
    bow = find_rail(0.98 * HULL_HALF_LENGTH, 1.0)
    mesh.add_mesh(make_open_tube([(1.35, bow[1] - 0.1, 0.0), (1.95, bow[1] + 0.2, 0.0)], 0.02, 6))
    return mesh


LADDER_STEP = 7  # one rope in LADDER_STEP is a ladder


def make_rigging(generator, rope_count):
    """Return ropes, thin open tubes between rails, masts and yards, and ladders of two ropes and rungs."""
    mesh = Mesh(is_closed=False, is_manifold=False)
    for index in range(rope_count):
        mast_x, mast_top = generator.choice(MASTS)
        side = generator.choice((-1.0, 1.0))
        foot_x = max(-1.5, min(1.5, mast_x + generator.uniform(-0.45, 0.45)))
        foot = find_rail(foot_x, side)
        head = (mast_x, mast_top * generator.uniform(0.55, 0.98), 0.0)
        if index % LADDER_STEP == 0:
            add_ladder(mesh, foot, head, generator.uniform(0.05, 0.12))
            continue
        kind = generator.random()
        if kind < 0.3:  # from mast to mast
            other_x, other_top = generator.choice([mast for mast in MASTS if mast[0] != mast_x])
            foot = (other_x, other_top * generator.uniform(0.45, 0.98), 0.0)
        elif kind < 0.6:  # from a yard down to the rail
            yard_height = mast_top * generator.choice(YARD_HEIGHT_FRACTIONS)
            head = (mast_x, yard_height, side * generator.uniform(0.1, YARD_HALF_WIDTH))
        elif kind < 0.7:  # into the ground
            foot = (foot_x + generator.uniform(-0.4, 0.4), -0.05, side * generator.uniform(0.7, 1.3))
        points = make_rope_points(foot, head, generator.uniform(0.0, 0.12), 12)
        mesh.add_mesh(make_open_tube(points, generator.uniform(0.003, 0.007), 4, generator.random()))
    return mesh


def add_ladder(mesh, foot, head, half_width):
    rung_step = 0.09
    segment_count = 6  # of each rail
    rails = [
        make_rope_points((foot[0] + offset, foot[1], foot[2]), (head[0] + 0.25 * offset, head[1], head[2]), 0.02, segment_count)
        for offset in (-half_width, half_width)
    ]
    for rail in rails:
        mesh.add_mesh(make_open_tube(rail, 0.005, 4))
    rung_count = int(math.dist(foot, head) / rung_step)
    for i in range(1, rung_count):
        at = segment_count * i / rung_count
        segment = min(int(at), segment_count - 1)
        ends = [mix(rail[segment], rail[segment + 1], at - segment) for rail in rails]
        mesh.add_mesh(make_open_tube(ends, 0.004, 3))


GRASS_RADIUS = 1.5
BLADE_ROOT_DEPTH = 0.04


def make_grass(generator, blade_count):
    """Return bent blades of grass: open surfaces of two quads and a triangle that begin below the ground."""
    mesh = Mesh(is_closed=False, is_manifold=False)
    for _ in range(blade_count):
        distance, angle = GRASS_RADIUS * math.sqrt(generator.random()), 2.0 * math.pi * generator.random()
        root = (distance * math.cos(angle), -BLADE_ROOT_DEPTH, distance * math.sin(angle))
        height, half_width = generator.uniform(0.12, 0.45), generator.uniform(0.008, 0.02)
        bend = generator.uniform(0.0, 0.35) * height
        yaw = quaternion_about((0.0, 1.0, 0.0), 2.0 * math.pi * generator.random())
        slope = 2.0 * bend / height  # about the horizontal per vertical metre of the bent blade at its tip
        corners = []
        for t in (0.0, 0.45, 0.8, 1.0):
            center = (0.0, t * (height + BLADE_ROOT_DEPTH), bend * t * t)
            normal = rotate(yaw, normalize((0.0, -slope * t, 1.0)))
            width = half_width * (1.0 - t) ** 0.5
            for x in (-width, width) if t < 1.0 else (0.0,):
                corners.append(mesh.add_vertex(add(root, rotate(yaw, add(center, (x, 0.0, 0.0)))), normal))
        mesh.add_quad(corners[0], corners[1], corners[3], corners[2])
        mesh.add_quad(corners[2], corners[3], corners[5], corners[4])
        mesh.add_triangle(corners[4], corners[5], corners[6])
    return mesh
