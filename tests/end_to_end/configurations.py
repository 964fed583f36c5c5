#!/usr/bin/env python3
"""Runs a real program with configuration files, all nodes on this machine, and checks the picture of the wall.

  configurations.py --build build/release [--files a.eqc,b.eqc] [--shared] [--part 1/2] [--size 320x240]

Without --files: all of configs/. With --shared also the example files next to the tree (or in MURAL_SHARED), if
present.
  - A file without stereo shows exactly the native picture on every part of the wall that it draws: 0 pixels differ.
    Screens at angles are laid flat for that (passes.py tests rooms).
  - A zoomed part must be close to the native picture, and differ from it; with a DFR_equalizer it may be equal.
  - A part that frames reduce in transit, or show elsewhere, must equal the native picture after the same change.
  - A part of the wall that another canvas shows again must equal the wall's picture at that size.
  - A picture with stereo is combined from separate runs of each eye, and compared with that.
"""

import argparse
import glob
import math
import os
import re
import subprocess
import sys
import tempfile

from harness import display, length, pictures, programs

PROGRAM = "fixed_lighting"
FRAMES = 3
ZOOMED_MEAN = 12  # at half the size; a picture that is a few pixels off, or black, differs by more
# for a picture drawn larger, compared with the reduced native picture; a shift by one pixel gives 1 or more
REDUCED_MEAN = 0.1
CANVAS_SIZE = "320x240" # size of the program's picture; canvases are integer fractions or multiples of it
# for a canvas with its own pixels, compared with a native window of its size (0.97); a shift by one pixel gives 13 or
# more, the reduced native picture 4.5
CANVAS_MEAN = 3
# for values rounded four times: pixels and their weights, in 256ths; a part that is one pixel off differs by more
MAX_SCALED_DIFFERENCE = 2
SKIPPED = 77
# Example files of which a short run shows the picture: each kind of decomposition, equalizer, eye and canvas once.
# (tests/head/planning/config_plan_test.cpp plans all of them.)
SHARED_KINDS = ("1-pipe.LG_CF3D", "2-node.DB", "2-node.tile", "2-pipe.stereo.passive", "2-window.DB.lb", "2-window.FBO", "2-window.wall.lb", "3-node.DB.ds",
                "3-window.EYE.anaglyph", "3-window.curved", "4-window.DB.bs", "4-window.DPlex", "7-window.DB.PIXEL", "cave.HMD", "float", "own-coverage")


def read_png(path):
    """Returns (width, height, RGB rows)."""
    picture = pictures.read_png(path)
    return picture.width, picture.height, picture.rows


class Run:
    def __init__(self, arguments, display_name):
        self.arguments, self.display = arguments, display_name
        self.references = {}

    def picture(self, options, times=(1, 1)):
        """Returns the last frame and the messages, for a program with a window of that relative size. Raises
        RuntimeError with the program's messages."""
        a = self.arguments
        size = "x".join(str(math.ceil(int(length) * by - 0.5)) for length, by in zip(a.size.split("x"), times))
        with tempfile.TemporaryDirectory(prefix="mural-configurations.") as folder:
            out = os.path.join(folder, "out")
            command = [os.path.join(a.build, "bin", "mural"), "run", "--size", size, "--display", "none", "--explain",
                       "--out", out, "--save", str(FRAMES), "--frames", str(FRAMES)] + options
            command += ["--", os.path.join(a.build, "tests", "programs", PROGRAM), "--size", size, "--frames", str(FRAMES + 1)]
            done = subprocess.run(command, env=programs.clean_environment(self.display), stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=a.seconds, check=False)
            output = done.stdout.decode(errors="replace")
            files = sorted(glob.glob(os.path.join(out, "*.png")))
            if done.returncode != 0 or not files:
                raise RuntimeError("status %d, %d pictures: %s" % (done.returncode, len(files), output.strip().splitlines()[-1:]))
            self.canvases = {os.path.basename(os.path.dirname(path))[len("canvas."):]: read_png(path) for path in sorted(glob.glob(os.path.join(out, "canvas.*", "*.png")))}
            return read_png(files[-1]), output

    def reference(self, options, times=(1, 1)):
        """Returns the picture of a run with which several files are compared; drawn once."""
        key = tuple(options), times
        if key not in self.references:
            self.references[key] = self.picture(options, times)[0]
        return self.references[key]


