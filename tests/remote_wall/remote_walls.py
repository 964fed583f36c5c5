#!/usr/bin/env python3
"""Remote walls: a session sends its pictures (mural run --send), and mural show saves them.

  remote_walls.py --build build/release [--cases pictures,losses] [--list]
"""

import ctypes
import os
import re
import subprocess
import sys
import tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(TOP, "tests", "end_to_end"), os.path.join(TOP, "tests", "remote_wall")]
from harness import cases, pictures, processes, programs  # noqa: E402
from shown_wall import Wall, secret  # noqa: E402

SIZE = (253, 191)
FRAMES = 30
PROGRAM = "long_scene"
MIN_DB = 45  # of jpeg-100
MOST_BYTES = 200  # of an unchanged frame


def drawing(context, key, sends, frames=FRAMES):
    options = ["--tiles", "2x1", "--display", "none", "--secret", key] + [word for send in sends for word in ("--send", send)]
    command = [context.program(PROGRAM), "--frames", str(frames), "--size", "%dx%d" % SIZE]
    return context.run(command, options)


def native(context, folder):
    run = programs.run_program(context.build, PROGRAM, os.path.join(folder, "native"), context.display, "%dx%d" % SIZE,
                               FRAMES, more_environment={"SCENE_PAUSE_US": "0"})
    return [pictures.read_ppm(path) for _, path in sorted(run.frames().items())]


@cases.case
def pictures_arrive(context):
    """Lossless codecs show each pixel as without Mural, jpeg-100 is close, and the last frame is always shown."""
    with tempfile.TemporaryDirectory(prefix="mural-remote.") as folder:
        key, plain = secret(folder, "key"), native(context, folder)
        with Wall(context, folder, "exact", key) as exact, Wall(context, folder, "close", key) as close:
            with drawing(context, key, ["exact=127.0.0.1:%d,codec=auto" % exact.port, "close=127.0.0.1:%d,tile=64" % close.port]) as run:
                wrong = cases.check_end(run, 0, FRAMES)
            if wrong is not None:
                return wrong
            for wall in (exact, close):
                if wall.numbers()[-1:] != [FRAMES] or len(wall.numbers()) < 3:
                    return "frames %s of %d" % (wall.numbers(), FRAMES)
            difference = pictures.Difference()
            for number in exact.numbers():
                difference.add_pictures(plain[number - 1], exact.picture(number), "frame %d" % number)
            if difference.pixels != 0:
                return "%d pixels differ, %s" % (difference.pixels, difference.place)
            near = min(pictures.decibels(plain[number - 1], close.picture(number)) for number in close.numbers())
            print("%d and %d of %d frames, jpeg-100: %.1f dB" % (len(exact.numbers()), len(close.numbers()), FRAMES, near))
            if near < MIN_DB:
                return "%.1f dB" % near
            return None if exact.end() == 0 else "status %s after SIGTERM" % exact.process.returncode


@cases.case
def losses(context):
    """A wall that is killed and started again, a session that is killed, and a wrong secret."""
    with tempfile.TemporaryDirectory(prefix="mural-remote.") as folder:
        key, other = secret(folder, "key"), secret(folder, "other")
        with Wall(context, folder, "first", key) as first:
            sends = ["wall=127.0.0.1:%d" % first.port, "denied=127.0.0.1:%d,secret=%s" % (first.port, other)]
            with drawing(context, key, sends, frames=100000) as run:
                if not first.saves_after(2):
                    return "no frames: " + " | ".join(run.standard_error + first.lines)
                denied = [line for line in run.standard_error if "denied" in line]
                if len(denied) != 1 or "secret" not in denied[0]:
                    return "the wrong secret is reported as %s" % denied
                if not first.has_line("was not accepted"):
                    return "the wall does not report the wrong secret"
                first.kill()
                last = first.numbers()[-1]
                with Wall(context, folder, "second", key, first.port) as second:
                    if not second.saves_after(last):
                        return "nothing after the restart of the wall: " + " | ".join(run.standard_error + second.lines)
                    last = second.numbers()[-1]
                    cases.kill_all(run.processes("."))
                    if not second.has_line("is gone"):
                        return "the wall does not notice the end of the session"
                    with drawing(context, key, sends[:1], frames=5) as again:
                        wrong = cases.check_end(again, 0, 5)
                    if wrong is not None or not second.saves_after(last):
                        return wrong or "no frame of the second session"
                    return None if second.end() == 0 else "status %s after SIGTERM" % second.process.returncode


