"""Adds animated casters to a scene: a figure that walks in a circle, and a flag."""

import figure_walk
import flag_shapes
from figure_shapes import make_clothes_png, make_figure
from gltf_animation import Channel, add_animation, add_skin, make_signs_continuous
from gltf_writer import add, encode_png, invert_quaternion, rotate, scale
from shapes import make_cylinder

LEG_KEYS_PER_CYCLE = 24  # keys per cycle of the walk; between them a flat foot slides by 0.9 mm at most
BODY_KEYS_PER_CYCLE = 12
HIPS_KEYS_PER_CYCLE = 8
FLAG_KEYS_PER_CYCLE = 12
POLE_RADIUS_M = 0.018
FLAG_BELOW_TOP_M = 0.03  # from the top of the pole to the flag's upper edge
CLOTH_COLORS = ((0.93, 0.90, 0.82), (0.12, 0.42, 0.44))


def build_inverse_bind(translation, rotation):
    """Return the inverse bind matrix, column by column. translation and rotation take the joint at rest to world space."""
    back = invert_quaternion(rotation)
    columns = [rotate(back, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    moved = rotate(back, scale(translation, -1.0))
    return [value for column in columns for value in (*column, 0.0)] + [*moved, 1.0]


def round_position(position):
    """Round to nine digits, so that rounding errors do not change the file."""
    return tuple(round(value, 9) + 0.0 for value in position)


def add_figure(document, center, stem):
    """Add the figure at rest, where its walk around the center begins; return joint -> node.

    stem: of the texture's file name.
    """
    root, heading = figure_walk.get_root(0.0)
    root = round_position(root)
    heading = tuple(round(value, 9) for value in heading)
    world = add(center, root)
    clothes = document.add_material("Clothes", (1.0, 1.0, 1.0), roughness=0.8)
    document.set_texture(clothes, document.add_texture(stem + "_clothes.png", make_clothes_png()))
    mesh = document.add_mesh("Figure", make_figure(world, heading), clothes)
    armature = document.add_node("Armature", center)
    nodes, inverse_binds = {}, []
    for joint, (parent, position) in figure_walk.SKELETON.items():
        if parent is None:
            nodes[joint] = document.add_node(joint, root, heading, parent=armature)
        else:
            nodes[joint] = document.add_node(joint, round_position(figure_walk.get_rest_offset(joint)), parent=nodes[parent])
        inverse_binds.append(build_inverse_bind(add(world, rotate(heading, position)), heading))
    skin = add_skin(document, "Figure", nodes.values(), nodes["Root"], inverse_binds)
    # The vertices are in world space and the node has no transform, so that readers without skins draw the figure at rest.
    document.add_node("Figure", mesh=mesh, skin=skin)
    return nodes


def make_cloth_png(size_px=32):
    """Return a checkerboard of two colours, 4 x 2 fields."""
    rows = []
    for y in range(size_px):
        colors = [CLOTH_COLORS[(4 * x // size_px + 2 * y // size_px) % 2] for x in range(size_px)]
        rows.append([round(255 * value) for color in colors for value in (*color, 1.0)])
    return encode_png(size_px, size_px, rows)


def add_flag(document, foot, height_m, stem):
    """Add a pole and a flag at its top; return the flag's node. foot: of the pole. stem: as in add_figure()."""
    x, y, z = foot
    metal = document.add_material("Pole", (0.55, 0.55, 0.57), roughness=0.4)
    document.add_object("Pole", make_cylinder(POLE_RADIUS_M, 0.5 * height_m, 16), metal, (x, y + 0.5 * height_m, z))
    cloth = document.add_material("Cloth", (1.0, 1.0, 1.0), roughness=0.8, is_double_sided=True)
    document.set_texture(cloth, document.add_texture(stem + "_cloth.png", make_cloth_png()))
    position = round_position((x + POLE_RADIUS_M, y + height_m - FLAG_BELOW_TOP_M - 0.5 * flag_shapes.HEIGHT_M, z))
    return document.add_object("Flag", flag_shapes.make_flag(), cloth, position)


def sample(steps_per_cycle, get_value):
    """Return (times in seconds, values) of a loop; get_value takes the phase in cycles. The last value equals the first."""
    count = steps_per_cycle * figure_walk.CYCLE_COUNT
    values = [get_value(index / steps_per_cycle) for index in range(count)]
    return [index * figure_walk.CYCLE_S / steps_per_cycle for index in range(count + 1)], values + values[:1]


def get_hips_key(phase):
    """Return (in-tangent, translation, out-tangent) of the hips, for CUBICSPLINE."""
    translation, rate = figure_walk.get_hips(phase)
    tangent = scale(rate, 1.0 / figure_walk.CYCLE_S)
    return tangent, translation, tangent


def build_walk(nodes):
    """Return the animation channels of the joints."""
    times, roots = sample(LEG_KEYS_PER_CYCLE, figure_walk.get_root)
    channels = [Channel(nodes["Root"], "translation", times, [translation for translation, _rotation in roots])]
    channels.append(Channel(nodes["Root"], "rotation", times, make_signs_continuous([rotation for _translation, rotation in roots])))
    times, keys = sample(HIPS_KEYS_PER_CYCLE, get_hips_key)
    channels.append(Channel(nodes["Hips"], "translation", times, [row for key in keys for row in key], "CUBICSPLINE"))
    legs, body = (sample(steps, figure_walk.build_rotations) for steps in (LEG_KEYS_PER_CYCLE, BODY_KEYS_PER_CYCLE))
    for joint in list(nodes)[1:]:  # without the root
        # The hips have the same times as the legs, whose keys are computed for the rotation of the hips at these times.
        times, poses = legs if joint == "Hips" or " leg " in joint or joint.startswith("Foot") else body
        rotations = [pose[joint] for pose in poses]
        if joint.startswith("Hand"):  # their pose is constant
            channels.append(Channel(nodes[joint], "rotation", (times[0], times[-1]), rotations[:1] * 2, "STEP"))
        else:
            channels.append(Channel(nodes[joint], "rotation", times, make_signs_continuous(rotations)))
    return channels


def add_walk(document, center, pole, pole_height_m, stem):
    """Add the figure, the flag, and one animation of both.

    center: of the figure's circle. pole: the foot of the flag's pole. stem: as in add_figure().
    """
    channels = build_walk(add_figure(document, center, stem))
    flag = add_flag(document, pole, pole_height_m, stem)
    count = round(FLAG_KEYS_PER_CYCLE * figure_walk.LOOP_S / flag_shapes.CYCLE_S)
    times = [index * figure_walk.LOOP_S / count for index in range(count + 1)]
    weights = [flag_shapes.get_weights(time, figure_walk.LOOP_S) for time in times[:-1]]
    channels.append(Channel(flag, "weights", times, weights + weights[:1]))
    add_animation(document, "Walk", channels)
