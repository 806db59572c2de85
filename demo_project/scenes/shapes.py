"""Meshes of the demo scenes. Each function returns a gltf_writer.Mesh in its own space."""

import json
import math
import os
import random

from gltf_writer import Mesh, add, cross, normalize, scale, subtract


def make_box(half):
    """Return a box about the origin with hard edges; half: its half extents."""
    mesh = Mesh()
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = [0.0, 0.0, 0.0]
            normal[axis] = sign
            u, v = (axis + 1) % 3, (axis + 2) % 3
            corners = []
            for su, sv in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis] = sign * half[axis]
                corner[u] = su * half[u]
                corner[v] = sv * half[v]
                corners.append(mesh.add_vertex(corner, normal))
            mesh.add_quad(*(corners if sign > 0 else reversed(corners)))
    return mesh


def make_icosphere(subdivisions, radius):
    """Return a smooth sphere about the origin: an icosahedron whose faces are split into four, `subdivisions` times."""
    golden_ratio = (1.0 + math.sqrt(5.0)) / 2.0
    points = []
    for a, b in ((-1, golden_ratio), (1, golden_ratio), (-1, -golden_ratio), (1, -golden_ratio)):
        points.append(normalize((a, b, 0.0)))
    for a, b in ((-1, golden_ratio), (1, golden_ratio), (-1, -golden_ratio), (1, -golden_ratio)):
        points.append(normalize((0.0, a, b)))
    for a, b in ((-1, golden_ratio), (1, golden_ratio), (-1, -golden_ratio), (1, -golden_ratio)):
        points.append(normalize((b, 0.0, a)))
    triangles = [
        (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11),
        (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
        (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9),
        (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1),
    ]  # fmt: skip
    for _ in range(subdivisions):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(normalize(add(points[a], points[b])))
            return middles[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    mesh = Mesh()
    for point in points:
        mesh.add_vertex(scale(point, radius), point)
    mesh.triangles = triangles
    return mesh


def close_tube(mesh, along_count, around_count):
    """Add quads between the vertex rings of a tube whose last ring joins the first one."""
    for i in range(along_count):
        for j in range(around_count):
            here, there = i * around_count, (i + 1) % along_count * around_count
            k = (j + 1) % around_count
            mesh.add_quad(here + j, here + k, there + k, there + j)


def make_torus_knot(size, tube_radius, along_count, around_count):
    """Return a round tube along the curve size * ((2 + cos 3t) cos 2t, -sin 3t, (2 + cos 3t) sin 2t)."""
    mesh = Mesh()
    for i in range(along_count):
        t = 2.0 * math.pi * i / along_count
        wide = 2.0 + math.cos(3.0 * t)
        center = scale((wide * math.cos(2.0 * t), -math.sin(3.0 * t), wide * math.sin(2.0 * t)), size)
        slope = -3.0 * math.sin(3.0 * t)
        tangent = normalize(
            (
                slope * math.cos(2.0 * t) - 2.0 * wide * math.sin(2.0 * t),
                -3.0 * math.cos(3.0 * t),
                slope * math.sin(2.0 * t) + 2.0 * wide * math.cos(2.0 * t),
            )
        )
        # The normal of the torus on which the curve lies. It is periodic along the curve, unlike a
        # frame that is transported along it.
        outward = (math.cos(3.0 * t) * math.cos(2.0 * t), -math.sin(3.0 * t), math.cos(3.0 * t) * math.sin(2.0 * t))
        side = normalize(cross(tangent, outward))
        upward = cross(side, tangent)
        for j in range(around_count):
            angle = 2.0 * math.pi * j / around_count
            normal = add(scale(upward, math.cos(angle)), scale(side, math.sin(angle)))
            mesh.add_vertex(add(center, scale(normal, tube_radius)), normal)
    close_tube(mesh, along_count, around_count)
    return mesh


def make_torus(radius, tube_radius, along_count, around_count):
    """Return a torus about the Y axis."""
    mesh = Mesh()
    for i in range(along_count):
        turn = 2.0 * math.pi * i / along_count
        outward = (math.cos(turn), 0.0, math.sin(turn))
        for j in range(around_count):
            angle = 2.0 * math.pi * j / around_count
            normal = add(scale(outward, math.cos(angle)), (0.0, math.sin(angle), 0.0))
            mesh.add_vertex(add(scale(outward, radius), scale(normal, tube_radius)), normal)
    close_tube(mesh, along_count, around_count)
    return mesh


def evaluate_bezier(points, t):
    """Return the point at t of the cubic Bezier curve with four control points."""
    s = 1.0 - t
    weights = (s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t)
    return tuple(sum(weight * point[axis] for weight, point in zip(weights, points)) for axis in range(3))


def make_teapot(size, step_count):
    """Return Newell's teapot (1975), see third_party/teapot: 3.15 * size high, on the plane y = 0. Each of its
    32 patches becomes step_count^2 quads. Lid, body, handle and spout are open surfaces."""
    folder = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    with open(os.path.join(folder, "third_party", "teapot", "patches.json"), encoding="utf-8") as file:
        data = json.load(file)
    mesh = Mesh(is_closed=False)
    known = {}

    def add_point(point):
        # Points where patches meet are equal except for rounding. Adding 0 turns -0 into 0.
        key = tuple(round(value, 6) + 0.0 for value in (point[0] * size, point[2] * size, -point[1] * size))
        if key not in known:
            known[key] = mesh.add_vertex(key, (0.0, 1.0, 0.0))
        return known[key]

    for patch in data["patches"]:
        rows = [[data["vertices"][index] for index in patch[4 * row : 4 * row + 4]] for row in range(4)]
        grid = []
        for i in range(step_count + 1):
            curve = [evaluate_bezier(row, i / step_count) for row in rows]
            grid.append([add_point(evaluate_bezier(curve, j / step_count)) for j in range(step_count + 1)])
        for i in range(step_count):
            for j in range(step_count):
                corners = (grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1])
                for triangle in ((corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])):
                    if len(set(triangle)) == 3:  # an edge of some patches is a single point
                        mesh.triangles.append(triangle)
    mesh.set_smooth_normals()
    return mesh


