#!/usr/bin/env python3
"""Pictures that nodes encode for the head, and parts that they encode for each other. Lossless codecs show every pixel
as without Mural, lossy ones are close to it. Configuration files select codecs, too.

  packed_pictures.py --build build/release [--cases lossless,lossy] [--list]
"""

import os
import sys
import tempfile

from harness import cases
import passes
from harness import pictures

cases.CASES.clear()  # keeps only the cases of this file
PROGRAMS = ("immediate", "fixed_lighting", "copied_scene", "es2_scene")
TILES = ["--tiles", "2x2"]
MIN_DB = 20  # half the colour resolution, at edges of triangles


@passes.case
def lossless_codecs_show_every_pixel(context, notes):
    wrong = None
    for program in PROGRAMS:
        plain = passes.native(context, program)
        # Programs differ in the pixels; one program is enough for the ways of each codec.
        for codec in ("bitplane", "bitplane-zstd", "lz4", "zstd", "rle64") if program == "copied_scene" else ("bitplane",):
            wrong = wrong or passes.first_wrong({"%s, %s" % (program, codec): passes.differing(plain, passes.through(context, TILES + ["--codec", codec], program))})
    return wrong


@passes.case
def lossless_codecs_between_nodes_too(context, notes):
    plain = passes.native(context, "fixed_lighting")
    return passes.first_wrong({codec: passes.differing(plain, passes.through(context, ["--db", "3", "--composition", "direct-send", "--codec", codec], "fixed_lighting"))
                               for codec in ("raw", "zstd", "bitplane")})


def nearness(plain, got):
    if len(plain) != len(got):
        raise AssertionError("%d pictures instead of %d" % (len(got), len(plain)))
    return min(pictures.decibels(a, b) for a, b in zip(plain, got))


@passes.case
def however_they_leave_gl(context, notes):
    """Pictures read at once, or through buffers for which another thread waits, with all decompositions.
    (end_to_end.exact_readback has other kinds of windows.)"""
    ways = (TILES + ["--codec", "bitplane"], ["--dplex", "2"], ["--db", "2"], ["--tile-queue", "32x32", "--local-nodes", "2"])
    wrong = None
    for program in ("immediate", "core_arrays", "es3_scene"):
        plain = passes.native(context, program)
        for readback in ("buffer", "direct"):
            for options in ways if program == "core_arrays" else ways[:1]:
                wrong = wrong or passes.first_wrong({"%s, %s %s" % (program, readback, " ".join(options)): passes.differing(plain, passes.through(context, options + ["--readback", readback], program))})
    return wrong


@passes.case
def lossy_codecs_are_near(context, notes):
    wrong, plain = None, passes.native(context, "fixed_lighting")
    for options in (["--codec", "jpeg-95"], ["--codec", "jpeg-40"], ["--codec", "yuv420"], ["--codec", "jpeg-90", "--db", "2"]):
        got = nearness(plain, passes.through(context, (TILES if "--db" not in options else []) + options, "fixed_lighting"))
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
            file.write(FILE % {"w": passes.SIZE[0], "h": passes.SIZE[1], "frame": frame, "taken": taken})
        command = [context.program("fixed_lighting"), "--frames", "3", "--size", "%dx%d" % passes.SIZE]
        with context.run(command, ["--display", "none", "--config", path, "--projection", "program", "--explain", "--out", folder] + list(more)) as run:
            status = run.status()
            output = "\n".join(run.standard_error)
        names = sorted(name for name in os.listdir(folder) if name.endswith(".png"))
        return status, output, [pictures.read_png(os.path.join(folder, name)) for name in names]


@passes.case
def files_select_codecs(context, notes):
    plain = passes.native(context, "fixed_lighting", frames=3)
    for frame, taken, more, line in (("mural_codec \"zstd\"", "", (), "encoded with zstd,"), ("", "mural_codec \"lz4\"", (), "encoded with lz4,"),
                                     ("mural_codec \"zstd\"", "", ("--codec", "bitplane"), "encoded with bitplane,")):
        status, output, got = by_file(context, frame, taken, more)
        wrong = passes.differing(plain, got)
        if status != 0 or wrong or line not in output:
            return "%s %s %s: status %s, %s: %s" % (frame, taken, more, status, wrong, output)
    status, output, got = by_file(context, "mural_codec \"jpeg-80\" mural_exact OFF")
    if status != 0 or "lossy" not in output or passes.differing(plain, got) is None or nearness(plain, got) < MIN_DB:
        return "jpeg-80 by a file: status %s: %s" % (status, output)
    for frame, line in (("mural_codec \"jpeg-80\"", "is lossy; set mural_exact OFF"), ("mural_codec \"none_such\"", "unknown codec \"none_such\"")):
        status, output, _ = by_file(context, frame)
        if status != 2 or line not in output:
            return "%s: status %s: %s" % (frame, status, output)
    return None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