def click(display, x, y):
    """Clicks at a place of the screen."""
    xcb, test = ctypes.CDLL("libxcb.so.1"), ctypes.CDLL("libxcb-xtest.so.0")
    xcb.xcb_connect.restype = ctypes.c_void_p
    connection = ctypes.c_void_p(xcb.xcb_connect(display.encode(), None))
    for kind, button in ((6, 0), (4, 1), (5, 1)):  # motion, press, release
        test.xcb_test_fake_input(connection, kind, button, 0, 0, ctypes.c_int16(x), ctypes.c_int16(y), 0)
    xcb.xcb_flush(connection)
    return connection  # the server forgets the events of a client that ends too early


def unchanged_bytes(run):
    """Returns the bytes of the frames without changed tiles."""
    sent = [re.search(r"\b(\d+) tiles, (\d+) bytes", line) for line in list(run.standard_error)]
    return [int(found.group(2)) for found in sent if found and found.group(1) == "0"]


@cases.case
def input_reaches_the_program(context):
    """A click into the window of the wall changes the colour of a square in the middle. Without a click the program
    draws the same picture once per second, which takes few bytes."""
    size, place = (250, 190), (300, 200)
    with tempfile.TemporaryDirectory(prefix="mural-remote.") as folder:
        key = secret(folder, "key")
        with Wall(context, folder, "wall", key, more=("--display", "windows", "--position", "%d,%d" % place)) as wall:
            options = ["--size", "%dx%d" % size, "--display", "none", "--secret", key, "--send", "wall=127.0.0.1:%d,codec=auto,input=on" % wall.port]
            with context.run([context.program("click_scene"), "--frames", "100", "--size", "%dx%d" % size], options, {"MURAL_LOG": "output:trace"}) as run:
                if not wall.saves_after(1):
                    return "no frame: " + " | ".join(run.standard_error + wall.lines)

                def middle():
                    picture = wall.picture(wall.numbers()[-1])
                    at = 3 * (size[0] // 2)
                    return tuple(picture.rows[size[1] // 2][at:at + 3])

                before = middle()
                connection = click(context.display, place[0] + size[0] // 2, place[1] + size[1] // 2)
                if not processes.until(lambda: middle() != before, 10):
                    return "the middle keeps the colour %s: %s" % (before, " | ".join(run.standard_error + wall.lines))
                del connection
                if not processes.until(lambda: unchanged_bytes(run), 10):
                    return "no unchanged frame: " + " | ".join(run.standard_error)
                print("unchanged frames: %d bytes" % max(unchanged_bytes(run)))
                return None if max(unchanged_bytes(run)) < MOST_BYTES else "%d bytes" % max(unchanged_bytes(run))


@cases.case
def wrong_arguments(context):
    """One line and status 2."""
    with tempfile.TemporaryDirectory(prefix="mural-remote.") as folder:
        key = secret(folder, "key")
        with Wall(context, folder, "wall", key) as wall:
            show = ["show", "--display", "none", "--out", os.path.join(folder, "out")]
            for words, part in ((show, "--listen"), (show + ["--listen", "0"], "--secret FILE is required"),
                                (show + ["--listen", "127.0.0.1:%d" % wall.port, "--secret", key], "choose another port"),
                                (show + ["--listen", "0", "--secret", key, "--size", "3"], "--size \"3\""),
                                (["show", "--listen", "0", "--secret", key, "--display", "none"], "--out"),
                                (["run", "--send", "a=127.0.0.1:1", "--", "true"], "--secret"),
                                (["run", "--secret", key, "--send", "a=nowhere", "--", "true"], "HOST:PORT")):
                done = subprocess.run([context.mural] + words, env=programs.clean_environment(context.display), text=True,
                                      capture_output=True, timeout=20, check=False)
                if done.returncode != 2 or part not in done.stderr or done.stderr.count("\n") != 1:
                    return "%s: status %d: %s" % (" ".join(words), done.returncode, done.stderr)
    return None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
