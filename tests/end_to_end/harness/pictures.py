"""Pictures of frames: reads PPM and PNG, compares pixel by pixel, writes differences."""

import math
import operator
import struct
import zlib


class Picture:
    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    magic, size, depth, pixels = data.split(b"\n", 3)
    width, height = (int(word) for word in size.split())
    if magic != b"P6" or depth != b"255" or len(pixels) != width * height * 3:
        raise ValueError("%s is not a whole picture" % path)
    step = width * 3
    return Picture(width, height, [pixels[y * step:(y + 1) * step] for y in range(height)])


def read_png(path):
    """Reads a PNG of 8 bits per channel, RGB, as --out writes it."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("%s is no PNG file" % path)
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    if (depth, colour) != (8, 2):
        raise ValueError("%s is not RGB of 8 bits" % path)
    raw, step, rows = zlib.decompress(packed), 3 * width, []
    above = bytes(step)
    for y in range(height):
        start = y * (step + 1)
        above = _unfiltered(raw[start], raw[start + 1:start + 1 + step], above)
        rows.append(above)
    return Picture(width, height, rows)


def _sums(first, second):
    """Returns sums of bytes modulo 256, a whole row with one addition. The highest bits are added separately, so no
    carry leaves a byte."""
    size = len(first)
    low = int.from_bytes(b"\x7f" * size, "little")
    a, b = int.from_bytes(first, "little"), int.from_bytes(second, "little")
    return ((a & low) + (b & low) ^ ((a ^ b) & ~low)).to_bytes(size, "little")


def _means(first, second):
    """Returns means of bytes, halves rounded up, a whole row at once: the mean is a | b minus half of the differing
    bits."""
    size = len(first)
    low = int.from_bytes(b"\x7f" * size, "little")
    a, b = int.from_bytes(first, "little"), int.from_bytes(second, "little")
    return ((a | b) - ((a ^ b) >> 1 & low)).to_bytes(size, "little")


def halved(row, width):
    """Returns a row of half the width: the means of two neighbours; a pixel without a neighbour is unchanged."""
    out = bytearray(3 * width)
    for k in range(3):
        channel = row[k:6 * width:3]
        first, second = channel[0::2], channel[1::2]
        out[k::3] = _means(first, second + first[len(second):])
    return bytes(out)


def _unfiltered(kind, row, above):
    if kind == 0:
        return bytes(row)
    if kind == 2:  # format of --out
        return _sums(row, above)
    out = bytearray(row)
    for i in range(len(out)):
        left, corner = (out[i - 3], above[i - 3]) if i >= 3 else (0, 0)
        if kind == 1:
            by = left
        elif kind == 3:
            by = (left + above[i]) // 2
        else:
            by = min((abs(above[i] - corner), 0, left), (abs(left - corner), 1, above[i]),
                     (abs(left + above[i] - 2 * corner), 2, corner))[2]
        out[i] = (out[i] + by) & 255
    return bytes(out)


def _squares(first, second):
    apart = list(map(operator.sub, first, second))
    return sum(map(operator.mul, apart, apart))


def decibels(first, second):
    """Returns the peak signal-to-noise ratio of two pictures of one size."""
    squares = sum(_squares(x, y) for x, y in zip(first.rows, second.rows) if x != y)
    if squares == 0:
        return math.inf
    return 10 * math.log10(255 ** 2 * first.width * first.height * 3 / squares)


class Difference:
    """Counts over any number of pictures; the position is the largest difference's."""

    def __init__(self):
        self.pixels = 0
        self.largest = 0
        self.place = ""

    def add_pictures(self, first, second, name):
        if (first.width, first.height) != (second.width, second.height):
            self.pixels += max(first.width * first.height, second.width * second.height)
            self.largest = 255
            self.place = "%s is %dx%d instead of %dx%d" % (
                name, second.width, second.height, first.width, first.height)
            return
        for y in range(first.height):
            if first.rows[y] != second.rows[y]:
                self._add_row(first.rows[y], second.rows[y], name, y)

    def _add_row(self, first, second, name, y):
        """Compares a whole row at once: a completely different picture has tens of thousands of pixels."""
        self.pixels += sum(map(operator.ne, _pixels(first), _pixels(second)))
        apart = list(map(abs, map(operator.sub, first, second)))
        largest = max(apart)
        if largest > self.largest:
            self.largest = largest
            x = apart.index(largest) // 3
            self.place = "%s at (%d, %d from the top): %s instead of %s" % (
                name, x, y, tuple(second[x * 3:x * 3 + 3]), tuple(first[x * 3:x * 3 + 3]))


def _pixels(row):
    return zip(row[0::3], row[1::3], row[2::3])


def write_difference(path, first, second):
    """Writes white where the two pictures differ, a dimmed copy of the first elsewhere."""
    with open(path, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (first.width, first.height))
        for a, b in zip(first.rows, second.rows):
            row = bytearray(value // 3 for value in a)
            for x in range(0, min(len(a), len(b)), 3):
                if a[x:x + 3] != b[x:x + 3]:
                    row[x:x + 3] = b"\xff\xff\xff"
            file.write(row)
