#!/usr/bin/env python3
"""The overlay over the wall's windows: people see it, and no read, file or comparison contains it.

  wall_overlay.py --build build/release [--cases exact,restarted] [--list]
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, length, pictures  # noqa: E402
from harness.control import PATIENCE_SECONDS, ctl, result_of  # noqa: E402
import passes  # noqa: E402

cases.CASES.clear()  # keeps only the cases of this file
MODES = ("names", "grid", "stats")
SIZE = (506, 382)
SECONDS = 1.0  # limit of a change, on an idle machine
GREEN = bytes((0, 255, 0))
WHITE = bytes((255, 255, 255))


def screen(context):
    """Returns the rows of the whole screen."""
    if shutil.which("xwd") is None:
        raise SystemExit("xwd is not installed: apt-get install x11-apps")
    dump = subprocess.run(["xwd", "-silent", "-root"], env=dict(os.environ, DISPLAY=context.display), capture_output=True, check=True).stdout
    return passes.xwd_rows(dump)


def window(context, title):
    rows = passes.window_pixels(context, [title], PATIENCE_SECONDS)
    return rows[0] if rows else None


def seconds_until(condition):
    """Returns the time until the condition is true, or None after the deadline."""
    began = time.monotonic()
    while time.monotonic() < began + PATIENCE_SECONDS:
        if condition():
            return time.monotonic() - began
        time.sleep(0.02)
    return None


def still_screen(context):
    """Returns the screen when it no longer changes."""
    before, deadline = None, time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline:
        now = screen(context)
        if now == before:
            return now
        before = now
        time.sleep(1)
    return None


def change(context, run, *words):
    """Returns an error, or None."""
    result = result_of(context, run, "overlay", *words)
    return result.get("error")


# ---- exactness

def exact(context, modes, options):
    """Compares saved pictures with native ones, and each frame with the program's own GL. modes: the rest only in long runs."""
    draw = ["--draw", "mvp"]
    native = passes.native(context, "pass_scene", draw, SIZE, 8)
    return passes.first_wrong({mode: exact_in(context, mode, options, draw, native) for mode in (MODES if length.LONG else modes)})


def exact_in(context, mode, options, draw, native):
    with tempfile.TemporaryDirectory(prefix="mural-overlay.") as folder:
        report, out = os.path.join(folder, "report.json"), os.path.join(folder, "out")
        command = [context.program("pass_scene"), "--frames", "8", "--size", "%dx%d" % SIZE] + draw
        with context.run(command, options + ["--overlay", mode, "--verify", "--report", report, "--out", out]) as run:
            wrong = cases.check_end(run, 0)
        if wrong:
            return wrong
        with open(report, encoding="utf-8") as file:
            numbers = json.load(file)
        saved = [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))]
    if numbers["verifiedFrames"] != 8 or numbers["differingPixels"] != 0:
        return "%d frames compared, %d pixels differ" % (numbers["verifiedFrames"], numbers["differingPixels"])
    return passes.differing(native, saved)


@cases.case
def exact_with_windows_of_nodes(context):
    return exact(context, ("names", "stats"), ["--tiles", "2x2", "--display", "windows"])


@cases.case
def exact_with_the_programs_window(context):
    return exact(context, ("grid",), ["--tiles", "2x2", "--display", "app"])


@cases.case
def saved_pictures_contain_it_on_request(context):
    with tempfile.TemporaryDirectory(prefix="mural-overlay.") as out:
        command = [context.program("long_run"), "--frames", "3", "--size", "%dx%d" % SIZE]
        with context.run(command, ["--tiles", "2x2", "--display", "none", "--overlay", "grid", "--overlay-in-files", "--out", out]) as run:
            wrong = cases.check_end(run, 0)
        saved = [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))]
    if wrong or len(saved) != 3:
        return wrong or "%d pictures" % len(saved)
    return next((text for text in (wrong_grid(picture.rows, (0, 0) + SIZE, SIZE[1]) for picture in saved) if text), None)


