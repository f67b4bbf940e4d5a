"""Pictures that the program wrote, as plain bytes: without a library for pictures."""
import struct
import zlib


def read_png(path):
    """Size and bytes, 4 a pixel, of a PNG as the program writes it: 8-bit RGBA, not interlaced."""
    data = path.read_bytes()
    width, height, *kind = struct.unpack(">IIBBBBB", data[16:33 - 4])
    assert kind == [8, 6, 0, 0, 0], f"{path} is no 8-bit RGBA"
    packed, at = b"", 8
    while at < len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride = zlib.decompress(packed), 4 * width
    rows, above = [], bytearray(stride)
    for y in range(height):
        line = raw[y * (stride + 1):(y + 1) * (stride + 1)]
        row = bytearray(line[1:])
        for x in range(stride):
            left = row[x - 4] if x >= 4 else 0
            corner = above[x - 4] if x >= 4 else 0
            row[x] = (row[x] + predicted(line[0], left, above[x], corner)) & 255
        rows.append(row)
        above = row
    return (width, height), b"".join(rows)


def predicted(kind, left, above, corner):
    if kind < 4:
        return (0, left, above, (left + above) // 2)[kind]
    guess = left + above - corner
    return min((left, above, corner), key=lambda value: abs(guess - value))
