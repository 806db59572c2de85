"""A human figure: its joints, its body as one closed mesh, and the skinning weights of its vertices.

Space of the figure: metres, +Y up, looking along +Z, its left at +X, its soles in the plane y = 0. At rest its arms hang a
little off its sides. The body is the zero surface of a distance field: round cones that are blended into each other.
"""

import functools
import math

from gltf_writer import Mesh, add, encode_png, rotate
from isosurface import compute_gradient, find_surface, relax_points, split_quads

# Joint -> (parent, position). A joint whose name ends with " L" has a mirrored twin that ends with " R".
LEFT_AND_MIDDLE = {
    "Root": (None, (0.0, 0.0, 0.0)),
    "Hips": ("Root", (0.0, 0.86, 0.0)),
    "Spine": ("Hips", (0.0, 0.96, -0.005)),
    "Chest": ("Spine", (0.0, 1.08, -0.01)),
    "Neck": ("Chest", (0.0, 1.27, -0.02)),
    "Head": ("Neck", (0.0, 1.345, -0.005)),
    "Shoulder L": ("Chest", (0.03, 1.235, -0.01)),
    "Upper arm L": ("Shoulder L", (0.154, 1.222, -0.015)),
    "Forearm L": ("Upper arm L", (0.254, 0.99, -0.025)),
    "Hand L": ("Forearm L", (0.334, 0.785, 0.015)),
    "Upper leg L": ("Hips", (0.082, 0.83, 0.0)),
    "Lower leg L": ("Upper leg L", (0.088, 0.45, 0.008)),
    "Foot L": ("Lower leg L", (0.09, 0.075, -0.02)),
}

# Round cones: joint, both ends, both radii, factors by which it is thinner along x, y and z, and the width of the blend into
# the parts before it. All but the factors are in metres.
PARTS = (
    ("Hips", (0.0, 0.89, -0.005), (0.06, 0.855, -0.008), 0.105, 0.092, (1.0, 1.0, 1.12), 0.0),
    ("Spine", (0.0, 0.93, 0.0), (0.0, 1.07, 0.0), 0.128, 0.132, (1.03, 1.0, 1.32), 0.05),
    ("Chest", (0.0, 1.135, -0.01), (0.05, 1.155, -0.01), 0.118, 0.096, (1.0, 1.0, 1.12), 0.06),
    ("Shoulder L", (0.03, 1.22, -0.02), (0.145, 1.212, -0.015), 0.06, 0.056, (1.0, 1.0, 1.0), 0.05),
    ("Neck", (0.0, 1.25, -0.026), (0.0, 1.36, -0.012), 0.049, 0.045, (1.0, 1.0, 1.0), 0.025),
    ("Head", (0.0, 1.44, -0.008), (0.0, 1.455, -0.006), 0.094, 0.093, (1.08, 0.95, 0.93), 0.015),
    ("Head", (0.0, 1.378, 0.034), (0.0, 1.42, 0.036), 0.048, 0.056, (1.0, 1.0, 1.0), 0.03),
    ("Head", (0.0, 1.435, 0.082), (0.0, 1.415, 0.094), 0.012, 0.018, (1.0, 1.0, 1.0), 0.02),
    ("Upper arm L", (0.154, 1.21, -0.015), (0.254, 0.99, -0.025), 0.053, 0.043, (1.0, 1.0, 1.0), 0.025),
    ("Forearm L", (0.254, 0.99, -0.025), (0.334, 0.785, 0.015), 0.046, 0.031, (1.0, 1.0, 1.0), 0.015),
    ("Hand L", (0.337, 0.772, 0.018), (0.362, 0.668, 0.04), 0.037, 0.034, (1.3, 1.0, 0.82), 0.02),
    ("Hand L", (0.338, 0.755, 0.045), (0.338, 0.705, 0.075), 0.018, 0.014, (1.0, 1.0, 1.0), 0.012),
    ("Upper leg L", (0.086, 0.82, 0.0), (0.088, 0.45, 0.008), 0.09, 0.06, (1.0, 1.0, 1.0), 0.04),
    ("Lower leg L", (0.088, 0.45, 0.008), (0.09, 0.075, -0.02), 0.058, 0.042, (1.0, 1.0, 1.0), 0.02),
    ("Lower leg L", (0.089, 0.36, -0.018), (0.09, 0.26, -0.022), 0.05, 0.046, (1.0, 1.0, 1.0), 0.04),
    ("Foot L", (0.09, 0.045, -0.045), (0.1, 0.028, 0.125), 0.046, 0.04, (1.0, 1.0, 1.0), 0.03),
)
SOLE_ROUNDING_M = 0.01
FALLOFF_M = 0.035  # a joint whose part is farther away than the closest part by this distance has no weight
SIDE_FALLOFF_M = 0.03  # from the middle plane, over which the weights of the other side's limbs fall to 0
WEIGHT_STEPS = 4096  # weights are multiples of 1 / 4096, so that their sum is exactly 1 in float32
RELAX_ROUNDS = 12
SMOOTHING_ROUNDS = 3
IMAGE_HEIGHT_M = 1.6  # height of the texture, which is half as wide
HAIR_SLOPE = 0.72  # by how much the edge of the hair falls per metre towards the back
HAIR, SKIN, SHIRT, BELT, TROUSERS, SHOES = (
    (0.22, 0.13, 0.08), (0.86, 0.63, 0.50), (0.72, 0.20, 0.16), (0.18, 0.13, 0.10), (0.20, 0.28, 0.42), (0.16, 0.12, 0.11),
)  # fmt: skip