def make_cylinder(radius, half_height, side_count):
    """Return a cylinder about +Y with flat caps and a smooth side."""
    mesh = Mesh()
    rim = [
        (math.cos(2.0 * math.pi * i / side_count), math.sin(2.0 * math.pi * i / side_count))
        for i in range(side_count)
    ]
    for i in range(side_count):
        for sign in (-1.0, 1.0):
            mesh.add_vertex((radius * rim[i][0], sign * half_height, radius * rim[i][1]), (rim[i][0], 0.0, rim[i][1]))
    for i in range(side_count):
        j = (i + 1) % side_count
        mesh.add_quad(2 * i, 2 * i + 1, 2 * j + 1, 2 * j)
    for sign in (-1.0, 1.0):
        normal = (0.0, sign, 0.0)
        center = mesh.add_vertex((0.0, sign * half_height, 0.0), normal)
        first = len(mesh.positions)
        for x, z in rim:
            mesh.add_vertex((radius * x, sign * half_height, radius * z), normal)
        for i in range(side_count):
            j = (i + 1) % side_count
            mesh.add_triangle(center, first + (i if sign < 0 else j), first + (j if sign < 0 else i))
    return mesh


def make_clutter(count, half, center, ball_radius, seed):
    """Return one mesh of equal boxes (half: their half extents) at random positions in a ball, each rotated at random."""
    generator = random.Random(seed)
    box = make_box(half)
    mesh = Mesh()
    for _ in range(count):
        while True:
            offset = tuple(2.0 * generator.random() - 1.0 for _ in range(3))
            if sum(value * value for value in offset) <= 1.0:
                break
        # Shoemake 1992, "Uniform random rotations".
        u, v, w = (generator.random() for _ in range(3))
        turn = (
            math.sqrt(1.0 - u) * math.sin(2.0 * math.pi * v),
            math.sqrt(1.0 - u) * math.cos(2.0 * math.pi * v),
            math.sqrt(u) * math.sin(2.0 * math.pi * w),
            math.sqrt(u) * math.cos(2.0 * math.pi * w),
        )
        mesh.add_mesh(box, turn, add(center, scale(offset, ball_radius)))
    return mesh