def difference(expected, shown, areas):
    """Returns the number of differing pixels inside the areas, and outside all of them."""
    width, height, rows = expected
    if (shown[0], shown[1]) != (width, height):
        return width * height, 0
    covered = [bytearray(width) for _ in range(height)]
    for area in areas:
        x0, x1, y0, y1 = pixels_of(area, width, height)
        x0 = min(max(0, x0), width)
        x1 = max(x0, min(width, x1))
        for row in range(max(0, y0), min(height, y1)):
            covered[row][x0:x1] = bytes([1]) * (x1 - x0)
    wrong = outside = 0
    for y in range(height):
        outside += covered[y].count(0)
        if rows[y] == shown[2][y]:
            continue
        wrong += sum(1 for x in range(width) if covered[y][x] and rows[y][3 * x:3 * x + 3] != shown[2][y][3 * x:3 * x + 3])
    return wrong, outside


def mean_difference(expected, shown, area):
    """Returns the mean difference of the values of an area: 0 to 255."""
    width, height, rows = expected
    x, y, w, h = area
    x0, x1 = int(x * width + 1e-6), int((x + w) * width + 1e-6)
    total = count = 0
    for row in range(max(0, height - int((y + h) * height + 1e-6)), min(height, height - int(y * height + 1e-6))):
        total += sum(abs(a - b) for a, b in zip(rows[row][3 * x0:3 * x1], shown[2][row][3 * x0:3 * x1]))
        count += 3 * (x1 - x0)
    return total / max(count, 1)


