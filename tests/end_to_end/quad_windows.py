#!/usr/bin/env python3
"""Windows of the wall with a buffer for each eye. No driver here has such windows: a library replaces it
(stereo_double.c), and records the contents of both buffers at each swap.

  quad_windows.py --build build/release [--cases both,tiles] [--list]
"""

import os
import sys
import tempfile

from harness import cases
import passes
from harness import pictures

cases.CASES.clear()  # keeps only the cases of this file
EYES = ["--eye-base", str(2 * passes.EYE), "--focus", str(passes.FOCUS)]
DRAW = ["--draw", "fixed"]
# Both eyes in one window; the sizes are the pictures' sizes.
FILE = """#Equalizer 1.2 ascii
server { config {
    appNode { pipe { window { viewport [ 0 0 %d %d ] attributes { hint_stereo ON } channel { name "screen" } } } }
    layout { view { mode STEREO } }
    canvas { layout 0 wall { bottom_left [ -.5 -.5 -1 ] bottom_right [ .5 -.5 -1 ] top_left [ -.5 .5 -1 ] } segment { channel "screen" } }
    compound { channel ( segment 0 view 0 ) } } }
""" % passes.SIZE


def shown_in_quad(context, options, size=passes.SIZE, double=True, frames=passes.FRAMES):
    """Returns the contents of the windows' buffers, [(left, right), …] of each window, the pictures of --out, and the
    messages."""
    with tempfile.TemporaryDirectory(prefix="mural-quad.") as folder:
        out, buffers = os.path.join(folder, "out"), os.path.join(folder, "buffers")
        os.mkdir(buffers)
        library = os.path.join(os.path.abspath(context.build), "tests", "end_to_end", "stereo_double.so")
        environment = {"LD_AUDIT": library, "STEREO_OUT": buffers} if double else None
        command = [context.program("pass_scene"), "--frames", str(frames), "--size", "%dx%d" % size] + DRAW
        with context.run(command, ["--display", "windows", "--out", out] + options, environment) as run:
            wrong = cases.check_end(run, 0)
            output = list(run.standard_error)
        if wrong:
            raise AssertionError(wrong)
        windows = []
        for name in sorted(os.listdir(buffers)):
            there = sorted(os.listdir(os.path.join(buffers, name)))
            read = lambda path, folder=os.path.join(buffers, name): pictures.read_ppm(os.path.join(folder, path))
            windows.append([(read(left), read(left.replace(".left.", ".right."))) for left in there if ".left." in left])
        return windows, [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))], output


def frames_of(buffers):
    """Returns the frames without black ones before the first, and without repeated ones: a window that was covered is
    drawn again."""
    shown = []
    for pair in buffers:
        if any(any(row) for picture in pair for row in picture.rows) and (not shown or not all(a.rows == b.rows for a, b in zip(shown[-1], pair))):
            shown.append(pair)
    return shown


def wrong_eyes(wanted, buffers):
    """Returns None, or the window's buffers that differ from the eyes' pictures."""
    shown = frames_of(buffers)
    return passes.first_wrong({name: passes.differing(eye, [pair[i] for pair in shown]) for i, (name, eye) in enumerate(zip(("left", "right"), wanted))})


def native_eyes(context):
    return [passes.native(context, "pass_scene", DRAW + ["--eye", "%g,%g" % (eye, passes.FOCUS)]) for eye in (-passes.EYE, passes.EYE)]


def cut(picture, x, width):
    return pictures.Picture(width, picture.height, [row[3 * x:3 * (x + width)] for row in picture.rows])


@passes.case
def both_eyes_are_whole(context, notes):
    """Both buffers equal native drawing with each eye's frustum; saved pictures have the eyes side by side."""
    eyes = native_eyes(context)
    windows, saved, output = shown_in_quad(context, ["--stereo", "quad"] + EYES)
    if len(windows) != 1:
        return "%d windows instead of 1" % len(windows)
    if any("side by side" in line for line in output):
        return "it reported missing windows: %s" % output
    if wrong_eyes(eyes[::-1], windows[0]) is None:
        return "eyes that are swapped are not found"
    return wrong_eyes(eyes, windows[0]) or passes.differing([passes.side_by_side(a, b) for a, b in zip(*eyes)], saved)


@passes.case
def each_tile_has_both(context, notes):
    eyes = native_eyes(context)
    windows, _, _ = shown_in_quad(context, ["--stereo", "quad", "--tiles", "2x1", "--local-nodes", "4"] + EYES)
    if len(windows) != 2:
        return "%d windows instead of 2" % len(windows)
    half = passes.SIZE[0] // 2
    parts = [[[cut(p, x, w) for p in eye] for eye in eyes] for x, w in ((0, half), (half, passes.SIZE[0] - half))]
    return passes.first_wrong({"window %d" % i: min((wrong_eyes(part, windows[i]) for part in parts), key=lambda wrong: wrong is not None) for i in range(2)})


@passes.case
def files_open_them(context, notes):
    with tempfile.TemporaryDirectory(prefix="mural-quad.") as folder:
        path = os.path.join(folder, "quad.eqc")
        with open(path, "w", encoding="ascii") as file:
            file.write(FILE)
        windows, _, output = shown_in_quad(context, ["--config", path, "--projection", "program"] + EYES)
    if len(windows) != 1:
        return "%d windows instead of 1: %s" % (len(windows), output)
    return wrong_eyes(native_eyes(context), windows[0])


@passes.case
def without_such_windows_they_lie_side_by_side(context, notes):
    """Without such windows the eyes are side by side, and one line gives the reason."""
    eyes = native_eyes(context)
    windows, saved, output = shown_in_quad(context, ["--stereo", "quad"] + EYES, double=False)
    lines = [line for line in output if "side by side" in line]
    if windows or len(lines) != 1 or "no window with a buffer for each eye can be opened" not in lines[0]:
        return "%d windows, output: %s" % (len(windows), output)
    return passes.differing([passes.side_by_side(a, b) for a, b in zip(*eyes)], saved)


@passes.case
def elsewhere_than_in_windows_of_the_wall_too(context, notes):
    with context.run([context.program("pass_scene"), "--frames", "3", "--size", "%dx%d" % passes.SIZE] + DRAW, ["--display", "app", "--stereo", "quad"] + EYES) as run:
        wrong = cases.check_end(run, 0)
        lines = [line for line in run.standard_error if "side by side" in line]
    if wrong:
        return wrong
    return None if len(lines) == 1 and "--display windows" in lines[0] else "output: %s" % lines


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
