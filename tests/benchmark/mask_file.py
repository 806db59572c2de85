"""Reads the masks that `gnomon visibility` writes, for measurements that the program does not make itself.

Without a library: Debian has no small one that reads OpenEXR in Python (python3-openimageio: 97 packages, 306 MB).
"""

import array
import struct
import sys
import zlib

ZIP_COMPRESSION = 3  # blocks of 16 lines
LINES_PER_BLOCK = 16
FLOAT = 2  # OpenEXR's pixel type of 32-bit floats


class Mask:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.visibility = array.array("f", bytes(4 * width * height))
        self.receiver = array.array("f", bytes(4 * width * height))

    def find_penumbra(self):
        """Return the indices of receivers that are neither fully lit nor fully hidden (doc/glossary.md)."""
        return [i for i, v in enumerate(self.visibility) if self.receiver[i] >= 0.5 and 0.002 < v < 0.998]


def read_text(data, position):
    end = data.index(b"\0", position)
    return data[position:end].decode(), end + 1


def undo_prediction(packed):
    """Undo OpenEXR's ZIP predictor, which stores each byte as its difference to the previous one plus 128, and even bytes before odd ones."""
    data = bytearray(packed)
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    result = bytearray(len(data))
    result[0::2] = data[:half]
    result[1::2] = data[half:]
    return bytes(result)


def load_mask(path):
    """Load a ZIP-compressed OpenEXR file with the float channels Y and receiver. Raises ValueError for other channels."""
    with open(path, "rb") as file:
        data = file.read()
    position, attributes = 8, {}  # after magic number and version
    while data[position]:
        name, position = read_text(data, position)
        _, position = read_text(data, position)
        size = struct.unpack_from("<i", data, position)[0]
        attributes[name] = data[position + 4 : position + 4 + size]
        position += 4 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    mask = Mask(right - left + 1, bottom - top + 1)
    channels, cursor = [], 0
    while attributes["channels"][cursor]:
        name, cursor = read_text(attributes["channels"], cursor)
        channels.append((name, struct.unpack_from("<i", attributes["channels"], cursor)[0]))
        cursor += 16  # pixel type, linearity, subsampling in x and y
    if channels != [("Y", FLOAT), ("receiver", FLOAT)] or attributes["compression"][0] != ZIP_COMPRESSION:
        raise ValueError("%s is no mask of `gnomon visibility`" % path)
    block_count = -(-mask.height // LINES_PER_BLOCK)
    # A table of the blocks' offsets follows the header's final zero byte.
    for offset in struct.unpack_from("<%dQ" % block_count, data, position + 1):
        first, size = struct.unpack_from("<ii", data, offset)
        line_count = min(LINES_PER_BLOCK, mask.height - (first - top))
        packed, raw_size_bytes = data[offset + 8 : offset + 8 + size], 8 * mask.width * line_count  # two floats per pixel
        block = array.array("f")
        block.frombytes(packed if size == raw_size_bytes else undo_prediction(zlib.decompress(packed)))
        if sys.byteorder != "little":
            block.byteswap()
        for line in range(line_count):
            begin = (first - top + line) * mask.width
            row = 2 * line * mask.width
            mask.visibility[begin : begin + mask.width] = block[row : row + mask.width]
            mask.receiver[begin : begin + mask.width] = block[row + mask.width : row + 2 * mask.width]
    return mask


def compute_mean_error(reference, result, pixels):
    """Return the mean of |result - reference| over these pixel indices."""
    return sum(abs(result.visibility[i] - reference.visibility[i]) for i in pixels) / max(len(pixels), 1)


def halve(mask):
    """Return a mask of half the size. A pixel is the mean of the four that it covers, and a receiver only if all four are."""
    half = Mask(mask.width // 2, mask.height // 2)
    for y in range(half.height):
        for x in range(half.width):
            corner = 2 * y * mask.width + 2 * x
            four = (corner, corner + 1, corner + mask.width, corner + mask.width + 1)
            if all(mask.receiver[i] >= 0.5 for i in four):
                half.receiver[y * half.width + x] = 1.0
                half.visibility[y * half.width + x] = sum(mask.visibility[i] for i in four) / 4.0
    return half
