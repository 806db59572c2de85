#!/usr/bin/env python3
"""Measures edge_count on cards of small shapes (shape_cards.py), whose coarse outlines must keep the area of each shape.

    measure_shape_cards.py [--seed N] [--count N] [--samples N] [--fixed]

--fixed: one row for each kind of shape and radius, with a sun. Otherwise --count cards with random kind, radius, spacing, image
size, light and light size, drawn from --seed. Exits with 1 if a row has a penumbra bias above 0.002, a penumbra MAE above 0.007, or
a receiver that is off by more than 0.2.
"""

import argparse
import json
import math
import random
import sys
import tempfile

from driver import format_row, run_gnomon
from shape_cards import KINDS, make_shape_card

MAX_BIAS, MAX_MAE = 0.002, 0.007
FIXED_RADII = (1.0, 2.0, 3.0, 4.0, 5.0, 5.5, 6.0, 6.5, 7.0)


def list_fixed():
    for kind in KINDS:
        for radius in FIXED_RADII:
            if radius * (math.sqrt(2.0) if kind == "diamond" else 1.0) < 7.5:
                yield {"kind": kind, "radius": radius}, "Sun", "light_angular_distance=11.42", "160x160"


def list_random(seed, count):
    generator = random.Random(seed)
    for index in range(count):
        kind = generator.choice(KINDS)
        spacing = generator.choice((8, 12, 16, 24, 32, 48))
        widest = 0.5 * spacing - 0.75
        card = {
            "kind": kind,
            "spacing": spacing,
            "radius": round(generator.uniform(0.3, 1.0) * widest * (0.7 if kind in ("diamond", "mixed") else 1.0), 2),
            "size_px": (generator.choice((128, 192, 256)), generator.choice((128, 256, 512))),
            "seed": seed + index,
        }
        light = generator.choice(("Sun", "Spot", "Omni"))
        tangent = generator.choice((0.01, 0.03, 0.1, 0.3))
        setting = "light_size=%.2f" % (12 * tangent)
        if light == "Sun":
            setting = "light_angular_distance=%.3f" % math.degrees(2 * math.atan(tangent))
        yield card, light, setting, generator.choice(("160x160", "320x320", "400x240"))


def measure(card, light, setting, size, samples, folder):
    """Return the result of `gnomon compare` for a card."""
    path = make_shape_card(folder, **card)
    common = ("visibility", path, "--light", light, "--size", size, "--set", setting)
    masks = [folder + "/reference.exr", folder + "/mask.exr"]
    run_gnomon(*common, "--technique", "reference", "--set", "reference_samples=%d" % samples, "--out", masks[0])
    run_gnomon(*common, "--technique", "edge_count", "--out", masks[1])
    return json.loads(run_gnomon("compare", *masks))


def main():
    parser = argparse.ArgumentParser(description="Measures edge_count on cards of small shapes.")
    parser.add_argument("--seed", type=int, default=1, help="of the random cards; default: %(default)s")
    parser.add_argument("--count", type=int, default=20, help="number of random cards; default: %(default)s")
    parser.add_argument("--samples", type=int, default=9216, help="of the reference, per receiver; default: %(default)s")
    parser.add_argument("--fixed", action="store_true", help="one row for each kind of shape and radius")
    options = parser.parse_args()
    failed_count = 0
    print(format_row("card", "light", "size", "penumbra MAE", "bias", "wrong", "penumbra pixels"))
    for card, light, setting, size in list_fixed() if options.fixed else list_random(options.seed, options.count):
        with tempfile.TemporaryDirectory() as folder:
            error = measure(card, light, setting, size, options.samples, folder)
        penumbra, wrong = error["penumbra"], round(error["receiver"]["wrong"] * error["pixels"])
        is_bad = abs(penumbra["bias"]) > MAX_BIAS or penumbra["mae"] > MAX_MAE or wrong > 0
        failed_count += is_bad
        text = ", ".join("%s %s" % (name, value) for name, value in card.items())
        cells = ("%.4f" % penumbra["mae"], "%+.4f" % penumbra["bias"], wrong, penumbra["pixels"])
        print(format_row(text, "%s, %s" % (light, setting), size, *cells) + (" above the limits" if is_bad else ""), flush=True)
    print("%d rows above the limits" % failed_count)
    return 1 if failed_count else 0


if __name__ == "__main__":
    sys.exit(main())