def mirror(position):
    return (-position[0], position[1], position[2])


def build_skeleton():
    """Return joint -> (parent, position), parents first."""
    joints = {}
    for side in (1, -1):
        for name, (parent, position) in LEFT_AND_MIDDLE.items():
            if side == 1:
                joints[name] = (parent, position)
            elif name.endswith(" L"):
                twin = parent[:-1] + "R" if parent.endswith(" L") else parent
                joints[name[:-1] + "R"] = (twin, mirror(position))
    return joints


def prepare_part(part):
    """Return a part of PARTS as get_part_distance() needs it."""
    joint, a, b, radius_a, radius_b, stretch, blend = part
    along = tuple(b[axis] - a[axis] for axis in range(3))
    return (joint, a, along, 1.0 / sum(value * value for value in along), radius_a, radius_b - radius_a, stretch, blend)


PREPARED_PARTS = tuple(prepare_part(part) for part in PARTS)


def get_part_distance(part, x, y, z):
    """Return the approximate distance to a part's surface in metres, negative inside."""
    _joint, (ax, ay, az), (bx, by, bz), inverse_square, radius, growth, (sx, sy, sz), _blend = part
    x, y, z = x - ax, y - ay, z - az
    t = (x * bx + y * by + z * bz) * inverse_square
    t = 0.0 if t < 0.0 else 1.0 if t > 1.0 else t
    x, y, z = (x - t * bx) * sx, (y - t * by) * sy, (z - t * bz) * sz
    return math.sqrt(x * x + y * y + z * z) - radius - t * growth


def get_body_distance(point):
    """Return the approximate distance to the body's surface in metres, negative inside."""
    x, y, z = abs(point[0]), point[1], point[2]
    result = 10.0
    for part in PREPARED_PARTS:
        distance = get_part_distance(part, x, y, z)
        blend = part[7]
        overlap = blend - abs(result - distance)
        result = min(result, distance)
        if overlap > 0.0:  # smooth minimum (Quilez), a quadratic polynomial
            result -= overlap * overlap / (4.0 * blend)
    # The feet are cut off at y = 0 by a smooth intersection with the half-space above.
    overlap = SOLE_ROUNDING_M - abs(result + y)
    return max(result, -y) + (overlap * overlap / (4.0 * SOLE_ROUNDING_M) if overlap > 0.0 else 0.0)


def make_planes():
    """Return the planes of the grid: finer across the limbs than along them."""
    half = [0.027 * index for index in range(16)]
    heights = [-0.02, 0.008, 0.034, 0.064, 0.1]
    for last, step in ((0.4, 0.06), (0.5, 0.045), (0.6, 0.06), (0.7, 0.03), (0.92, 0.046), (1.15, 0.054), (1.57, 0.034)):
        while heights[-1] < last:
            heights.append(heights[-1] + step)
    depths = [-0.16 + 0.0275 * index for index in range(14)]
    return [[-x for x in half[:0:-1]] + half, heights, depths]


def find_influences(point):
    """Map each joint whose parts are near a point to its weight; the weights sum to 1."""
    x, y, z = point
    distances = {}
    for part in PREPARED_PARTS:
        name = part[0]
        for side in ("L", "R") if name.endswith(" L") else ("",):
            joint = name[:-1] + side if side else name
            distance = get_part_distance(part, -x if side == "R" else x, y, z)
            distances[joint] = min(distance, distances.get(joint, 10.0))
    closest = min(distances.values())
    weights_by_joint = {}
    for joint, distance in distances.items():
        weight = max(0.0, 1.0 - (distance - closest) / FALLOFF_M) ** 3
        if joint.endswith((" L", " R")):  # limbs do not pull vertices of the other side
            inner = 0.5 + 0.5 * (x if joint.endswith("L") else -x) / SIDE_FALLOFF_M
            inner = min(max(inner, 0.0), 1.0)
            if joint.startswith("Upper leg"):  # between the legs the hips get what the upper leg loses
                weights_by_joint["Hips"] = weights_by_joint.get("Hips", 0.0) + weight * (1.0 - inner)
            weight *= inner
        if weight > 0.0:
            weights_by_joint[joint] = weights_by_joint.get(joint, 0.0) + weight
    return {joint: weight / sum(weights_by_joint.values()) for joint, weight in weights_by_joint.items()}


