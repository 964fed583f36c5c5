#!/usr/bin/env python3
"""Pointer and keys of wall windows reach the program (--window-input).

  window_input.py --build build/release [--cases tiles,head,bezels,own_display,off] [--list]
"""

import ctypes
import os
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, processes  # noqa: E402

WIDTH, HEIGHT = 320, 200
SHIFT = (40, 30)  # of the wall on the screen
MOTION, KEY_DOWN, KEY_UP, PRESS, RELEASE = 6, 2, 3, 4, 5  # types of X events
KEYCODE_A = 38
NEVER_SECONDS = 2  # for a click that must not arrive
BEZELS = """#Equalizer 1.2 ascii
server { config {
  appNode { pipe {
    window { viewport [ 0 0 150 200 ] channel { name "left" } }
    window { viewport [ 170 0 150 200 ] channel { name "right" } } } }
  observer {}
  layout { name "simple" view { observer 0 } }
  canvas { layout "simple" wall { bottom_left [ -.8 -.5 -1 ] bottom_right [ .8 -.5 -1 ] top_left [ -.8 .5 -1 ] }
    segment { channel "left" viewport [ 0 0 .46875 1 ] }
    segment { channel "right" viewport [ .53125 0 .46875 1 ] } }
  compound { compound { channel ( segment 0 view 0 ) } compound { channel ( segment 1 view 0 ) } }
} }
"""


class Hand:
    """Pointer and keyboard of a person in front of the wall: XTEST on the display of its windows."""

    def __init__(self, display):
        self.xcb, self.test = ctypes.CDLL("libxcb.so.1"), ctypes.CDLL("libxcb-xtest.so.0")
        self.xcb.xcb_connect.restype = ctypes.c_void_p
        self.connection = ctypes.c_void_p(self.xcb.xcb_connect(display.encode(), None))
        self.xcb.xcb_set_input_focus(self.connection, 1, 1, 0)  # the window below the pointer has the keyboard

    def fake(self, kind, detail, x=0, y=0):
        self.test.xcb_test_fake_input(self.connection, kind, detail, 0, 0, ctypes.c_int16(x), ctypes.c_int16(y), 0)
        self.xcb.xcb_flush(self.connection)

    def click(self, x, y, button=1):
        self.fake(MOTION, 0, x, y)
        self.fake(PRESS, button)
        self.fake(RELEASE, button)

    def tap(self, keycode):
        self.fake(KEY_DOWN, keycode)
        self.fake(KEY_UP, keycode)

    def close(self):
        self.xcb.xcb_disconnect(self.connection)


def has_line(run, line, seconds=5):
    return processes.until(lambda: any(line == got.strip() for got in list(run.standard_output)), seconds)


def session(context, *options, size=True, shift=SHIFT):
    command = [context.program("input_events"), "--frames", "1000000", "--size", "%dx%d" % (WIDTH, HEIGHT)]
    place = ["--position", "%d,%d" % shift] + (["--size", "%dx%d" % (WIDTH, HEIGHT)] if size else [])
    return context.run(command, ["--display", "windows", *place, *options])


def wrong_places(context, run, places, seconds=5):
    """Clicks at places of the screen. places: (x, y) of the screen: (x, y) of the program's window."""
    if not processes.until(lambda: any("frame 5" in line for line in list(run.standard_output)), 30):
        return "no frame: " + " | ".join(run.standard_error[-5:])
    time.sleep(0.5)  # the windows open with the first picture
    hand = Hand(context.display)
    try:
        for button, (screen, place) in enumerate(places.items()):
            number = 1 + button % 3
            hand.click(SHIFT[0] + screen[0], SHIFT[1] + screen[1], number)
            line = "button %d down %d,%d" % (number, *place)
            if not has_line(run, line, seconds) or not has_line(run, line.replace("down", "up")):
                return "no \"%s\": %s" % (line, [got for got in run.standard_output if "button" in got][-3:] + run.standard_error[-3:])
        hand.tap(KEYCODE_A)
        if not has_line(run, "key 61 down") or not has_line(run, "key 61 up"):
            return "the key does not reach the program"
    finally:
        hand.close()
    return None


@cases.case
def tiles_of_nodes(context):
    """The windows of four nodes: each place is exact, also at the borders of tiles."""
    places = [(0, 0), (80, 50), (159, 99), (160, 99), (159, 100), (160, 100), (240, 150), (319, 0), (0, 199), (319, 199)]
    with session(context, "--tiles", "2x2") as run:
        wrong = wrong_places(context, run, {place: place for place in places})
        if wrong is None:
            print("%d places, largest error 0 pixels" % len(places))
        return wrong


@cases.case
def head_shows_the_wall(context):
    """The window of the head, which composites the picture of two nodes."""
    with session(context, "--db", "2") as run:
        return wrong_places(context, run, {(10, 20): (10, 20), (319, 199): (319, 199), (160, 100): (160, 100)})


@cases.case
def bezels(context):
    """A bezel of 20 pixels between two windows: the right one begins at column 170."""
    with tempfile.TemporaryDirectory(prefix="mural-input.") as folder:
        path = os.path.join(folder, "wall.eqc")
        with open(path, "w", encoding="ascii") as file:
            file.write(BEZELS)
        with session(context, "--config", path, "--all-local") as run:
            return wrong_places(context, run, {place: place for place in ((0, 0), (149, 199), (170, 0), (319, 199))})


def clicks_own_display(context, shift, line):
    """Clicks into a wall window on the program's display. Returns the output with this line, or None."""
    with session(context, "--tiles", "2x1", "--window-input", "display", size=False, shift=shift) as run:
        if not processes.until(lambda: any("frame 5" in got for got in list(run.standard_output)), 30):
            return None
        time.sleep(0.5)
        hand = Hand(context.display)
        try:
            for _ in range(3):  # the reason is known with the next event
                hand.click(shift[0] + 300, shift[1] + 150)
                lines = run.standard_output + run.standard_error
                if processes.until(lambda: any(line in got for got in run.standard_output + run.standard_error), 1):
                    return lines
        finally:
            hand.close()
    return None


@cases.case
def own_display(context):
    """A program on the display of its user: one line says why no click arrives, unless --window-input display."""
    with session(context, "--tiles", "2x1", size=False) as run:
        wrong = wrong_places(context, run, {(300, 150): (300, 150)}, NEVER_SECONDS)
        lines = [line for line in run.standard_error if "--window-input display" in line]
        if wrong is None or len(lines) != 1:
            return "the click arrived, or no line says why not: %s" % run.standard_error
    if not clicks_own_display(context, (700, 30), "button 1 down 300,150"):
        return "the click does not arrive"
    return "a click arrives through another window" if clicks_own_display(context, (0, 0), "covers the program's window") is None else None


@cases.case
def off(context):
    """--window-input off: nothing arrives, and nothing is reported."""
    with session(context, "--tiles", "2x1", "--window-input", "off") as run:
        wrong = wrong_places(context, run, {(300, 150): (300, 150)}, NEVER_SECONDS)
        lines = [line for line in run.standard_error if "input" in line]
    return None if wrong is not None and not lines else "the click arrived, or a line: %s" % lines


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
