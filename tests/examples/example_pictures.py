#!/usr/bin/env python3
"""The example programs on made-up data: every division of the work shows the picture of one node, nodes hold only the
data that they draw, and wrong command lines are reported.

  example_pictures.py --build build/release [--cases mesh] [--list]
"""

import math
import os
import re
import struct
import subprocess
import sys
import tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, pictures  # noqa: E402

FRAMES = 4
SIZE = "320x240"
# Decompositions that show exactly the pixels of one node.
SORT_FIRST = ["--tiles 2x2", "--tile-queue 64x64 --local-nodes 3", "--dplex 2"]
SORT_LAST = ["--db 2", "--db 3", "--tiles 2x1 --db 2", "--db 2 --chunk-queue 8"]


def torus(path):
    """A mesh of 27 000 triangles: a bumpy torus, and two sheets in one plane that are divided differently. The first frame
    sees the sheets from the front, so they have equal depths, and the order of triangles decides."""
    vertices, faces = [], []

    def grid(rows, columns, place, colour, wraps):
        first = len(vertices)
        for row in range(rows):
            for column in range(columns):
                vertices.append(struct.pack("<3f3B", *place(row / rows, column / columns), *colour(row / rows, column / columns)))
        for row in range(rows if wraps else rows - 1):
            for column in range(columns if wraps else columns - 1):
                corners = [first + r % rows * columns + c % columns for r, c in
                           ((row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1))]
                faces.append(struct.pack("<B4i", 4, *corners))

    def bumpy(u, v):
        a, b = 2 * math.pi * u, 2 * math.pi * v
        radius = .35 + .05 * math.sin(9 * a) * math.cos(5 * b)
        return (1 + radius * math.cos(b)) * math.cos(a), (1 + radius * math.cos(b)) * math.sin(a), radius * math.sin(b)

    grid(150, 60, bumpy, lambda u, v: (int(255 * u), int(255 * v), 128), True)
    grid(60, 50, lambda u, v: (3 * u - 1.5, 3 * v - 1.5, 0), lambda u, v: (255, int(255 * u), 0), False)
    grid(35, 45, lambda u, v: (2.8 * v - 1.4, 2.8 * u - 1.4, 0), lambda u, v: (0, int(255 * u), 255), False)
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
              "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face %d\n"
              "property list uchar int vertex_indices\nend_header\n" % (len(vertices), len(faces)))
    with open(path, "wb") as file:
        file.write(header.encode() + b"".join(vertices) + b"".join(faces))


def cloud(path, size=(40, 64, 48)):
    """A volume of waves inside of a ball."""
    voxels = bytearray()
    for z in range(size[2]):
        for y in range(size[1]):
            for x in range(size[0]):
                place = [2 * p / s - 1 for p, s in zip((x, y, z), size)]
                inside = max(0, 1 - sum(p * p for p in place))
                voxels.append(int(255 * inside * (.6 + .4 * math.sin(7 * place[0] + 9 * place[1]) * math.cos(8 * place[2]))))
    with open(path, "wb") as file:
        file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nencoding: raw\n\n" % size + bytes(voxels))


def draw(context, options, words, wanted=0):
    """Returns (error or None, pictures, lines of standard error)."""
    with tempfile.TemporaryDirectory(prefix="mural-examples.") as folder:
        out = os.path.join(folder, "out")
        command = [os.path.join(context.build, "bin", words[0])] + words[1:]
        path = os.path.dirname(context.mural) + ":" + os.environ.get("PATH", "/usr/bin:/bin")
        more = options.split() + ["--display", "none", "--size", SIZE, "--out", out]
        with context.run(command, more, {"PATH": path}) as run:
            wrong = cases.check_end(run, wanted)
            names = sorted(os.listdir(out)) if os.path.isdir(out) else []
            shown = [pictures.read_png(os.path.join(out, name)) for name in names]
            return wrong, shown, list(run.standard_error)


def differing(wanted, shown):
    if len(wanted) != len(shown):
        return "%d pictures instead of %d" % (len(shown), len(wanted))
    difference = pictures.Difference()
    for number, (a, b) in enumerate(zip(wanted, shown), 1):
        difference.add_pictures(a, b, "frame %d" % number)
    return None if difference.pixels == 0 else "%d pixels differ, %s" % (difference.pixels, difference.place)