def reduced(picture, times):
    """Returns a picture in which each pixel is the mean of a block of columns and rows, as a zoom above 1 shows a
    larger picture."""
    columns, lines = times
    width, height = picture[0] // columns, picture[1] // lines
    rows = []
    for y in range(height):
        sums = [sum(values) for values in zip(*picture[2][y * lines:(y + 1) * lines])]
        row = bytearray()
        for x in range(width):
            row += bytes((2 * sum(sums[3 * (x * columns + i) + k] for i in range(columns)) + columns * lines) // (2 * columns * lines) for k in range(3))
        rows.append(bytes(row))
    return width, height, rows


def pixels_of(area, width, height):
    """Returns x0, x1, and the rows from the top, of a part of the picture."""
    x, y, w, h = area
    return int(x * width + 1e-6), int((x + w) * width + 1e-6), height - int((y + h) * height + 1e-6), height - int(y * height + 1e-6)


def resized(lines, size):
    """Returns rows of values (3 per pixel) at another size: the mean of the covered pixels if smaller, otherwise linear
    between pixel centres."""
    def weights(count, wanted):
        by = count / wanted
        for i in range(wanted):
            if by <= 1:
                at = (i + 0.5) * by - 0.5
                low = int(at // 1)
                yield [(min(max(low, 0), count - 1), 1 - (at - low)), (min(max(low + 1, 0), count - 1), at - low)]
            else:
                begin, end = i * by, (i + 1) * by
                yield [(min(p, count - 1), (min(p + 1, end) - max(p, begin)) / by) for p in range(int(begin), min(int(end) + 1, count))]
    width, height = size
    columns = list(weights(len(lines[0]) // 3, width))
    narrow = [[sum(line[3 * p + c] * w for p, w in column) for column in columns for c in range(3)] for line in lines]
    return [[sum(narrow[p][i] * w for p, w in row) for i in range(3 * width)] for row in weights(len(lines), height)]


def of_frames(output):
    """Returns the parts of the wall that frames reduce in transit, or show elsewhere: area, size in transit, shown
    area."""
    found = []
    for pass_text, area, shown in re.findall(r"node \d+ \(local\) draws for channel (.*?)part \[ ([^]]+) \] of the wall(?:, shown in \[ ([^]]+) \])?", output):
        way = re.search(r"transferred at (\S+) by (\S+) times the size", pass_text)
        if way or shown:
            numbers = lambda text: tuple(float(v) for v in text.split())
            found.append((numbers(area), tuple(float(v) for v in way.groups()) if way else (1, 1), numbers(shown or area)))
    return found


def way_difference(native, shown, area, way, place):
    """Returns the largest difference from the native picture after the frame's reduction and enlargement."""
    width, height, rows = native
    x0, x1, y0, y1 = pixels_of(area, width, height)
    lines = [rows[y][3 * x0:3 * x1] for y in range(y1 - 1, y0 - 1, -1)]  # bottom-up, like the rounded values
    small = (max(1, int((x1 - x0) * way[0] + 0.5)), max(1, int((y1 - y0) * way[1] + 0.5)))
    sent = [[int(v + 0.5) for v in line] for line in resized(lines, small)] if small != (x1 - x0, y1 - y0) else lines
    x0, x1, y0, y1 = pixels_of(place, width, height)
    expected = resized(sent, (x1 - x0, y1 - y0))
    return max(abs(e - s) for line, y in zip(expected, range(y1 - 1, y0 - 1, -1)) for e, s in zip(line, shown[2][y][3 * x0:3 * x1]))


def side_by_side(left, right):
    width, height = left[0], left[1]
    half = (width + 1) // 2
    return width, height, [pictures.halved(l, half) + pictures.halved(r, width - half) for l, r in zip(left[2], right[2])]


def other_canvases(output):
    """Returns for each further canvas its name, its relative size, and the first of its nodes."""
    found = []
    for name, w, h, own_w, own_h in re.findall(r'canvas "?([^" ]+)"? shows the program\'s picture with (\d+)x(\d+) pixels; the first canvas has (\d+)x(\d+)', output):
        after = output[output.index("canvas \"%s\" shows" % name if "canvas \"%s\" shows" % name in output else "canvas %s shows" % name):]
        first = re.search(r"node (\d+) \(local\) draws", after)
        found.append((name, (int(w) / int(own_w), int(h) / int(own_h)), int(first.group(1))))
    return found


def of_other_canvas(line, output):
    node = re.search(r"node (\d+) \(local\) draws", line)
    others = other_canvases(output)
    return bool(node and others and int(node.group(1)) >= min(first for _, _, first in others))


def check_canvases(run, path, canvases, output):
    """Compares the other canvases with native drawing into a window of their size."""
    about = ""
    for name, times, _ in other_canvases(output):
        if name not in canvases:
            return "", "canvas %s shows nothing" % name
    if not other_canvases(output):
        return "", None
    run = Run(argparse.Namespace(**{**vars(run.arguments), "size": CANVAS_SIZE}), run.display)
    run.picture(["--config", path, "--all-local", "--projection", "program"])
    canvases = run.canvases
    for name, times, _ in other_canvases(output):
        shown = canvases[name]
        expected = run.picture([], times)[0]
        if (shown[0], shown[1]) != (expected[0], expected[1]):
            return "", "canvas %s has %dx%d pixels instead of %dx%d" % (name, shown[0], shown[1], expected[0], expected[1])
        if " eye" in output or "of each" in output or "sample" in output:
            about += ", canvas %s has its picture" % name if any(any(row) for row in shown[2]) else ""
            continue
        areas = [tuple(float(v) for v in area) for area in re.findall(r"node \d+ \(local\) draws for channel .*?part \[ (\S+) (\S+) (\S+) (\S+) \]", output[output.index("canvas"):])]
        wrong, _ = difference(expected, shown, areas)
        mean = mean_difference(expected, shown, (0, 0, 1, 1))
        if mean > CANVAS_MEAN:
            return "", "canvas %s differs by %.2f of 255 in the mean from the native picture of its size" % (name, mean)
        about += ", canvas %s: %d of %d pixels differ from the native picture of its size, by %.3f of 255 in the mean" % (name, wrong, expected[0] * expected[1], mean)
    return about, None


def check_copies(wall, canvases, output):
    """Compares the parts of the wall that other canvases show again, with the wall's picture at their size."""
    about = ""
    number = r"\[ (\S+ \S+ \S+ \S+) \]"
    for name, source, target in re.findall(r'canvas "([^"]+)" shows part %s of canvas \S+ in part %s' % (number, number), output):
        if name not in canvases:
            return "", "canvas %s shows nothing" % name
        x0, x1, y0, y1 = pixels_of(tuple(float(v) for v in source.split()), wall[0], wall[1])
        part = [wall[2][y][3 * x0:3 * x1] for y in range(y1 - 1, y0 - 1, -1)]
        width, height, rows = canvases[name]
        x0, x1, y0, y1 = pixels_of(tuple(float(v) for v in target.split()), width, height)
        expected = resized(part, (x1 - x0, y1 - y0))
        maximum = max(abs(e - s) for line, y in zip(expected, range(y1 - 1, y0 - 1, -1)) for e, s in zip(line, rows[y][3 * x0:3 * x1]))
        if maximum > MAX_SCALED_DIFFERENCE:
            return "", "canvas %s differs by %.2f of 255 from the wall's picture at its size" % (name, maximum)
        about += ", canvas %s (%dx%d) differs by at most %.2f of 255 from the wall's picture at its size" % (name, width, height, maximum)
    return about, None


def check(run, path, native):
    """Returns None or an error, and a line about the checks."""
    shown, output = run.picture(["--config", path, "--all-local", "--projection", "program"])
    first_canvases = run.canvases
    about_canvases, wrong = check_canvases(run, path, first_canvases, output)
    about_copies, wrong_copy = check_copies(shown, first_canvases, output)
    if wrong or wrong_copy:
        return wrong or wrong_copy, ""
    about_canvases += about_copies
    output = "\n".join(line for line in output.splitlines() if not of_other_canvas(line, output))
    reported = re.findall(r"node \d+ \(local\) draws for channel (.*?)part \[ (\S+) (\S+) (\S+) (\S+) \]", output)
    sent = of_frames(output)
    nodes = [node[1:] for node in reported if " zoom " not in node[0] and "times the size" not in node[0]]
    nodes = [node for node in nodes if not any(place != area and tuple(float(v) for v in node) == area for area, _, place in sent)]
    scaled = [(tuple(float(v) for v in node[1:]), tuple(float(v) for v in re.search(r" zoom (\S+) ([\d.]+)", node[0]).groups())) for node in reported if " zoom " in node[0]]
    areas = [tuple(float(v) for v in node) for node in nodes]
    zoomed = ""
    if "changes the zoom of node" in output:  # by the rate, so on a busy machine
        mean = mean_difference(native, shown, (0, 0, 1, 1))
        if mean > ZOOMED_MEAN:
            return "with a zoom by the frame rate, the picture differs by %.2f of 255 in the mean" % mean, ""
        return None, "%d nodes, the picture with a zoom by the frame rate differs by %.2f of 255 in the mean" % (len(reported), mean)
    for area, zoom in scaled:
        mean = mean_difference(native, shown, area)
        if not 0 < mean < ZOOMED_MEAN:
            return "zoomed, the part %s differs by %.2f of 255 in the mean" % (area, mean), ""
        zoomed += ", the zoomed part by %.2f of 255 in the mean" % mean
        if not all(z >= 1 and z == int(z) for z in zoom):
            continue
        # A picture drawn larger, compared with a native window of that size, in which each pixel is the mean of its
        # block.
        times = tuple(int(z) for z in zoom)
        mean = mean_difference(reduced(run.reference([], times), times), shown, area)
        if mean > REDUCED_MEAN:
            return "zoomed, the part %s differs by %.3f of 255 in the mean from the native picture drawn larger" % (area, mean), ""
        zoomed += ", by %.3f from one that is drawn larger" % mean
    # Both eyes of an anaglyph see one picture at eye base 0. Side-by-side pairs have parts of half the width, which are
    # not compared.
    one = shown
    if sent and " eye" in output:
        one = run.picture(["--config", path, "--all-local", "--projection", "program", "--eye-base", "0"])[0]
    eyes_as_one = one is shown or difference(native, one, areas)[0] == 0
    for area, way, place in sent if eyes_as_one else []:
        maximum = way_difference(native, one, area, way, place)
        if maximum > MAX_SCALED_DIFFERENCE:
            return "the part %s, sent %g by %g times as large, differs by %.2f of 255 from that of the native picture" % (place, *way, maximum), ""
        zoomed += ", what frames made smaller by at most %.2f of 255 from the native picture made so" % maximum
    if not reported:
        return "no node is listed", ""
    # Antialiased, or every nth pixel, compared with the short form of the options.
    samples, kernel = re.search(r"sample \d+ of (\d+)", output), re.search(r"of each (\d+x\d+)", output)
    options = (["--subpixel", samples.group(1)] if samples else []) + (["--pixel", kernel.group(1)] if kernel else [])
    expected, against = native, "the native picture"
    if options:
        expected, against = run.reference(options), " ".join(options)
        if samples and expected[2] == native[2]:
            return "samples change nothing", ""
    eyes = [word for word in ("left eye", "right eye") if word in output]
    if eyes:
        flat = one if one is not shown else run.picture(["--config", path, "--all-local", "--projection", "program", "--eye-base", "0"])[0]
        # The file's own eye base is sufficient where it moves a pixel.
        apart = shown if shown[2] != flat[2] else run.picture(["--config", path, "--all-local", "--projection", "program", "--eye-base", "0.5"])[0]
        if apart[2] == flat[2]:
            return "the eyes see the same, however far apart", ""
        # With eye base 0 both eyes see the picture of one.
        against += " for both eyes"
        if not (sent and eyes_as_one) and flat[2] != expected[2]:
            expected, areas, shown = side_by_side(expected, expected), [(0, 0, 1, 1)], flat
            if sent:  # in halves of the picture: approximate
                mean = mean_difference(expected, shown, (0, 0, 1, 1))
                about = "%d nodes, pictures that frames make smaller among them: by %.2f of 255 in the mean from %s" % (len(reported), mean, against)
                return (None if mean < ZOOMED_MEAN else about), about
        else:
            shown = flat
    wrong, outside = difference(expected, shown, areas)
    total = native[0] * native[1]
    about = "%d nodes, %d of %d pixels differ from %s, %d outside of all parts%s%s" % (len(reported), wrong, total - outside, against, outside, zoomed, about_canvases)
    return (None if wrong == 0 else about), about


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--files", help="configuration files, separated by commas")
    parser.add_argument("--shared", action="store_true", help="also the example files beside the tree")
    parser.add_argument("--part", default="1/1", metavar="K/N", help="only the Kth of N parts of the files")
    parser.add_argument("--size", default="321x243")
    parser.add_argument("--seconds", type=int, default=60, help="the longest that one run may take")
    a = parser.parse_args()
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    files = a.files.split(",") if a.files else sorted(glob.glob(os.path.join(root, "configs", "*.eqc")))
    if a.shared:
        shared = sorted(glob.glob(os.path.join(os.environ.get("MURAL_SHARED", os.path.join(root, "..", "shared")), "eqc", "*.eqc")))
        if not shared:
            print("no example files; MURAL_SHARED says where shared is")
            return SKIPPED
        chosen = [path for path in shared if length.LONG or os.path.basename(path)[:-len(".eqc")] in SHARED_KINDS]
        files = chosen or shared
    part, parts = (int(number) for number in a.part.split("/"))
    files = files[part - 1::parts]
    failures = 0
    with display.PrivateDisplay() as name:
        run = Run(a, name)
        native = run.reference([])
        for path in files:
            try:
                wrong, about = check(run, path, native)
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                wrong, about = str(error), ""
            failures += wrong is not None
            print("%-28s %s" % (os.path.basename(path), "WRONG: " + wrong if wrong is not None else about), flush=True)
    print("%d files, %d wrong" % (len(files), failures))
    return 1 if failures or not files else 0


if __name__ == "__main__":
    sys.exit(main())
