"""The walk of the figure of figure_shapes.py in a circle: the rotation of each joint at a phase of the walk.

A foot is planted next to where the root is at the middle of the foot's stance. Inverse kinematics let the legs reach the
feet, so that no foot slides. Positions are relative to the centre of the circle on the ground, +Y up. Phases are in cycles of
two steps. Phase 0 is the middle of the left foot's stance.
"""

import math

from figure_shapes import build_skeleton
from gltf_writer import (
    add,
    cross,
    dot,
    invert_quaternion,
    multiply_quaternions,
    normalize,
    quaternion_about,
    quaternion_from_axes,
    rotate,
    scale,
    subtract,
)

RADIUS_M = 0.8
CYCLE_S = 1.2
CYCLE_COUNT = 5  # cycles for one round of the circle
LOOP_S = CYCLE_S * CYCLE_COUNT
START_RAD = math.radians(-30.0)  # heading at time 0, from +Z

STANCE = 0.6  # fraction of a cycle in which a foot is on the ground
FOOT_SIDE_M = 0.062  # distance of a foot from the path
FOOT_BEHIND_M = 0.03  # how far a foot is behind the root in the middle of its stance
TOE_OUT_RAD = math.radians(6.0)
LIFT_M = 0.045  # extra height of a swinging foot, in addition to the height from its pitch
# (phase since the middle of the stance, angle by which the toes are up). A foot pivots on its heel if they are up, else on
# its toes.
TOES_UP_DEG = ((-0.3, 16.0), (-0.21, 0.0), (0.06, 0.0), (0.3, -34.0), (0.38, -38.0), (0.6, 10.0), (0.7, 16.0))
HEEL, TOES = (0.0, -0.074, -0.052), (0.006, -0.074, 0.152)  # pivots on the sole of the left foot, relative to the ankle

HIPS_DROP_M, HIPS_BOB_M, HIPS_SWAY_M = 0.033, 0.015, 0.016
HIPS_YAW_RAD, HIPS_ROLL_RAD, HIPS_TILT_RAD = math.radians(6.0), math.radians(3.0), math.radians(2.0)
CHEST_YAW_RAD, LEAN_RAD, LOOK_RAD = math.radians(7.0), math.radians(3.0), math.radians(12.0)
ARM_SWING_RAD, ARM_IN_RAD = math.radians(24.0), math.radians(13.0)
MAX_LEG_FRACTION = 0.999  # of a straight leg's length, where the direction of the knee would be undefined

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
SIDES = {"L": (1.0, 0.0), "R": (-1.0, 0.5)}  # (sign of x, phase of the middle of the stance)
SKELETON = build_skeleton()


def get_rest_offset(joint):
    """Return the joint's offset from its parent at rest."""
    parent, position = SKELETON[joint]
    return position if parent is None else subtract(position, SKELETON[parent][1])


def compose_rotations(*axes_and_angles):
    """Compose the rotations; the one about the first axis is applied last."""
    result = (0.0, 0.0, 0.0, 1.0)
    for axis, angle in axes_and_angles:
        result = multiply_quaternions(result, quaternion_about(axis, angle))
    return result


def interpolate_smoothly(knots, at):
    """Return the value at a parameter of a monotone cubic through the knots, (parameter, value) (Fritsch and Butland 1984)."""
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(knots, knots[1:])]
    tangents = [2.0 * a * b / (a + b) if a * b > 0.0 else 0.0 for a, b in zip(slopes, slopes[1:])]
    tangents = [0.0, *tangents, 0.0]
    index = max(i for i in range(len(knots) - 1) if i == 0 or knots[i][0] <= at)
    (x0, y0), (x1, y1) = knots[index], knots[index + 1]
    t = (at - x0) / (x1 - x0)
    width = x1 - x0
    return (
        (1.0 + 2.0 * t) * (1.0 - t) ** 2 * y0 + t * t * (3.0 - 2.0 * t) * y1
        + width * (t * (1.0 - t) ** 2 * tangents[index] - t * t * (1.0 - t) * tangents[index + 1])
    )  # fmt: skip