def smooth_influences(influences, triangles):
    """Average the weights of each vertex with the mean of its neighbours', SMOOTHING_ROUNDS times."""
    neighbors = [set() for _influence in influences]
    for a, b, c in triangles:
        for one, other in ((a, b), (b, c), (c, a)):
            neighbors[one].add(other)
            neighbors[other].add(one)
    for _round in range(SMOOTHING_ROUNDS):
        smoothed = []
        for own, ring in zip(influences, neighbors):
            weights_by_joint = {joint: 0.5 * weight for joint, weight in own.items()}
            for index in sorted(ring):
                for joint, weight in influences[index].items():
                    weights_by_joint[joint] = weights_by_joint.get(joint, 0.0) + 0.5 * weight / len(ring)
            smoothed.append(weights_by_joint)
        influences = smoothed
    return influences


def select_weights(influence, joints):
    """Return (joint indices, weights) of the four joints with the largest weights; the weights sum to 1."""
    found = sorted(((weight, joints.index(joint)) for joint, weight in influence.items()), key=lambda pair: (-pair[0], pair[1]))[:4]
    total = sum(weight for weight, _index in found)
    steps = [math.floor(WEIGHT_STEPS * weight / total + 0.5) for weight, _index in found]
    steps[0] += WEIGHT_STEPS - sum(steps)
    empty = 4 - len(found)
    indices = [index if step else 0 for step, (_weight, index) in zip(steps, found)]
    return indices + [0] * empty, [step / WEIGHT_STEPS for step in steps] + [0.0] * empty


@functools.lru_cache(maxsize=1)
def find_body():
    """Return (points, triangles); it takes seconds, so it is cached per process."""
    points, quads = find_surface(get_body_distance, make_planes())
    points = relax_points(get_body_distance, points, quads, RELAX_ROUNDS)
    return points, split_quads(points, quads)


def get_color(x, height):
    """Return the colour of the clothes, sRGB, at a position on the texture in metres."""
    hand, wrist = LEFT_AND_MIDDLE["Hand L"][1], 0.005
    if abs(x) > 0.2:  # the arms, away from the trunk; a slanted line separates sleeve and skin
        return SKIN if hand[1] - height + 0.35 * (abs(x) - hand[0]) > wrist else SHIRT
    for top, color in ((0.072, SHOES), (0.868, TROUSERS), (0.89, BELT), (1.277, SHIRT), (1.443, SKIN)):
        if height < top:
            return color
    return HAIR


def make_clothes_png(height_px=256):
    """Return the texture of the clothes. It is projected from the front, as front and back look the same."""
    size_m = IMAGE_HEIGHT_M / height_px
    rows = []
    for y in range(height_px):
        row = []
        for x in range(height_px // 2):
            color = get_color((x + 0.5) * size_m - 0.25 * IMAGE_HEIGHT_M, IMAGE_HEIGHT_M - (y + 0.5) * size_m)
            row += [*(round(255 * value) for value in color), 255]
        rows.append(row)
    return encode_png(height_px // 2, height_px, rows)


def get_clothes_uv(point):
    """Return texture coordinates. On the head they are tilted, so that the hair reaches down to the neck at the back."""
    x, y, z = point
    tilt = min(max((y - 1.29) / 0.06, 0.0), 1.0) * HAIR_SLOPE
    return (0.5 + 2.0 * x / IMAGE_HEIGHT_M, 1.0 - (y - tilt * z) / IMAGE_HEIGHT_M)


def make_figure(translation, rotation):
    """Return the body, rotated and moved, with its skinning weights. Joint indices follow the order of build_skeleton()."""
    joints = list(build_skeleton())
    points, triangles = find_body()
    mesh = Mesh()
    influences = smooth_influences([find_influences(point) for point in points], triangles)
    for point, influence in zip(points, influences):
        normal = compute_gradient(get_body_distance, point)
        mesh.add_vertex(add(rotate(rotation, point), translation), rotate(rotation, normal), get_clothes_uv(point))
        indices, weights = select_weights(influence, joints)
        mesh.joints.append(indices)
        mesh.weights.append(weights)
    mesh.triangles = triangles
    return mesh