def exact(context, words, decompositions):
    """Compares all decompositions with one node. Returns an error or None."""
    wrong, wanted, lines = draw(context, "--tiles 1x1", words)
    if wrong or len(wanted) != FRAMES:
        return "one node: %s, %d pictures; %s" % (wrong, len(wanted), " | ".join(lines[-3:]))
    if len({tuple(bytes(row) for row in picture.rows) for picture in wanted}) != FRAMES:
        return "frames of one node repeat"
    for options in decompositions:
        wrong, shown, lines = draw(context, options, words)
        wrong = wrong or differing(wanted, shown)
        if wrong:
            return "%s: %s; %s" % (options, wrong, " | ".join(lines[-3:]))
    return None


def turning(program, file, *more):
    return [program, "--frames", str(FRAMES), "--turn-per-frame", "25"] + list(more) + [file]


@cases.case
def mesh_is_exact(context):
    with tempfile.TemporaryDirectory(prefix="mural-examples.") as folder:
        path = os.path.join(folder, "torus.ply")
        torus(path)
        return exact(context, turning("ply", path, "--colour", "ffffff"), SORT_FIRST + SORT_LAST)


@cases.case
def nodes_hold_their_quarter(context):
    with tempfile.TemporaryDirectory(prefix="mural-examples.") as folder:
        path = os.path.join(folder, "torus.ply")
        torus(path)
        wrong, _, lines = draw(context, "--db 4", turning("ply", path, "--report"))
        held = [re.search(r"holds (\d+) of (\d+) leaves", line) for line in lines]
        counts = [(int(found.group(1)), int(found.group(2))) for found in held if found]
        if wrong or len(counts) != 4 or sum(count for count, _ in counts) != counts[0][1]:
            return "%s; the four nodes hold %s leaves" % (wrong, counts)
        return None if max(count for count, _ in counts) <= .3 * counts[0][1] else "a node holds too much: %s" % counts


@cases.case
def volume_is_exact(context):
    with tempfile.TemporaryDirectory(prefix="mural-examples.") as folder:
        path = os.path.join(folder, "cloud.nrrd")
        cloud(path)
        return exact(context, turning("volume", path), SORT_FIRST)


@cases.case
def slabs_blend(context):
    """Slabs of half floats differ from the whole volume by the last rounding only, from all sides."""
    with tempfile.TemporaryDirectory(prefix="mural-examples.") as folder:
        path = os.path.join(folder, "cloud.nrrd")
        cloud(path)
        words = ["volume", "--frames", "8", "--turn-per-frame", "45", path]
        wrong, wanted, lines = draw(context, "--tiles 1x1", words)
        for options in ("--db 2", "--db 4"):
            if not wrong:
                wrong, shown, lines = draw(context, options, words)
            if wrong or len(shown) != len(wanted):
                return "%s: %s; %s" % (options, wrong, " | ".join(lines[-3:]))
            difference = pictures.Difference()
            for number, (a, b) in enumerate(zip(wanted, shown), 1):
                difference.add_pictures(a, b, "frame %d" % number)
            quality = min(pictures.decibels(a, b) for a, b in zip(wanted, shown))
            print("%s: largest difference %d, %.1f dB" % (options, difference.largest, quality))
            if difference.largest > 1 or quality < 54:
                return "%s: largest difference %d, %s, %.1f dB" % (options, difference.largest, difference.place, quality)
        return None


@cases.case
def help_starts_no_session(context):
    """Without `mural` in PATH no session could start."""
    for name in ("ply", "volume"):
        for words, status, text in ((["--help"], 0, "mural run"), (["--fast", "a"], 1, "there is no option --fast")):
            done = subprocess.run([os.path.join(context.build, "bin", name)] + words, env={"PATH": "/nonexistent"},
                                  capture_output=True, text=True, timeout=60, check=False)
            if done.returncode != status or text not in done.stdout + done.stderr:
                return "%s %s: status %d, %s" % (name, words, done.returncode, done.stdout + done.stderr)
    return None


@cases.case
def errors_have_one_line(context):
    for words, wanted in ((["ply", "/nonexistent.ply"], "/nonexistent.ply: cannot be opened: No such file or directory"),
                          (["ply"], "one file is needed; --help shows examples"),
                          (["ply", "--fast", "a.ply"], "there is no option --fast; --help lists the options"),
                          (["volume", "--window", "3", "a.nii"], "--window needs two increasing numbers such as -200,1500, not \"3\""),
                          (["volume", __file__], "%s: is no NIfTI-1, NRRD or INR file; voxels without a header need their size" % __file__)):
        wrong, _, lines = draw(context, "--tiles 1x1", words, wanted=1)
        if wrong or not any(line.endswith(wanted) for line in lines):
            return "%s: %s; %s" % (" ".join(words), wrong, " | ".join(lines))
    return None


sys.exit(cases.main(__doc__))
