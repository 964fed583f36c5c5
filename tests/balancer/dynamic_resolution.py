#!/usr/bin/env python3
"""Sessions with a DFR_equalizer: a program that moves keeps its frame rate by a coarser picture, and a program that
stands still has each pixel of the native picture. The load rises in between.

  dynamic_resolution.py --build build/release [--cases still,halves] [--list]
"""

import json
import os
import signal
import statistics
import sys
import tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, control, pictures, programs, session  # noqa: E402

PROGRAM = "load_step"
WIDTH, HEIGHT = 320, 240
STEP, STILL, FRAMES = 12, 40, 46  # frames at which the load rises and the motion ends, and their number
DETECTED = STILL + 2  # frame STILL + 1 is the first repetition, so the next one has full resolution
HIGH_RATE = 500       # Hz; no machine draws the loaded frames at this rate, so the zoom falls to its limit
# The pause is longer than the time in which a program may be many frames ahead (common/ipc/capture_ring.hpp).
LOAD = {"LOAD_PAUSE_MS": "2", "LOAD_STEP": str(STEP), "LOAD_STILL": str(STILL), "LOAD_LAYERS": "2", "LOAD_STEP_LAYERS": "60"}
TAIL = 20  # frames without motion after the return of a node

FILE = """#Equalizer 1.2 ascii
server { config { appNode { pipe {
    window { viewport [ 0 0 %(width)d %(height)d ] channel { name "screen" } }
    window { viewport [ 0 0 %(width)d %(height)d ] channel { name "one" } }
    window { viewport [ 0 0 %(width)d %(height)d ] channel { name "two" } } } }
  layout { view { } } canvas { layout 0 wall { } segment { channel "screen" } }
  compound { channel ( ) buffer [ COLOR DEPTH ] %(tree)s } } }
"""
ONE = """compound { channel "one" DFR_equalizer { framerate %(rate)g } outputframe { } } inputframe { name "frame.one" }"""
DIVIDED = """compound { DFR_equalizer { framerate %%(rate)g } %s
  compound { channel "one" %s outputframe { } } compound { channel "two" %s outputframe { } } }
  inputframe { name "frame.one" } inputframe { name "frame.two" }"""
HALVES = DIVIDED % ("", "viewport [ 0 0 .5 1 ]", "viewport [ .5 0 .5 1 ]")
MOVING_HALVES = DIVIDED % ("load_equalizer { }", "", "")
RANGES = DIVIDED % ("", "range [ 0 .5 ]", "range [ .5 1 ]")
# one of two ranges of a picture, which cannot have a zoom of its own
ONE_RANGE = """compound { channel "one" range [ 0 .5 ] DFR_equalizer { framerate %(rate)g } outputframe { } }
  compound { channel "two" range [ .5 1 ] outputframe { } }
  inputframe { name "frame.one" } inputframe { name "frame.two" }"""


class Drawn:
    """One run of the program with a configuration: its pictures, report and messages. last: number of pictures to read,
    from the end; 0: all."""

    def __init__(self, context, tree, rate, frames=FRAMES, options=(), environment=None, saves=True, during=None, complete=True, last=0):
        with tempfile.TemporaryDirectory(prefix="mural-resolution.") as folder:
            config, report = os.path.join(folder, "dfr.eqc"), os.path.join(folder, "report.json")
            out = os.path.join(folder, "out")
            with open(config, "w", encoding="ascii") as file:
                file.write(FILE % {"width": WIDTH, "height": HEIGHT, "tree": tree % {"rate": rate}})
            command = [context.program(PROGRAM), "--frames", str(frames), "--size", "%dx%d" % (WIDTH, HEIGHT)]
            more = ["--config", config, "--explain", "--display", "none", "--report", report] + list(options)
            more += ["--out", out] if saves else []
            with context.run(command, more, dict(LOAD, **(environment or {}))) as run:
                self.wrong = during(context, run) if during else None
                self.wrong = self.wrong or cases.check_end(run, 0, frames if complete else None)
                self.messages = "\n".join(run.standard_error)
                self.still = max((int(line.split()[3]) for line in run.standard_output if line.startswith("frame ")), default=0)
                self.exposures = [line for line in run.standard_output if line.endswith("exposed")]
                self.times = [float(line.split()[2]) for line in run.standard_output if line.startswith("frame ")]
            self.pictures, self.equalizers = [], []
            if self.wrong is not None:
                return
            with open(report, encoding="utf-8") as file:
                self.equalizers = json.load(file)["equalizers"] or []
            if saves:
                self.pictures = [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))[-last:]]

    def equalizer(self):
        return next(e for e in self.equalizers if e["divides"] == "zoom")


