"""Makes a mesh of the surface on which a scalar field is zero. Standard library only.

Naive surface nets (Gibson 1998): one vertex in each grid cell that the surface crosses, and a quad for each grid edge whose
ends have different signs. Two things differ from the source: the grid planes may have any spacing, so that long limbs get
long triangles, and the vertices are moved to the surface afterwards.
"""

from gltf_writer import add, dot, normalize, scale, subtract

GRADIENT_STEP_M = 1e-4
CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]  # of a cell; bits of the index: x 4, y 2, z 1


def compute_gradient(field, point):
    """Return the gradient, which has unit length where the field is a distance."""
    result = []
    for axis in range(3):
        ahead, behind = list(point), list(point)
        ahead[axis] += GRADIENT_STEP_M
        behind[axis] -= GRADIENT_STEP_M
        result.append((field(ahead) - field(behind)) / (2.0 * GRADIENT_STEP_M))
    return tuple(result)


def move_to_surface(field, point, step_count=4):
    """Move a point to the surface by Newton steps along the gradient."""
    for _step in range(step_count):
        value = field(point)
        if abs(value) < 1e-6:  # metres, if the field is a distance
            break
        gradient = compute_gradient(field, point)
        # The gradient's squared length counts as at least 0.25: a step is at most twice the field's value.
        point = subtract(point, scale(gradient, value / max(dot(gradient, gradient), 0.25)))
    return point


def find_cell_point(samples, planes, cell):
    """Return the mean of the points where the surface crosses the cell's edges; None if it crosses none."""
    total, count = (0.0, 0.0, 0.0), 0
    corners = [tuple(cell[axis] + corner[axis] for axis in range(3)) for corner in CORNERS]
    values = [samples[corner] for corner in corners]
    if all(value > 0.0 for value in values) or not any(value > 0.0 for value in values):
        return None
    for first in range(8):
        for axis in range(3):
            second = first | (4 >> axis)  # the upper end of the edge along the axis; first itself if it is that end
            if second == first or (values[first] > 0.0) == (values[second] > 0.0):
                continue
            fraction = values[first] / (values[first] - values[second])
            ends = [tuple(planes[k][corner[k]] for k in range(3)) for corner in (corners[first], corners[second])]
            total = add(total, add(scale(ends[0], 1.0 - fraction), scale(ends[1], fraction)))
            count += 1
    return scale(total, 1.0 / count)


def find_surface(field, planes):
    """Return (points, quads) of a field that is negative inside. planes: ascending grid coordinates of each axis; the surface
    must be inside the outermost ones."""
    counts = [len(plane) for plane in planes]
    samples = {}
    for i, x in enumerate(planes[0]):
        for j, y in enumerate(planes[1]):
            for k, z in enumerate(planes[2]):
                samples[i, j, k] = field((x, y, z))
    points, indices = [], {}
    for cell in samples:
        if all(cell[axis] + 1 < counts[axis] for axis in range(3)):
            point = find_cell_point(samples, planes, cell)
            if point is not None:
                indices[cell] = len(points)
                points.append(point)
    quads = []
    for corner, value in samples.items():
        for axis in range(3):
            end = tuple(corner[k] + (k == axis) for k in range(3))
            if end not in samples or (value > 0.0) == (samples[end] > 0.0):
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            around = []
            for du, dv in ((1, 1), (0, 1), (0, 0), (1, 0)):
                cell = list(corner)
                cell[u] -= du
                cell[v] -= dv
                around.append(indices[tuple(cell)])
            quads.append(around if value <= 0.0 else around[::-1])
    return points, quads


def relax_points(field, points, quads, round_count):
    """Distribute the points evenly along the surface, and move them to it."""
    neighbors = [set() for _point in points]
    for quad in quads:
        for a, b in zip(quad, quad[1:] + quad[:1]):
            neighbors[a].add(b)
            neighbors[b].add(a)
    rings = [sorted(ring) for ring in neighbors]
    points = [move_to_surface(field, point) for point in points]
    for _round in range(round_count):
        moved = []
        for point, ring in zip(points, rings):
            mean = (0.0, 0.0, 0.0)
            for index in ring:
                mean = add(mean, scale(points[index], 1.0 / len(ring)))
            step = scale(subtract(mean, point), 0.5)
            normal = normalize(compute_gradient(field, point))
            moved.append(move_to_surface(field, add(point, subtract(step, scale(normal, dot(step, normal)))), step_count=1))
        points = moved
    return [move_to_surface(field, point) for point in points]


def split_quads(points, quads):
    """Return triangles: each quad is split along its shorter diagonal."""
    triangles = []
    for a, b, c, d in quads:
        ac, bd = subtract(points[a], points[c]), subtract(points[b], points[d])
        if dot(ac, ac) <= dot(bd, bd):
            triangles += [(a, b, c), (a, c, d)]
        else:
            triangles += [(a, b, d), (b, c, d)]
    return triangles
