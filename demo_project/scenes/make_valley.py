#!/usr/bin/env python3
"""Writes a valley of 2 km: terrain, a wood, rocks and a village, under three suns, with a walk through it. Not a demo scene.

    make_valley.py [--out DIR] [--seed N] [--small]

The terrain is a sheet of 1.04 million triangles in 16 x 16 pieces, as games divide it. 15,000 trees and rocks of four shapes
each stand on it, and a village of 300 houses, each of 12 kinds whose parts pierce each other: walls, roof, chimney, dormers,
porch. With --small the terrain has 65,000 triangles, and there are 20,000 trees, rocks and houses.

Light "Low" is a sun of 0.53 degrees, 10 degrees above the horizon; "High" the same at 45 degrees; "Overcast" has 10 degrees
and is 60 degrees high. The animation "walk" leads the camera through the valley at eye height: 600 frames at 30 a second.
Equal parameters write equal files.
"""

import argparse
import math
import os
import random

from gltf_animation import Channel, add_animation, make_signs_continuous
from gltf_writer import Document, Mesh, add, quaternion_about, quaternion_look_at, save_files, scale
from shapes import make_box, make_icosphere

EXTENT_M = 2000.0
PIECES = 16  # of the terrain, per side
CELLS, SMALL_CELLS = 45, 11  # of a piece, per side
PLANTS, SMALL_PLANTS = 15000, 19700  # trees and rocks
HOUSES = 300
KINDS = 4  # of trees, and of rocks
HOUSE_KINDS = 12
VILLAGE_RADIUS_M = 160.0
VILLAGE_Z_M = -60.0
ROAD_M = 4.0  # half the width of the way that stays free
EYE_M = 1.7
FRAMES, FRAMES_PER_S = 600, 30
WALK_M = 260.0  # length of the walk
# Name, angle in degrees, elevation and azimuth in degrees, intensity.
SUNS = (("Low", 0.53, 10.0, 60.0, 3.0), ("High", 0.53, 45.0, 35.0, 4.0), ("Overcast", 10.0, 60.0, 110.0, 2.0))


class Terrain:
    """Heights of a valley along z, with hills, and flat where the village is."""

    def __init__(self, generator):
        self.waves = []
        for length_m, height_m in ((900.0, 28.0), (330.0, 9.0), (90.0, 2.2), (31.0, 0.5)):
            for _ in range(3):
                angle = generator.uniform(0.0, 2.0 * math.pi)
                number = 2.0 * math.pi / length_m * generator.uniform(0.8, 1.25)
                phase = generator.uniform(0.0, 2.0 * math.pi)
                self.waves.append((number * math.cos(angle), number * math.sin(angle), phase, height_m / 3.0))

    def find_middle(self, z):
        """The x of the valley's lowest line, along which the road leads."""
        return 60.0 * math.sin(z / 210.0) + 15.0 * math.sin(z / 77.0 + 1.0)

    def find_height(self, x, z):
        from_middle = abs(x - self.find_middle(z))
        slope = 150.0 * (from_middle / (0.5 * EXTENT_M)) ** 1.6
        flat = min(from_middle / 120.0, 1.0) ** 2
        return slope + flat * sum(height * math.sin(kx * x + kz * z + phase) for kx, kz, phase, height in self.waves)

    def find_point(self, x, z):
        return (x, self.find_height(x, z), z)

    def make_piece(self, column, row, cell_count):
        """One piece of the sheet, seen from above counterclockwise."""
        mesh = Mesh(is_closed=False)
        size = EXTENT_M / PIECES
        side = cell_count + 1
        for i in range(side):
            for j in range(side):
                x = -0.5 * EXTENT_M + (column + i / cell_count) * size
                z = -0.5 * EXTENT_M + (row + j / cell_count) * size
                step = 1.0
                normal = (
                    self.find_height(x - step, z) - self.find_height(x + step, z),
                    2.0 * step,
                    self.find_height(x, z - step) - self.find_height(x, z + step),
                )
                mesh.add_vertex(self.find_point(x, z), normal)
        for i in range(cell_count):
            for j in range(cell_count):
                a = i * side + j
                mesh.add_quad(a, a + 1, a + side + 1, a + side)
        return mesh


def make_prism(half_x, half_z, height):
    """Return a closed roof: a gable of this height along x, on y = 0, with flat normals."""
    mesh = Mesh()
    low = [(x, 0.0, z) for x in (-half_x, half_x) for z in (-half_z, half_z)]  # -- -+ +- ++
    ridge = [(x, height, 0.0) for x in (-half_x, half_x)]

    def add_face(points, normal):
        first = [mesh.add_vertex(point, normal) for point in points]
        if len(first) == 3:
            mesh.add_triangle(*first)
        else:
            mesh.add_quad(*first)

    add_face((low[0], low[2], low[3], low[1]), (0.0, -1.0, 0.0))
    add_face((low[1], low[3], ridge[1], ridge[0]), (0.0, half_z, height))
    add_face((low[2], low[0], ridge[0], ridge[1]), (0.0, half_z, -height))
    add_face((low[0], low[1], ridge[0]), (-1.0, 0.0, 0.0))
    add_face((low[3], low[2], ridge[1]), (1.0, 0.0, 0.0))
    return mesh