NATIVE = {}  # by number of frames and environment


def native(context, environment=None, frames=FRAMES):
    """Returns the pictures of a native run."""
    key = frames, tuple(sorted((environment or {}).items()))
    if key not in NATIVE:
        with tempfile.TemporaryDirectory(prefix="mural-resolution.") as folder:
            run = programs.run_program(context.build, PROGRAM, os.path.join(folder, "native"), context.display, "%dx%d" % (WIDTH, HEIGHT), frames, more_environment=dict(LOAD, **(environment or {})))
            if run.status != 0:
                raise SystemExit("the program fails natively: status %s: %s" % (run.status, run.output[-200:]))
            NATIVE[key] = [pictures.read_ppm(path) for _, path in sorted(run.frames().items())]
    return NATIVE[key]


def differing(first, second):
    difference = pictures.Difference()
    if first.rows != second.rows:
        difference.add_pictures(first, second, "the picture")
    return difference.pixels


def judged(context, drawn):
    """Compares the pictures with native ones: coarser after the step of the load, equal when nothing moves."""
    if drawn.wrong is not None:
        return drawn.wrong
    wanted = native(context)
    if len(drawn.pictures) != len(wanted):
        return "%d pictures instead of %d" % (len(drawn.pictures), len(wanted))
    sizes = {(p.width, p.height) for p in drawn.pictures}
    if sizes != {(WIDTH, HEIGHT)}:
        return "pictures have the sizes %s" % sorted(sizes)
    apart = [differing(a, b) for a, b in zip(wanted, drawn.pictures)]
    if any(apart[DETECTED:]):
        return "pixels differ in a picture that stands still: %s" % apart[DETECTED:]
    coarse = sum(pixels > 0 for pixels in apart[STEP + 10:STILL])
    if coarse < (STILL - STEP - 10) * 0.9:
        return "%d of %d pictures after the step of the load are coarser: %s" % (coarse, STILL - STEP - 10, apart)
    if max(apart) == WIDTH * HEIGHT:
        return "a picture has no pixel of the native one"
    quality = [pictures.decibels(a, b) for a, b in zip(wanted[STEP:STILL], drawn.pictures[STEP:STILL])]
    if min(quality) < 15:
        return "a coarse picture has %.1f dB, so it shows something else" % min(quality)
    e = drawn.equalizer()
    return None if e["moves"] > 0 and e["zoom"] == 1 else "the equalizer reports %s" % e


@cases.case
def still_pictures_are_native(context):
    return judged(context, Drawn(context, ONE, HIGH_RATE))


@cases.case
def planted_faults_are_found(context):
    """A node that never takes a zoom over."""
    wrong = judged(context, Drawn(context, ONE, HIGH_RATE, environment={"MURAL_PLANT": "zoom"}))
    return None if wrong is not None and "are coarser" in wrong else "not found: %s" % wrong


# moving_halves has the same nodes
@cases.long_case
def halves_of_the_picture(context):
    return judged(context, Drawn(context, HALVES, HIGH_RATE))


