#!/usr/bin/env python3
"""Makes scenes of a conifer: crossed cards whose alpha cuts hundreds of twigs with thin needles out of them. Each card has about
20,000 silhouette edges, so a few of them have more than a hundred thousand.

    twig_scenes.py [--seed N] [--count N] [--alpha-mode MASK|BLEND] [--out DIR]

--count is the number of cards. The same arguments give the same bytes. Standard library only.
"""

import argparse
import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "demo_project", "scenes"))
from foliage_shapes import add_rotated_card, make_card  # noqa: E402
from gltf_writer import Mesh, encode_png, save_files  # noqa: E402
from make_artist_scenes import make_artist_set  # noqa: E402
from make_scenes import BARK  # noqa: E402
from shapes import make_cylinder  # noqa: E402

STEM = "twigs"
TEXTURE_SIZE = (512, 1024)
TWIG_COUNT = 60
NEEDLES_PER_TWIG = 40
NEEDLE_TEXELS = 22.0  # length
HALF_WIDTH_TEXELS = 1.1
CARD_HALF_SIZE = (0.28, 0.56)
ALPHA_MODES = ("MASK", "BLEND")


class AlphaCanvas:
    """Coverage 0..1 of each texel by the thick line segments drawn so far."""

    def __init__(self, width, height):
        self.width = width
        self.height = height
        self.rows = [[0.0] * width for _y in range(height)]

    def add_line(self, a, b, half_width):
        """Draw a line from a to b, in texels. Its alpha falls from 1 to 0 over one texel, and is 1/2 at half_width."""
        reach = half_width + 1.0
        along = (b[0] - a[0], b[1] - a[1])
        square = max(along[0] ** 2 + along[1] ** 2, 1e-12)
        # The last column and row are transparent, so that nothing is cut off at the card's border.
        for y in range(max(1, math.floor(min(a[1], b[1]) - reach)), min(self.height - 1, math.ceil(max(a[1], b[1]) + reach))):
            row = self.rows[y]
            for x in range(max(1, math.floor(min(a[0], b[0]) - reach)), min(self.width - 1, math.ceil(max(a[0], b[0]) + reach))):
                to = (x + 0.5 - a[0], y + 0.5 - a[1])
                t = min(max((to[0] * along[0] + to[1] * along[1]) / square, 0.0), 1.0)
                distance = math.hypot(to[0] - t * along[0], to[1] - t * along[1])
                row[x] = max(row[x], min(max(0.5 + half_width - distance, 0.0), 1.0))


def make_twigs_png(generator):
    """Return a texture of twigs with needles that branch off a stem."""
    width, height = TEXTURE_SIZE
    canvas = AlphaCanvas(width, height)
    canvas.add_line((0.5 * width, height), (0.5 * width, 0.05 * height), 4.0)
    for twig in range(TWIG_COUNT):
        start = (0.5 * width, height * (0.97 - 0.9 * twig / TWIG_COUNT))
        side = 1.0 if twig % 2 else -1.0
        angle = generator.uniform(0.15, 0.9)
        length = width * generator.uniform(0.3, 0.48)
        direction = (side * math.cos(angle), -math.sin(angle))
        end = (start[0] + length * direction[0], start[1] + length * direction[1])
        canvas.add_line(start, end, 1.6)
        for _needle in range(NEEDLES_PER_TWIG):
            t = generator.uniform(0.05, 1.0)
            base = (start[0] + t * length * direction[0], start[1] + t * length * direction[1])
            turn = generator.choice((-1.0, 1.0)) * generator.uniform(0.4, 1.1)
            c, s = math.cos(turn), math.sin(turn)
            reach = NEEDLE_TEXELS * generator.uniform(0.6, 1.2)
            tip = (base[0] + reach * (c * direction[0] - s * direction[1]), base[1] + reach * (s * direction[0] + c * direction[1]))
            canvas.add_line(base, tip, HALF_WIDTH_TEXELS)
    rows = []
    for coverage in canvas.rows:
        row = []
        for alpha in coverage:
            row += [70, 110, 60, round(255 * alpha)]
        rows.append(row)
    return encode_png(width, height, rows)


def make_cards(generator, count):
    """Return cards about the axis of a tree, which lean outwards and overlap."""
    mesh = Mesh(is_closed=False, is_manifold=False)
    card = make_card(*CARD_HALF_SIZE)
    for index in range(count):
        turn = 2.0 * math.pi * (index / count + generator.uniform(-0.03, 0.03))
        height = generator.uniform(0.5, 1.6)
        radius = 0.45 * (1.9 - height) * generator.uniform(0.3, 1.0)
        center = (radius * math.cos(turn), height, radius * math.sin(turn))
        normal = (math.cos(turn) + generator.gauss(0.0, 0.3), generator.gauss(0.3, 0.3), math.sin(turn) + generator.gauss(0.0, 0.3))
        add_rotated_card(mesh, card, center, normal, generator.uniform(-0.5, 0.5))
    return mesh


def build_scene(seed=1, count=8, alpha_mode="BLEND"):
    """Return the scene as a gltf_writer.Document."""
    generator = random.Random(seed)
    document = make_artist_set(camera_target=(-0.2, 0.8, 0.0))
    bark = document.add_material("Bark", BARK, roughness=0.9)
    document.add_object("Trunk", make_cylinder(0.05, 0.9, 24), bark, (0.0, 0.9, 0.0))
    material = document.add_material("Twigs", (1.0, 1.0, 1.0), roughness=0.7, is_double_sided=True)
    document.set_texture(material, document.add_texture(STEM + ".png", make_twigs_png(generator)), is_cut_out=True)
    document.root["materials"][material]["alphaMode"] = alpha_mode
    document.add_object("Twigs", make_cards(generator, count), material)
    return document


def main():
    parser = argparse.ArgumentParser(description="Makes the scene %s.gltf." % STEM)
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers (default: %(default)s)")
    parser.add_argument("--count", type=int, default=8, help="number of cards (default: %(default)s)")
    parser.add_argument("--alpha-mode", choices=ALPHA_MODES, default="BLEND", help="default: %(default)s")
    parser.add_argument("--out", required=True, help="folder to write to")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    save_files(build_scene(arguments.seed, arguments.count, arguments.alpha_mode).build_files(STEM), arguments.out)


if __name__ == "__main__":
    main()
