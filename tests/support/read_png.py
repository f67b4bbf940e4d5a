"""Pictures as the program writes them, without a library."""
import struct
import zlib


def read_png(path):
    """Size and bytes, 4 a pixel, of a PNG as the program writes it: 8-bit RGBA, not interlaced, no filters."""
    data = path.read_bytes()
    width, height, *kind = struct.unpack(">IIBBBBB", data[16:33 - 4])
    assert kind == [8, 6, 0, 0, 0], f"{path} is no 8-bit RGBA"
    packed, at = b"", 8
    while at < len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride = zlib.decompress(packed), 4 * width + 1
    assert not any(raw[::stride]), f"{path} has filters"
    return (width, height), b"".join(raw[y * stride + 1:(y + 1) * stride] for y in range(height))


NOTABLE = 24  # levels of 255 by which a channel must be off for a pixel to count as different
MOST_DIFFERENT = 0.02  # share of pixels, in two pictures that count as alike
MOST_MEAN = 1.5  # levels, over all channels


def difference(pixels, others):
    """Of two pictures of one size: the share of pixels that differ, and the mean difference in levels over all channels."""
    off = [abs(a - b) for a, b in zip(pixels, others)]
    count = len(off) // 4
    return sum(max(off[4 * i:4 * i + 4]) > NOTABLE for i in range(count)) / count, sum(off) / len(off)