@cases.case
def moving_halves(context):
    """The halves follow the load meanwhile, so areas and zooms change together."""
    drawn = Drawn(context, MOVING_HALVES, HIGH_RATE)
    wrong = judged(context, drawn)
    if wrong is None and all(e["moves"] == 0 for e in drawn.equalizers if e["divides"] == "picture"):
        return "the halves never moved: %s" % drawn.equalizers
    return wrong


@cases.case
def frame_after_a_pause(context):
    """A program that draws nothing for a while stands still. Its next frame has full resolution, also if it moves."""
    rest = STEP + 20
    drawn = Drawn(context, HALVES, HIGH_RATE, environment={"LOAD_REST": str(rest)})
    if drawn.wrong is not None:
        return drawn.wrong
    apart = [differing(a, b) for a, b in zip(native(context), drawn.pictures)]
    return None if apart[rest - 1] > 0 and apart[rest] == 0 and apart[rest + 3] > 0 else "pixels differ: %s" % apart


@cases.case
def program_that_waits_for_events(context):
    """A program that stops with a coarse picture receives one Expose event, and its redraw has full resolution."""
    redraw = STEP + 20
    drawn = Drawn(context, HALVES, HIGH_RATE, redraw + 2, environment={"LOAD_REDRAW": str(redraw)}, options=("--display", "app"))
    if drawn.wrong is not None:
        return drawn.wrong
    apart = [differing(native(context)[redraw - 1], picture) for picture in drawn.pictures[redraw - 1:]]
    if drawn.exposures != ["exposed", "not exposed"]:
        return "the program was %s" % drawn.exposures
    return None if apart[0] > 0 and not any(apart[1:]) else "pixels differ: %s" % apart


@cases.case
def ranges_of_the_draws(context):
    """All nodes of a composited picture take a zoom over at one frame; otherwise their parts would not fit."""
    return judged(context, Drawn(context, RANGES, HIGH_RATE))


@cases.case
def one_range_keeps_its_zoom(context):
    drawn = Drawn(context, ONE_RANGE, HIGH_RATE)
    if drawn.wrong is not None:
        return drawn.wrong
    if "the zoom stays fixed: it does not cover all ranges of a picture" not in drawn.messages:
        return "no message: %s" % drawn.messages[-300:]
    apart = [differing(a, b) for a, b in zip(native(context), drawn.pictures)]
    return None if not any(apart) else "pixels differ: %s" % apart


@cases.case
def full_resolution_at_low_rates(context):
    """A rate that the program reaches anyway changes nothing: each picture is exact."""
    drawn = Drawn(context, MOVING_HALVES, 0.01)
    if drawn.wrong is not None:
        return drawn.wrong
    apart = [differing(a, b) for a, b in zip(native(context), drawn.pictures)]
    return None if not any(apart) else "pixels differ: %s" % apart


def killed_and_returned(context, run, victim, end_file):
    """Kills a node in motion. The program stands still after the return of the node."""
    if not run.wait_for_line("frame %d " % (STEP + 20)):
        return "no frames: %s" % run.standard_error[-3:]
    os.kill(run.processes(cases.NODE)[victim], signal.SIGKILL)
    if not run.wait_for_line("rejoined "):
        return "node %d did not rejoin: %s" % (victim, run.standard_error[-3:])
    before = len(run.standard_output)
    run.wait_for_line("frame ")
    if not run.wait_for_line("frame ") or len(run.standard_output) == before:
        return "no frames after the return"
    session.end_after(end_file, TAIL)
    return None


