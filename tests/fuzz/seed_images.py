"""Small images, as bytes: PNG and JPEG, valid and truncated, and animated PNG, GIF and WebP.

Written without a library, as libraries write no truncated and no damaged images.
"""

import struct
import zlib

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def build_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def build_header(width, height):
    """Return the IHDR chunk of a PNG image with 8-bit red, green, blue and alpha."""
    return build_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))


def pack_rows(width, height, alphas):
    texels = [bytes((200, 40 * (i % 5), 90, alpha)) for i, alpha in enumerate(alphas)]
    return zlib.compress(b"".join(b"\0" + b"".join(texels[y * width :][:width]) for y in range(height)))


def build_png(width, height, alphas, before=b"", after=b""):
    """Build a PNG. before, after: chunks before and after its rows."""
    rows = build_chunk(b"IDAT", pack_rows(width, height, alphas))
    return PNG_SIGNATURE + build_header(width, height) + before + rows + after + build_chunk(b"IEND", b"")


def make_leaf_png():
    """8 x 8 texels, with a round hole whose border has intermediate alphas."""
    alphas = [min(255, max(0, ((x - 3) ** 2 + (y - 4) ** 2 - 4) * 60)) for y in range(8) for x in range(8)]
    return build_png(8, 8, alphas)


def make_animated_png():
    """An animated PNG of two frames. Readers without support for it show the first frame."""
    alphas = [255, 0, 128, 64]
    control = struct.pack(">IIIIHHBB", 2, 2, 0, 0, 1, 10, 0, 0)  # size, offset, delay of 1/10 s, disposal, blending
    before = build_chunk(b"acTL", struct.pack(">II", 2, 0)) + build_chunk(b"fcTL", struct.pack(">I", 0) + control)
    after = build_chunk(b"fcTL", struct.pack(">I", 1) + control)
    after += build_chunk(b"fdAT", struct.pack(">I", 2) + pack_rows(2, 2, alphas[::-1]))
    return build_png(2, 2, alphas, before, after)


def make_huge_png(width=20000, height=20000):
    """A valid header of a huge image, followed by almost no rows."""
    rows = build_chunk(b"IDAT", zlib.compress(bytes(100)))
    return PNG_SIGNATURE + build_header(width, height) + rows + build_chunk(b"IEND", b"")


def make_truncated_png():
    png = make_leaf_png()
    return png[: len(png) * 2 // 3]


def make_jpeg(component_count=3):
    """A baseline JPEG of 8 x 8 texels of one colour. The DC value and the end of each block take one bit each."""

    def build_segment(marker, data):
        return struct.pack(">BBH", 0xFF, marker, len(data) + 2) + data

    components = range(1, component_count + 1)
    frame = struct.pack(">BHHB", 8, 8, 8, component_count) + b"".join(bytes((i, 0x11, 0)) for i in components)
    one_code = bytes([1] + 15 * [0]) + b"\0"  # a Huffman table whose only code, of one bit, is for the value 0
    scan = bytes([component_count]) + b"".join(bytes((i, 0)) for i in components) + bytes((0, 63, 0))
    return (
        b"\xff\xd8"
        + build_segment(0xDB, b"\0" + 64 * b"\1")  # DQT: the quantization table
        + build_segment(0xC0, frame)  # SOF0
        + build_segment(0xC4, b"\x00" + one_code)  # DHT: the Huffman tables of DC and AC
        + build_segment(0xC4, b"\x10" + one_code)
        + build_segment(0xDA, scan)  # SOS
        + bytes([0xFF >> 2 * component_count])  # two zeros per component, padded by ones
        + b"\xff\xd9"
    )


def make_truncated_jpeg():
    """Return a JPEG that ends within its tables."""
    return make_jpeg()[:120]


def make_animated_gif():
    """Two frames of one texel."""
    pixel = b"\x2c" + struct.pack("<HHHHB", 0, 0, 1, 1, 0) + b"\x02\x02\x44\x01\x00"  # offset, size, LZW data
    control = b"\x21\xf9\x04\x04\x0a\x00\x00\x00"  # a delay of 1/10 s
    loop = b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"
    header = b"GIF89a" + struct.pack("<HHBBB", 1, 1, 0x80, 0, 0) + b"\xff\0\0\0\xff\0"
    return header + loop + control + pixel + control + pixel + b"\x3b"


def make_animated_webp():
    """Return the header of an animated WebP, without any frame."""
    # VP8X: its size, the flag of an animation, and a canvas of 8 x 8 as 24-bit numbers, minus 1. ANIM: size, background, loops.
    body = b"WEBPVP8X" + struct.pack("<IIHBHB", 10, 0x02, 7, 0, 7, 0) + b"ANIM" + struct.pack("<IIH", 6, 0, 0)
    return b"RIFF" + struct.pack("<I", len(body)) + body
