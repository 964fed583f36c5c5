#!/usr/bin/env python3
"""Frames of the wall: the files of --out, one for each frame, in order, none written twice.

wall_frames.py --build build/release [--cases windows,front] [--list]
"""

import json
import os
import shlex
import struct
import sys
import tempfile

from harness import cases

FRAMES = 3
WIDTH, HEIGHT = 252, 190


def saved(context, *commands):
    """Runs shell commands in one session. Returns an error or None, and the PNG files in the order of their names:
    (width, height, bytes)."""
    with tempfile.TemporaryDirectory(prefix="mural-wall-frames.") as folder:
        report_file, out = os.path.join(folder, "report.json"), os.path.join(folder, "out")
        more = ["--tiles", "2x1", "--display", "none", "--out", out, "--report", report_file]
        with context.run(["sh", "-ec", "; ".join(commands)], more) as run:
            wrong = cases.check_end(run, 0)
            if wrong is not None:
                return wrong, []
        with open(report_file, encoding="utf-8") as file:
            report = json.load(file)
        files = []
        for name in sorted(os.listdir(out)):
            with open(os.path.join(out, name), "rb") as file:
                data = file.read()
            files.append(struct.unpack(">II", data[16:24]) + (data,))
    if report["savedPictures"] != len(files) or report["frames"] != len(files):
        wrong = "%d frames, %d saved, %d files" % (report["frames"], report["savedPictures"], len(files))
    return wrong, files


def drawing(context, program, settings=""):
    return "%s %s --frames %d --size %dx%d" % (settings, shlex.quote(context.program(program)), FRAMES, WIDTH, HEIGHT)


SMALL, LARGE = (WIDTH // 2, HEIGHT // 2), (WIDTH, HEIGHT)


@cases.case
def windows_change(context):
    """A splash screen, the main window, and the remaining window after the main window's end. Then the X server destroys
    the large window, for a request that names another window or none."""
    ways = ("parent", "subwindows", "kill", "close")
    wrong, files = saved(context, drawing(context, "window_switch"), *(drawing(context, "windows_end", "WINDOWS_END=" + way) for way in ways))
    if wrong is not None:
        return wrong
    sizes = [file[:2] for file in files]
    wanted = [SMALL] * FRAMES + ([LARGE] * FRAMES + [SMALL] * FRAMES) * (1 + len(ways))
    return None if sizes == wanted else "pictures of the sizes %s" % sizes


@cases.case
def drawables_of_one_window(context):
    """Two connections, each with its own drawable: all their swaps are in the window, and on the wall."""
    wrong, files = saved(context, drawing(context, "windows_end", "WINDOWS_END=shared"))
    if wrong is not None:
        return wrong
    return None if [file[:2] for file in files] == [LARGE] * (2 * FRAMES) else "%d pictures" % len(files)


@cases.case
def front_buffer_is_shown(context):
    """Each swap, and each glFlush after front-buffer drawing, is a new picture."""
    wrong, files = saved(context, drawing(context, "front_buffer"))
    if wrong is not None:
        return wrong
    if len(files) != 3 * FRAMES:
        return "%d pictures instead of %d" % (len(files), 3 * FRAMES)
    same = [i for i in range(1, len(files)) if files[i][2] == files[i - 1][2]]
    return "pictures %s are as those before" % same if same else None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