def returns(context, tree, victim):
    with tempfile.TemporaryDirectory(prefix="mural-resolution.") as folder:
        end_file = os.path.join(folder, "end")
        during = lambda context, run: killed_and_returned(context, run, victim, end_file)
        drawn = Drawn(context, tree, HIGH_RATE, 6000, environment={"LOAD_PAUSE_MS": "15", "LOAD_STILL": "6000", "LOAD_STEP_LAYERS": "20", "END_FILE": end_file}, during=during, complete=False, last=TAIL + 20)
        if drawn.wrong is not None:
            return drawn.wrong
        still = str(drawn.still)
        wanted = native(context, {"LOAD_FIRST": still, "LOAD_STILL": still, "LOAD_STEP": "0", "LOAD_STEP_LAYERS": "20"}, 3)[-1]
        coarse = sum(differing(a, b) > 0 for a, b in zip(drawn.pictures[-TAIL - 12:-TAIL - 2], drawn.pictures[-TAIL - 11:-TAIL - 1]))
        apart = [differing(wanted, picture) for picture in drawn.pictures[3 - TAIL:]]
        if any(apart) or coarse == 0:
            return "pixels differ after the return: %s; %d pictures moved before" % (apart, coarse)
        e = drawn.equalizer()
        return None if e["moves"] > 0 and e["zoom"] == 1 else "the equalizer reports %s" % e


@cases.case
def returning_half(context):
    return returns(context, HALVES, 1)


# returning_collector has the same nodes
@cases.long_case
def returning_range(context):
    return returns(context, RANGES, 1)


@cases.case
def returning_collector(context):
    """A returned node takes the zoom over that the others have; otherwise its part has another size."""
    return returns(context, RANGES, 0)


def freezes(context, run):
    """Freezes the equalizer after its first changes, then lowers the wanted rate."""
    if not run.wait_for_line("frame %d " % (STEP + 8)):
        return "no frames: %s" % run.standard_error[-3:]
    name = control.result_of(context, run, "equalizers")["equalizers"][0]["name"]
    for words in (["freeze", "on"], ["set", "framerate", "0.01"]):
        if "error" in control.result_of(context, run, "equalizer", name, *words):
            return "ctl equalizer %s fails" % " ".join(words)
    shown = control.result_of(context, run, "equalizers")["equalizers"][0]
    return None if shown["frozen"] and float(shown["parameters"]["framerate"]) == 0.01 else "shown is %s" % shown


@cases.case
def frozen_zooms_stay(context):
    """A frozen zoom stays, even when the program stands still."""
    # slow frames: the operations must precede the end of the motion
    drawn = Drawn(context, ONE, HIGH_RATE, environment={"LOAD_PAUSE_MS": "60"}, during=freezes)
    if drawn.wrong is not None:
        return drawn.wrong
    e = drawn.equalizer()
    if not differing(native(context)[-1], drawn.pictures[-1]):
        return "the last picture is native, so the zoom moved: %s" % e
    return None if e["frozen"] and e["zoom"] < 1 else "the equalizer reports %s" % e


@cases.case
def the_rate_is_held(context):
    """The rate after the step of the load is near the wanted one. The machine may be busy, so the wanted rate is
    relative to this machine's, and single frames do not count."""
    frames, still = 100, 90
    environment = {"LOAD_STILL": str(still), "LOAD_STEP_LAYERS": "200"}
    free = Drawn(context, ONE, 0.01, 40, environment=environment, saves=False)
    if free.wrong is not None:
        return free.wrong
    slow = statistics.median(b - a for a, b in zip(free.times[STEP:], free.times[STEP + 1:])) / 1000
    rate = 2.5 / slow
    drawn = Drawn(context, ONE, rate, frames, environment=environment, saves=False)
    if drawn.wrong is not None:
        return drawn.wrong
    held = [b - a for a, b in zip(drawn.times[STEP + 10:still], drawn.times[STEP + 11:still])]
    near = sum(abs(time * rate / 1000 - 1) < 0.1 for time in held)
    median = statistics.median(held) * rate / 1000
    print("  %.1f Hz without the equalizer, %.1f Hz wanted: median time %.2f of it, %d of %d frames within 10 %%" % (1 / slow, rate, median, near, len(held)))
    return None if 0.7 < median < 1.3 else "the median time is %.2f of the wanted one: %s" % (median, drawn.equalizer())


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