def make_house(generator):
    """Return a house on the origin: closed parts that pierce each other."""
    half_x, half_z = generator.uniform(3.0, 6.0), generator.uniform(2.5, 4.0)
    walls, roof = generator.uniform(2.6, 5.4), generator.uniform(1.5, 3.0)
    house = Mesh()
    house.add_mesh(make_box((half_x, 0.5 * walls + 0.6, half_z)), translation=(0.0, 0.5 * walls - 0.6, 0.0))
    house.add_mesh(make_prism(half_x + 0.4, half_z + 0.4, roof), translation=(0.0, walls - 0.15, 0.0))
    chimney = generator.uniform(-0.7, 0.7) * half_x
    house.add_mesh(make_box((0.3, 0.5 * roof + 0.5, 0.3)), translation=(chimney, walls + 0.5 * roof, 0.4))
    for index in range(generator.randrange(3)):
        x = (-0.45 + 0.9 * index) * half_x
        house.add_mesh(make_box((0.6, 0.7, 0.5 * half_z)), translation=(x, walls + 0.45, 0.5 * half_z))
        turned = quaternion_about((0.0, 1.0, 0.0), 0.5 * math.pi)
        house.add_mesh(make_prism(0.5 * half_z + 0.1, 0.75, 0.5), turned, (x, walls + 1.1, 0.5 * half_z))
    porch = generator.uniform(1.2, 2.4)
    house.add_mesh(make_box((porch, 0.08, 0.9)), translation=(0.2, 2.35, half_z + 0.7))
    for side in (-1.0, 1.0):
        house.add_mesh(make_box((0.07, 1.6, 0.07)), translation=(0.2 + side * (porch - 0.2), 0.9, half_z + 1.4))
    return house


def make_cone(side_count, radius_m, bottom_m, top_m, generator):
    """Return a closed cone about the y axis whose rim is uneven."""
    mesh = Mesh()
    rim = []
    for side in range(side_count):
        angle = 2.0 * math.pi * side / side_count
        own = radius_m * generator.uniform(0.85, 1.15)
        rim.append(mesh.add_vertex((own * math.cos(angle), bottom_m, own * math.sin(angle)), (math.cos(angle), 0.4, math.sin(angle))))
    top = mesh.add_vertex((0.0, top_m, 0.0), (0.0, 1.0, 0.0))
    bottom = mesh.add_vertex((0.0, bottom_m + 0.02, 0.0), (0.0, -1.0, 0.0))
    for side in range(side_count):
        after = (side + 1) % side_count
        mesh.add_triangle(rim[side], top, rim[after])
        mesh.add_triangle(rim[side], rim[after], bottom)
    return mesh


def make_tree(generator):
    """Return a conifer of 1 m on the origin: a trunk, and cones that pierce each other."""
    tree = Mesh()
    tree.add_mesh(make_cone(5, 0.03, -0.05, 0.7, generator))
    layers = generator.randrange(3, 6)
    for layer in range(layers):
        low = 0.18 + 0.62 * layer / layers
        tree.add_mesh(make_cone(9, 0.22 * (1.0 - 0.75 * layer / layers), low, min(low + 0.42, 1.0), generator))
    return tree


def make_rock(generator):
    """Return an uneven rock of about 1 m about the origin."""
    rock = make_icosphere(1, 0.5)
    rock.positions = [scale(position, generator.uniform(0.75, 1.2)) for position in rock.positions]
    rock.set_smooth_normals()
    return rock


def add_plants(generator, document, terrain, materials, count):
    """Add trees and rocks. The nearer to the valley's middle, the fewer there are; the road stays free."""
    meshes = {
        "Tree": [document.add_mesh("Tree %d" % kind, make_tree(generator), materials["Tree"]) for kind in range(KINDS)],
        "Rock": [document.add_mesh("Rock %d" % kind, make_rock(generator), materials["Rock"]) for kind in range(KINDS)],
    }
    for index in range(count):
        while True:
            x, z = (generator.uniform(-0.5, 0.5) * (EXTENT_M - 20.0) for _ in range(2))
            from_middle = abs(x - terrain.find_middle(z))
            is_in_village = math.hypot(from_middle, z - VILLAGE_Z_M) < VILLAGE_RADIUS_M
            if from_middle > ROAD_M and not is_in_village and generator.random() < 0.25 + from_middle / 150.0:
                break
        kind = generator.choices(("Tree", "Rock"), (0.75, 0.25))[0]
        height = generator.uniform(5.0, 16.0) if kind == "Tree" else generator.uniform(0.5, 3.0)
        width = height * generator.uniform(0.8, 1.25)
        rotation = quaternion_about((0.0, 1.0, 0.0), generator.uniform(0.0, 2.0 * math.pi))
        document.add_node(
            "%s %d" % (kind, index), terrain.find_point(x, z), rotation, mesh=generator.choice(meshes[kind]), scale=[width, height, width]
        )