def get_heading(phase):
    return START_RAD + 2.0 * math.pi * phase / CYCLE_COUNT


def get_root(phase):
    """Return (translation, rotation) of the root."""
    rotation = quaternion_about(Y, get_heading(phase))
    return rotate(rotation, (-RADIUS_M, 0.0, 0.0)), rotation


def get_hips(phase):
    """Return (translation, its derivative by the phase) of the hips relative to the root."""
    angle_rad = 2.0 * math.pi * phase
    rest = get_rest_offset("Hips")
    offset = (HIPS_SWAY_M * math.cos(angle_rad), HIPS_BOB_M * math.cos(2.0 * angle_rad) - HIPS_DROP_M, 0.0)
    rate = (-HIPS_SWAY_M * math.sin(angle_rad), -2.0 * HIPS_BOB_M * math.sin(2.0 * angle_rad), 0.0)
    return add(rest, offset), scale(rate, 2.0 * math.pi)


def get_plant(side, step):
    """Return (position on the ground, heading) of a foot in its stance of cycle number step; a fractional step interpolates
    along the path."""
    sign, offset = SIDES[side]
    translation, rotation = get_root(step + offset)
    position = add(translation, rotate(rotation, (sign * FOOT_SIDE_M, 0.0, -FOOT_BEHIND_M)))
    return position, get_heading(step + offset) + sign * TOE_OUT_RAD


def get_foot(side, phase):
    """Return (position of the ankle, heading, pitch in radians: above 0 the toes are raised, below 0 the heel)."""
    sign, offset = SIDES[side]
    step = math.floor(phase - offset + 0.5 * STANCE)
    since = phase - offset - step
    eased, lift = 0.0, 0.0
    if since > 0.5 * STANCE:
        swing_fraction = (since - 0.5 * STANCE) / (1.0 - STANCE)
        eased = swing_fraction * swing_fraction * (3.0 - 2.0 * swing_fraction)
        lift = LIFT_M * math.sin(math.pi * swing_fraction) ** 2
    # A swinging foot follows the curved path. On a straight line the outer foot would hit the inner one.
    position, heading = get_plant(side, step + eased)
    pitch = math.radians(interpolate_smoothly(TOES_UP_DEG, since))
    pivot = HEEL if pitch > 0.0 else TOES
    pivot = (sign * pivot[0], pivot[1], pivot[2])
    ankle = (0.0, SKELETON["Foot L"][1][1], 0.0)
    # The foot rotates about the pivot, which does not move in a stance.
    flat = add(add(position, rotate(quaternion_about(Y, heading), pivot)), ankle)
    ankle = subtract(flat, rotate(compose_rotations((Y, heading), (X, -pitch)), pivot))
    return add(ankle, (0.0, lift, 0.0)), heading, pitch


def find_bone_rotation(rest, direction, hinge):
    """Return the rotation that takes a bone from its rest direction to direction, and its hinge axis from +X to hinge. Both axes
    are first made perpendicular to the bone."""
    rest, direction = normalize(rest), normalize(direction)
    side = normalize(subtract(X, scale(rest, dot(X, rest))))
    hinge = normalize(subtract(hinge, scale(direction, dot(hinge, direction))))
    back = invert_quaternion(quaternion_from_axes(side, rest, cross(side, rest)))
    return multiply_quaternions(quaternion_from_axes(hinge, direction, cross(hinge, direction)), back)


def find_leg(hip, ankle, thigh, shin, forward):
    """Return (rotation of the thigh, rotation of the shin) for a leg from hip to ankle whose knee points forward.

    thigh, shin: the vectors from hip to knee and from knee to ankle at rest.
    """
    upper, lower = math.sqrt(dot(thigh, thigh)), math.sqrt(dot(shin, shin))
    reach = subtract(ankle, hip)
    length = min(math.sqrt(dot(reach, reach)), MAX_LEG_FRACTION * (upper + lower))
    down = normalize(reach)
    hinge = normalize(cross(forward, down))
    ahead = cross(down, hinge)
    along = (upper * upper - lower * lower + length * length) / (2.0 * length)
    knee = add(scale(down, along), scale(ahead, math.sqrt(upper * upper - along * along)))
    return find_bone_rotation(thigh, knee, hinge), find_bone_rotation(shin, subtract(scale(down, length), knee), hinge)