# x, z, height, width (standard deviation), all in metres.
HILLS = ((-0.9, -0.5, 0.90, 0.55), (0.9, -1.1, 0.80, 0.50), (0.4, 0.9, 0.70, 0.42), (-1.8, 1.3, 0.75, 0.48), (1.9, 0.5, 0.72, 0.38))
# Wave number in rad/m and height in metres of each octave of ripples.
RIPPLES = ((2.6, 0.05), (5.4, 0.025), (11.0, 0.012))


def make_terrain(cell_count, half_width, floor_y, seed):
    """Return a heightfield of hills and ripples, closed by a skirt and a floor."""
    generator = random.Random(seed)
    waves = []
    for wave_number, height in RIPPLES:
        for _ in range(3):
            direction = 2.0 * math.pi * generator.random()
            phase = 2.0 * math.pi * generator.random()
            waves.append((wave_number * math.cos(direction), wave_number * math.sin(direction), phase, height / 3.0))

    def height_at(x, z):
        y = 0.0
        for hill_x, hill_z, height, width in HILLS:
            y += height * math.exp(-((x - hill_x) ** 2 + (z - hill_z) ** 2) / (2.0 * width * width))
        return y + sum(height * math.sin(kx * x + kz * z + phase) for kx, kz, phase, height in waves)

    mesh = Mesh()
    side = cell_count + 1
    for i in range(side):
        for j in range(side):
            x = half_width * (2.0 * i / cell_count - 1.0)
            z = half_width * (2.0 * j / cell_count - 1.0)
            mesh.add_vertex((x, height_at(x, z), z), (0.0, 1.0, 0.0))
    for i in range(cell_count):
        for j in range(cell_count):
            a = i * side + j
            mesh.add_quad(a, a + 1, a + side + 1, a + side)
    mesh.set_smooth_normals()

    # The border of the grid, counterclockwise seen from above.
    last = cell_count
    border = [(0, j) for j in range(last)] + [(i, last) for i in range(last)]
    border += [(last, j) for j in range(last, 0, -1)] + [(i, 0) for i in range(last, 0, -1)]
    tops = [mesh.positions[i * side + j] for i, j in border]
    floor_normal = (0.0, -1.0, 0.0)
    center = mesh.add_vertex((0.0, floor_y, 0.0), floor_normal)
    for k, top in enumerate(tops):
        following = tops[(k + 1) % len(tops)]
        low, low_following = (top[0], floor_y, top[2]), (following[0], floor_y, following[2])
        outward = cross(subtract(following, top), (0.0, 1.0, 0.0))
        mesh.add_quad(
            mesh.add_vertex(top, outward),
            mesh.add_vertex(low, outward),
            mesh.add_vertex(low_following, outward),
            mesh.add_vertex(following, outward),
        )
        mesh.add_triangle(center, mesh.add_vertex(low_following, floor_normal), mesh.add_vertex(low, floor_normal))
    return mesh


def make_cloth(cell_count, half_width, wave_height):
    """Return an open, wavy mesh about the origin."""
    mesh = Mesh(is_closed=False)
    side = cell_count + 1
    for i in range(side):
        for j in range(side):
            x = half_width * (2.0 * i / cell_count - 1.0)
            z = half_width * (2.0 * j / cell_count - 1.0)
            y = wave_height * (math.sin(5.5 * x + 0.6) * math.cos(3.5 * z) + 0.5 * math.sin(8.0 * z + 2.0 * x))
            mesh.add_vertex((x, y, z), (0.0, 1.0, 0.0))
    for i in range(cell_count):
        for j in range(cell_count):
            a = i * side + j
            mesh.add_quad(a, a + 1, a + side + 1, a + side)
    mesh.set_smooth_normals()
    return mesh


def make_quad(half_width, half_height):
    """Return a quad in the plane z = 0 that faces +Z."""
    mesh = Mesh(is_closed=False)
    normal = (0.0, 0.0, 1.0)
    corners = ((-half_width, -half_height), (half_width, -half_height), (half_width, half_height), (-half_width, half_height))
    mesh.add_quad(*(mesh.add_vertex((x, y, 0.0), normal) for x, y in corners))
    return mesh
