"""Pictures of frames: reading PPM, comparing pixel by pixel, writing what differs."""


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


class Difference:
    """Counts over any number of pictures; the place is that of the largest difference."""

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
        for x in range(len(first) // 3):
            a, b = first[x * 3:x * 3 + 3], second[x * 3:x * 3 + 3]
            if a != b:
                self.pixels += 1
                largest = max(abs(a[k] - b[k]) for k in range(3))
                if largest > self.largest:
                    self.largest = largest
                    self.place = "%s at (%d, %d from the top): %s instead of %s" % (
                        name, x, y, tuple(b), tuple(a))


def write_difference(path, first, second):
    """White where the two pictures differ, a dimmed copy of the first elsewhere."""
    with open(path, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (first.width, first.height))
        for a, b in zip(first.rows, second.rows):
            row = bytearray(value // 3 for value in a)
            for x in range(0, min(len(a), len(b)), 3):
                if a[x:x + 3] != b[x:x + 3]:
                    row[x:x + 3] = b"\xff\xff\xff"
            file.write(row)
