"""Reads the images and masks that the demo's Godot project stores, and writes them as PNG and OpenEXR.

They are float32, linear, rows from the top. A mask is -1 where there is no receiver. Written without a library: Debian has
no small one that writes OpenEXR in Python, and the demo needs no packages of Python.
"""

import array
import os
import struct
import sys
import zlib

LUMINANCE = (0.2126, 0.7152, 0.0722)


def load_rows(path, row_length):
    """Return (values, number of rows); row_length is the number of floats in a row."""
    values = array.array("f")
    with open(path, "rb") as file:
        values.frombytes(file.read())
    if sys.byteorder != "little":
        values.byteswap()
    if not values or len(values) % row_length:
        raise SystemExit("ERROR: %s has %d values, must be one or more rows of %d." % (path, len(values), row_length))
    return values, len(values) // row_length


def get_luminance(rgb):
    """Return the luminance of each pixel of an RGB image."""
    red, green, blue = LUMINANCE
    return array.array("f", (red * r + green * g + blue * b for r, g, b in zip(rgb[0::3], rgb[1::3], rgb[2::3])))


def _to_srgb(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1.0 / 2.4) - 0.055


_SRGB = bytes(round(255 * _to_srgb(index / 4095)) for index in range(4096))


def save_color_png(path, rgb, width):
    """Save linear values, clamped to 0..1, as 8-bit sRGB."""
    _save_png(path, bytes(_SRGB[round(4095 * min(max(value, 0.0), 1.0))] for value in rgb), width)


def save_gray_png(path, values, width):
    """Save linear values of 0..1 as 8-bit grey. Values below 0 (no receiver) become dark violet."""
    pixels = bytearray()
    for value in values:
        gray = round(255 * min(value, 1.0))
        pixels += bytes((gray, gray, gray)) if value >= 0.0 else b"\x30\x10\x38"
    _save_png(path, bytes(pixels), width)


def _save_png(path, pixels, width):
    """Write an 8-bit RGB PNG. pixels: bytes of red, green and blue, from the top."""
    stride = 3 * width
    rows = b"".join(b"\0" + pixels[first : first + stride] for first in range(0, len(pixels), stride))
    parts = [(b"IHDR", struct.pack(">2I5B", width, len(pixels) // stride, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows, 6))]
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in parts + [(b"IEND", b"")]:
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def _attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def save_exr(path, values, width, height):
    """Save a mask as uncompressed OpenEXR with the float32 channels Y (visibility) and receiver (0 or 1)."""
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    # Pixel type 2: float32; not pLinear; no subsampling.
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"Y", b"receiver")) + b"\0"
    header = struct.pack("<ii", 20000630, 2)  # OpenEXR's magic number, version
    for name, kind, data in (
        ("channels", "chlist", channels),
        ("compression", "compression", b"\0"),
        ("dataWindow", "box2i", box),
        ("displayWindow", "box2i", box),
        ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1.0)),
    ):
        header += _attribute(name, kind, data)
    header += b"\0"
    line_bytes = 8 * width  # two float32 channels
    first = len(header) + 8 * height  # after the table of the lines' offsets, uint64
    with open(path + ".part", "wb") as file:
        file.write(header)
        file.write(struct.pack("<%dQ" % height, *(first + line * (8 + line_bytes) for line in range(height))))
        for line in range(height):
            row = values[line * width : (line + 1) * width]
            file.write(struct.pack("<ii", line, line_bytes))
            file.write(struct.pack("<%df" % width, *(max(value, 0.0) for value in row)))
            file.write(struct.pack("<%df" % width, *(0.0 if value < 0.0 else 1.0 for value in row)))
    os.replace(path + ".part", path)