# ---- changes of a program that draws nothing

def changes(context, options):
    """Stops the program. The overlay then appears and disappears, and leaves no trace."""
    command = [context.program("long_run"), "--frames", "1000000", "--size", "%dx%d" % SIZE]
    with context.run(command, ["--tiles", "2x2"] + options) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        stopped = run.processes("long_run .*--frames")[-1]
        os.kill(stopped, signal.SIGSTOP)
        plain = still_screen(context)
        wrong, slowest = None, 0.0
        for mode in MODES if plain else ():
            wrong = change(context, run, mode)
            on = wrong or seconds_until(lambda: screen(context) != plain)
            wrong = wrong or change(context, run, "off")
            off = wrong or seconds_until(lambda: screen(context) == plain)
            if wrong or on is None or off is None:
                wrong = "%s: %s" % (mode, wrong or ("does not appear" if on is None else "remains after the overlay is off"))
                break
            slowest = max(slowest, on, off)
        os.kill(stopped, signal.SIGCONT)
        ctl(context, str(run.process.pid), "stop")
        print("    the slowest change took %.2f s" % slowest)
        if slowest > SECONDS * 5:  # a loaded machine
            wrong = wrong or "a change took %.2f s" % slowest
        return wrong or ("the screen is never still" if not plain else None) or cases.check_end(run, 0)


@cases.case
def windows_of_nodes_change(context):
    return changes(context, ["--display", "windows"])


@cases.case
def windows_of_the_head_change(context):
    """Several passes: the head has the windows."""
    return changes(context, ["--display", "windows", "--subpixel", "2", "--local-nodes", "2"])


@cases.case
def window_of_the_program_changes(context):
    return changes(context, ["--display", "app"])


# ---- the picture of the grid

def pixel(rows, x, y):
    return rows[y][3 * x:3 * x + 3]


