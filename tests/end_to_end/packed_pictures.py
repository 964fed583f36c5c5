#!/usr/bin/env python3
"""Pictures that nodes encode for the head, and parts that they encode for each other. Lossless codecs show every pixel
as without Mural, lossy ones are close to it. Configuration files select codecs, too.

  packed_pictures.py --build build/release [--cases lossless,lossy] [--list]
"""

import os
import sys
import tempfile

from harness import cases, length, pictures, wall_pictures

PROGRAMS = ("immediate", "fixed_lighting", "copied_scene", "es2_scene")
TILES, HALVES = ["--tiles", "2x2"], ["--tiles", "2x1"]
MIN_DB = 20  # half the colour resolution, at edges of triangles


def exact(context, options, names):
    """Compares the pictures of programs, which one session draws."""
    drawn = wall_pictures.through_all(context, options, wall_pictures.of_programs(names))
    return wall_pictures.first_wrong({"%s, %s" % (name, " ".join(options)): wall_pictures.differing(wall_pictures.native(context, name), got) for name, got in zip(names, drawn)})


@wall_pictures.case
def lossless_codecs_show_every_pixel(context, notes):
    wrong = exact(context, TILES + ["--codec", "bitplane"], PROGRAMS)
    # Programs differ in the pixels; one program is enough for the ways of each codec.
    for codec in ("bitplane-zstd", "lz4", "zstd", "rle64"):
        wrong = wrong or exact(context, HALVES + ["--codec", codec], ["copied_scene"])
    return wrong


@wall_pictures.case
def lossless_codecs_between_nodes_too(context, notes):
    wrong = None
    for codec in ("raw", "zstd", "bitplane"):
        wrong = wrong or exact(context, ["--db", "3", "--composition", "direct-send", "--codec", codec], ["fixed_lighting"])
    return wrong


def nearness(plain, got):
    if len(plain) != len(got):
        raise AssertionError("%d pictures instead of %d" % (len(got), len(plain)))
    return min(pictures.decibels(a, b) for a, b in zip(plain, got))


@wall_pictures.case
def however_they_leave_gl(context, notes):
    """Pictures read at once, or through buffers for which another thread waits, with all decompositions.
    (end_to_end.exact_readback has other kinds of windows.)"""
    ways = (TILES + ["--codec", "bitplane"], ["--dplex", "2"], ["--db", "2"], ["--tile-queue", "32x32", "--local-nodes", "2"])
    wrong = None
    for readback in ("buffer", "direct"):
        wrong = wrong or exact(context, ways[0] + ["--readback", readback], ["immediate", "core_arrays", "es3_scene"])
    for options, readback in length.pairs(ways[1:], ("buffer", "direct")):
        wrong = wrong or exact(context, options + ["--readback", readback], ["core_arrays"])
    return wrong


@wall_pictures.case
def lossy_codecs_are_near(context, notes):
    wrong, plain = None, wall_pictures.native(context, "fixed_lighting")
    for options in (["--codec", "jpeg-95"], ["--codec", "jpeg-40"], ["--codec", "yuv420"], ["--codec", "jpeg-90", "--db", "2"]):
        got = nearness(plain, wall_pictures.through(context, (HALVES if "--db" not in options else []) + options, "fixed_lighting"))
        notes.append("%s: %.1f dB" % (" ".join(options[1:]), got))
        if not MIN_DB <= got < 90:
            wrong = wrong or "%s: %.1f dB" % (" ".join(options), got)
    return wrong


FILE = """#Equalizer 1.2 ascii
server { config {
    appNode { pipe { window { viewport [ 0 0 %(w)d %(h)d ] channel { name "screen" } } } }
    node { pipe { window { viewport [ 0 0 %(w)d %(h)d ] channel { name "other" } } } }
    compound { channel "screen"
        compound { viewport [ 0 0 .5 1 ] }
        compound { channel "other" viewport [ .5 0 .5 1 ] outputframe { %(frame)s } }
        inputframe { name "frame.other" %(taken)s } } } }
"""


def by_file(context, frame, taken="", more=()):
    with tempfile.TemporaryDirectory(prefix="mural-codec.") as folder:
        path = os.path.join(folder, "codec.eqc")
        with open(path, "w", encoding="ascii") as file:
            file.write(FILE % {"w": wall_pictures.SIZE[0], "h": wall_pictures.SIZE[1], "frame": frame, "taken": taken})
        command = [context.program("fixed_lighting"), "--frames", "3", "--size", "%dx%d" % wall_pictures.SIZE]
        with context.run(command, ["--display", "none", "--config", path, "--projection", "program", "--explain", "--out", folder] + list(more)) as run:
            status = run.status()
            output = "\n".join(run.standard_error)
        names = sorted(name for name in os.listdir(folder) if name.endswith(".png"))
        return status, output, [pictures.read_png(os.path.join(folder, name)) for name in names]


@wall_pictures.case
def files_select_codecs(context, notes):
    plain = wall_pictures.native(context, "fixed_lighting", frames=3)
    for frame, taken, more, line in (("mural_codec \"zstd\"", "", (), "encoded with zstd,"), ("", "mural_codec \"lz4\"", (), "encoded with lz4,"),
                                     ("mural_codec \"zstd\"", "", ("--codec", "bitplane"), "encoded with bitplane,")):
        status, output, got = by_file(context, frame, taken, more)
        wrong = wall_pictures.differing(plain, got)
        if status != 0 or wrong or line not in output:
            return "%s %s %s: status %s, %s: %s" % (frame, taken, more, status, wrong, output)
    status, output, got = by_file(context, "mural_codec \"jpeg-80\" mural_exact OFF")
    if status != 0 or "lossy" not in output or wall_pictures.differing(plain, got) is None or nearness(plain, got) < MIN_DB:
        return "jpeg-80 by a file: status %s: %s" % (status, output)
    for frame, line in (("mural_codec \"jpeg-80\"", "is lossy; set mural_exact OFF"), ("mural_codec \"none_such\"", "unknown codec \"none_such\"")):
        status, output, _ = by_file(context, frame)
        if status != 2 or line not in output:
            return "%s: status %s: %s" % (frame, status, output)
    return None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