def add_village(generator, document, terrain, materials):
    """Add the houses, in rows along the road, turned towards it."""
    meshes = [document.add_mesh("House %d" % kind, make_house(generator), materials["House"]) for kind in range(HOUSE_KINDS)]
    for index in range(HOUSES):
        row, side = index // 2, 1.0 if index % 2 else -1.0
        z = VILLAGE_Z_M + VILLAGE_RADIUS_M * (2.0 * (row % 30 + generator.uniform(0.2, 0.8)) / 30.0 - 1.0)
        x = terrain.find_middle(z) + side * (14.0 + 18.0 * (row // 30) + generator.uniform(-1.5, 1.5))
        rotation = quaternion_about((0.0, 1.0, 0.0), -0.5 * side * math.pi + generator.uniform(-0.25, 0.25))
        document.add_node("House %d" % index, terrain.find_point(x, z), rotation, mesh=generator.choice(meshes))


def add_walk(document, camera, terrain):
    """Animate the camera: along the road through the village, looking ahead and a little to the sides."""
    times, places, rotations = [], [], []
    for frame in range(FRAMES):
        fraction = frame / (FRAMES - 1)
        z = VILLAGE_Z_M + WALK_M * (0.75 - fraction)
        eye = add(terrain.find_point(terrain.find_middle(z) + 0.8, z), (0.0, EYE_M + 0.03 * math.sin(0.45 * frame), 0.0))
        aside = 9.0 * math.sin(2.0 * math.pi * 2.5 * fraction)
        target = add(terrain.find_point(terrain.find_middle(z - 20.0) + aside, z - 20.0), (0.0, EYE_M - 0.2, 0.0))
        times.append(frame / FRAMES_PER_S)
        places.append(eye)
        rotations.append(quaternion_look_at(eye, target))
    channels = [
        Channel(camera, "translation", tuple(times), places),
        Channel(camera, "rotation", tuple(times), make_signs_continuous(rotations)),
    ]
    add_animation(document, "walk", channels)


def build_valley(seed=1, is_small=False):
    """Return the valley as a Document."""
    generator = random.Random(seed)
    terrain = Terrain(generator)
    document = Document(round(EXTENT_M * math.sqrt(2.0), 3))
    eye = add(terrain.find_point(terrain.find_middle(VILLAGE_Z_M + 0.75 * WALK_M), VILLAGE_Z_M + 0.75 * WALK_M), (0.0, EYE_M, 0.0))
    document.add_camera("Camera", eye, add(eye, (0.0, -0.1, -1.0)), math.radians(55.0))
    camera = len(document.root["nodes"]) - 1
    for name, angle, elevation, azimuth, intensity in SUNS:
        up, around = math.radians(elevation), math.radians(azimuth)
        towards = (math.cos(up) * math.sin(around), math.sin(up), -math.cos(up) * math.cos(around))
        light = {"type": "directional", "color": [1.0, 0.95, 0.9], "intensity": intensity}
        document.add_light(name, light, towards, (0.0, 0.0, 0.0), {"shadow_enabled": True, "light_angular_distance": angle})
    colors = {"Terrain": (0.38, 0.45, 0.27), "Tree": (0.2, 0.35, 0.18), "Rock": (0.5, 0.48, 0.45), "House": (0.7, 0.62, 0.52)}
    materials = {name: document.add_material(name, color) for name, color in colors.items()}
    for column in range(PIECES):
        for row in range(PIECES):
            piece = terrain.make_piece(column, row, SMALL_CELLS if is_small else CELLS)
            document.add_object("Terrain %d %d" % (column, row), piece, materials["Terrain"])
    add_plants(generator, document, terrain, materials, SMALL_PLANTS if is_small else PLANTS)
    add_village(generator, document, terrain, materials)
    add_walk(document, camera, terrain)
    return document


def save_valley(folder, seed=1, is_small=False):
    """Write the valley's files and return the path of the .gltf."""
    stem = "valley_%d%s" % (seed, "_small" if is_small else "")
    save_files(build_valley(seed, is_small).build_files(stem), folder)
    return os.path.join(folder, stem + ".gltf")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default=".", help="folder")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--small", action="store_true")
    options = parser.parse_args()
    print(save_valley(options.out, options.seed, options.small))


if __name__ == "__main__":
    main()