def wrong_grid(rows, part, wall_height):
    """Compares a window with the grid of its place on the wall, origin lower left; returns an error, or None."""
    x0, y0, width, height = part
    if (len(rows[0]) // 3, len(rows)) != (width, height):
        return "%dx%d pixels instead of %dx%d" % (len(rows[0]) // 3, len(rows), width, height)
    edges = [(x, y) for x in range(width) for y in (0, height - 1)] + [(x, y) for y in range(height) for x in (0, width - 1)]
    if any(pixel(rows, x, y) != GREEN for x, y in edges):
        return "no border at the edge"
    columns = [x - x0 for x in range(0, 10000, 100) if 0 < x - x0 < width - 1]
    lines = [height - 1 - (y - y0) for y in range(0, 10000, 100) if 0 < y - y0 < height - 1]
    # beside circles, labels and grey steps most pixels of a line are white
    white = lambda places: 2 * sum(pixel(rows, x, y) == WHITE for x, y in places) > len(places)
    for x in columns:
        if not white([(x, y) for y in range(1, height - 1)]) or white([(x + 1, y) for y in range(1, height - 1)]):
            return "no line of one pixel in column %d" % (x + x0)
    for y in lines:
        if not white([(x, y) for x in range(1, width - 1)]):
            return "no line in row %d" % (height - 1 - y + y0)
    return None if columns or lines else "no lines"


def tile(number):
    """Returns the part of the wall that the window of this tile shows, for 2x2 tiles in reading order."""
    width, height = SIZE[0] // 2, SIZE[1] // 2
    return (number % 2 * width, 0 if number >= 2 else height, width, height)


def grid_in(context, number):
    """Waits until the window of this tile shows the grid; returns an error, or None."""
    wrong = None
    def shown():
        nonlocal wrong
        rows = window(context, "Mural tile %d" % number)
        wrong = wrong_grid(rows, tile(number), SIZE[1]) if rows else "no window"
        return wrong is None
    return None if seconds_until(shown) is not None else "tile %d: %s" % (number, wrong)


@cases.case
def grid_continues_over_all_windows(context):
    """Lines have the wall's coordinates, and borders are at the edge of each window."""
    command = [context.program("long_run"), "--frames", "1000000", "--size", "%dx%d" % SIZE]
    with context.run(command, ["--tiles", "2x2", "--display", "windows", "--overlay", "grid"]) as run:
        if not run.wait_for_line("frame 5"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        wrong = [text for text in (grid_in(context, number) for number in range(4)) if text]
        ctl(context, str(run.process.pid), "stop")
        return "; ".join(wrong) or cases.check_end(run, 0)


@cases.case
def restarted_nodes_and_single_nodes(context):
    """A restarted node shows the current overlay. `overlay MODE NODE` changes the windows of one node alone."""
    command = [context.program("long_run"), "--frames", "1000000", "--size", "%dx%d" % SIZE]
    with context.run(command, ["--tiles", "2x2", "--display", "windows"]) as run:
        if not run.wait_for_line("frame 5"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        wrong = change(context, run, "grid", "1") or grid_in(context, 0)  # node 1 draws the upper left tile
        rows = None if wrong else window(context, "Mural tile 3")
        if rows is not None and wrong_grid(rows, tile(3), SIZE[1]) is None:
            wrong = "the overlay of node 1 is in another window"
        if not wrong:
            cases.kill_all(run.wait_for_processes(cases.NODE, 4)[1:2])
            joined = seconds_until(lambda: any(node["joins"] > 0 and node["state"] == "alive" for node in result_of(context, run, "nodes")["nodes"]))
            wrong = "no node joined" if joined is None else grid_in(context, 0)
        told = [node["overlay"] for node in result_of(context, run, "overlay")["nodes"]]
        if not wrong and told != ["off", "grid", "off", "off"]:
            wrong = "the overlays are %s" % told
        ctl(context, str(run.process.pid), "stop")
        return wrong or cases.check_end(run, 0)


@cases.case
def new_nodes_of_another_plan(context):
    """Nodes that come with a change of the plan show the current overlay."""
    command = [context.program("long_run"), "--frames", "1000000", "--size", "%dx%d" % SIZE]
    with context.run(command, ["--tiles", "2x1", "--display", "windows"]) as run:
        if not run.wait_for_line("frame 5"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        wrong = change(context, run, "grid")
        changed = subprocess.run([context.mural, "change", "--tiles", "2x2", str(run.process.pid)], capture_output=True, timeout=PATIENCE_SECONDS, check=False)
        if not wrong and changed.returncode != 0:
            wrong = changed.stderr.decode()
        wrong = wrong or next((text for text in (grid_in(context, number) for number in range(4)) if text), None)
        told = {node["overlay"] for node in result_of(context, run, "overlay")["nodes"]}
        if not wrong and told != {"grid"}:
            wrong = "the overlays are %s" % told
        ctl(context, str(run.process.pid), "stop")
        return wrong or cases.check_end(run, 0)


@cases.case
def wrong_values_are_refused(context):
    """Each error is one line with the valid values."""
    with context.run([context.program("long_run"), "--frames", "1000000", "--size", "100x80"], ["--tiles", "2x1", "--display", "none"]) as run:
        if not run.wait_for_line("frame 5"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        wrong = []
        for words in (("gird",), ("grid", "2"), ("grid", "-1"), ("grid", "x"), ("grid", "0", "1")):
            status, _, message = ctl(context, str(run.process.pid), "overlay", *words)
            if status == 0 or message.count("\n") != 1:
                wrong.append("overlay %s: status %d, %s" % (" ".join(words), status, message))
        ctl(context, str(run.process.pid), "stop")
        wrong += [text for text in [cases.check_end(run, 0)] if text]
    started = subprocess.run([context.mural, "run", "--overlay", "gird", "--", "true"], capture_output=True, check=False)
    message = started.stderr.decode()
    if started.returncode != 2 or "off, stats, names or grid" not in message or message.count("\n") != 1:
        wrong.append("--overlay gird: status %d, %s" % (started.returncode, message))
    return "; ".join(wrong) or None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
