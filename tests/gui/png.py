"""Reads the PNG files that the program writes (8-bit RGB or RGBA), with the standard library."""
import struct
import zlib


def _paeth(a, b, c):
    pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
    return a if pa <= pb and pa <= pc else b if pb <= pc else c


def _unfilter(kind, row, above, step):
    if kind == 1:
        for i in range(step, len(row)):
            row[i] = (row[i] + row[i - step]) & 255
    elif kind == 2:
        row[:] = bytes((a + b) & 255 for a, b in zip(row, above))
    elif kind == 3:
        for i in range(len(row)):
            left = row[i - step] if i >= step else 0
            row[i] = (row[i] + (left + above[i]) // 2) & 255
    elif kind == 4:
        for i in range(len(row)):
            left, corner = (row[i - step], above[i - step]) if i >= step else (0, 0)
            row[i] = (row[i] + _paeth(left, above[i], corner)) & 255


def read_png(path):
    """Returns width, height, channels and the rows as bytes."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed, header = 8, b"", None
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at:at + 4]), data[at + 4:at + 8]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + length])
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    width, height, depth, colour = header[:4]
    assert depth == 8 and colour in (2, 6), f"{path}: depth {depth}, colour type {colour}"
    step = 3 if colour == 2 else 4
    raw, size = zlib.decompress(packed), width * step
    rows, above = [], bytearray(size)
    for y in range(height):
        row = bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
        _unfilter(raw[y * (size + 1)], row, above, step)
        rows.append(bytes(row))
        above = row
    return width, height, step, rows


def changed_pixels(a, b, rect, threshold=24):
    """Pixels in rect (left, top, width, height) with a channel off by more than the threshold."""
    (width, height, step, rows_a), (_, _, _, rows_b) = a, b
    left, top = max(0, int(rect[0])), max(0, int(rect[1]))
    right, bottom = min(width, int(rect[0] + rect[2])), min(height, int(rect[1] + rect[3]))
    count = 0
    for y in range(top, bottom):
        one, two = rows_a[y], rows_b[y]
        for x in range(left, right):
            k = x * step
            if any(abs(one[k + c] - two[k + c]) > threshold for c in range(3)):
                count += 1
    return count