def pose_legs(rotations, phase):
    """Rotate the legs by inverse kinematics; needs the rotation of the hips."""
    root, heading = get_root(phase)
    hips = add(root, rotate(heading, get_hips(phase)[0]))
    hips_rotation = multiply_quaternions(heading, rotations["Hips"])
    for side in SIDES:
        upper, lower, foot = ("%s %s" % (name, side) for name in ("Upper leg", "Lower leg", "Foot"))
        ankle, foot_heading, pitch = get_foot(side, phase)
        hip = add(hips, rotate(hips_rotation, get_rest_offset(upper)))
        knee_heading = 0.5 * (get_heading(phase) + foot_heading)
        forward = (math.sin(knee_heading), 0.0, math.cos(knee_heading))
        thigh, shin = find_leg(hip, ankle, get_rest_offset(lower), get_rest_offset(foot), forward)
        rotations[upper] = multiply_quaternions(invert_quaternion(hips_rotation), thigh)
        rotations[lower] = multiply_quaternions(invert_quaternion(thigh), shin)
        rotations[foot] = multiply_quaternions(invert_quaternion(shin), compose_rotations((Y, foot_heading), (X, -pitch)))


def pose_trunk(rotations, phase):
    """Rotate the trunk: the chest turns against the hips and leans into the circle, the head looks along the path."""
    sine, cosine = math.sin(2.0 * math.pi * phase), math.cos(2.0 * math.pi * phase)
    yaw, roll = HIPS_YAW_RAD * sine, HIPS_ROLL_RAD * cosine
    against = -yaw - CHEST_YAW_RAD * sine
    rotations["Hips"] = compose_rotations((Y, yaw), (Z, roll), (X, HIPS_TILT_RAD))
    rotations["Spine"] = compose_rotations((Y, 0.5 * against), (Z, -0.7 * roll - 0.5 * LEAN_RAD), (X, 0.5 * HIPS_TILT_RAD))
    rotations["Chest"] = compose_rotations((Y, 0.5 * against), (Z, -0.5 * roll - 0.5 * LEAN_RAD))
    look = 0.5 * (LOOK_RAD + CHEST_YAW_RAD * sine)
    rotations["Neck"] = compose_rotations((Y, look), (Z, 0.5 * LEAN_RAD), (X, -0.5 * HIPS_TILT_RAD))
    rotations["Head"] = compose_rotations((Y, look), (Z, 0.2 * roll + 0.5 * LEAN_RAD), (X, -HIPS_TILT_RAD))


def pose_arms(rotations, phase):
    """Rotate the arms: each swings with the other side's leg; elbows bend more in front."""
    for side, (sign, _offset) in SIDES.items():
        back = -sign * math.sin(2.0 * math.pi * phase)  # 1: farthest back
        rotations["Shoulder %s" % side] = compose_rotations((Y, sign * math.radians(4.0) * back))
        rotations["Upper arm %s" % side] = compose_rotations((X, ARM_SWING_RAD * back + math.radians(3.0)), (Z, -sign * ARM_IN_RAD))
        rotations["Forearm %s" % side] = compose_rotations((X, math.radians(-20.0 + 13.0 * back)))
        rotations["Hand %s" % side] = compose_rotations((X, math.radians(-8.0)), (Z, -sign * math.radians(4.0)))


def build_rotations(phase):
    """Return joint -> rotation for all joints except the root."""
    rotations = {}
    pose_trunk(rotations, phase)
    pose_arms(rotations, phase)
    pose_legs(rotations, phase)
    return rotations
