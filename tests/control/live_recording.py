#!/usr/bin/env python3
"""Recordings that `mural ctl record start` begins while programs draw. A replay shows exactly the pictures that the
session itself saved, from the reported frame on.

live_recording.py --build build/release [--cases scene,errors] [--list]
"""

import os
import shutil
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, length, pictures, programs, session  # noqa: E402
from harness.control import PATIENCE_SECONDS, ctl, result_of  # noqa: E402

SIZE = "252x190"
LAYOUTS = (("--tiles", "1x1"), ("--tiles", "2x2")) if length.LONG else (("--tiles", "2x2"),)
BEFORE, DURING = 12, 8  # frames before and during a recording, at least


def wait_for_frames(context, run, wanted, programs=0):
    """Returns whether the wall has shown that many frames in time, and that many programs have drawn."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline and run.process.poll() is None:
        status = result_of(context, run, "status")
        if status.get("frames", 0) >= wanted and sum(program["frames"] > 0 for program in status["programs"]) >= programs:
            return True
        time.sleep(0.02)
    return False


def read_pictures(folder):
    return [pictures.read_png(os.path.join(folder, name)) for name in sorted(os.listdir(folder))] if os.path.isdir(folder) else []


class Recorded:
    """One session with saved pictures, a part of which it records, and the replay of that part."""

    def __init__(self, context, command, options=("--tiles", "2x1"), environment=None, stops=True, programs=0):
        self.context, self.command, self.stops, self.programs = context, command, stops, programs
        self.options = list(options)
        self.environment = environment or {}
        self.folder = tempfile.TemporaryDirectory(prefix="mural-recordings.")
        self.file, self.live = self.path("a.mural"), self.path("live")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def record(self):
        """Returns an error, or None; sets the first recorded frame."""
        with self.context.run(self.command, self.options + ["--display", "none", "--out", self.live], self.environment) as run:
            if not wait_for_frames(self.context, run, BEFORE, self.programs):
                return "no frames: %s" % " | ".join(run.standard_error[-3:])
            begun = result_of(self.context, run, "record", "start", self.file)
            if begun.get("file") != self.file:
                return "record start: %s" % begun
            self.first = begun["firstFrame"]
            wrong = self.runs_late_program()
            if wrong is not None:
                return wrong
            if not wait_for_frames(self.context, run, self.first + DURING):
                return "no frames during the recording: %s" % " | ".join(run.standard_error[-3:])
            if result_of(self.context, run, "status")["recording"]["firstFrame"] != self.first:
                return "the status has no recording"
            if self.stops:
                ended = result_of(self.context, run, "record", "stop")
                if ended.get("frames", 0) < DURING or not ended["complete"] or ended["bytes"] != os.path.getsize(self.file):
                    return "record stop: %s, file of %d bytes" % (ended, os.path.getsize(self.file))
                if result_of(self.context, run, "status")["recording"] is not None:
                    return "the status still has a recording"
            ctl(self.context, str(run.process.pid), "stop")
            return cases.check_end(run, 0)

    def runs_late_program(self):
        """Waits for the program that begins during the recording, if any; returns an error, or None."""
        if "LATE_BEGIN" not in self.environment:
            return None
        with open(self.environment["LATE_BEGIN"], "w", encoding="ascii"):
            pass
        deadline = time.monotonic() + PATIENCE_SECONDS
        while not os.path.exists(self.environment["LATE_END"]):
            if time.monotonic() > deadline:
                return "the late program does not end"
            time.sleep(0.02)
        return None

    def differing(self, tiles):
        """Replays the trace and compares; returns an error, or None."""
        out = self.path("replayed")
        shutil.rmtree(out, ignore_errors=True)
        command = [self.context.mural, "replay", self.file, "--display", "none", "--out", out] + list(tiles)
        with session.Session(command, self.context.display) as run:
            wrong = cases.check_end(run, 0)
        if wrong is not None:
            return "replay: " + wrong
        replayed = read_pictures(out)
        live = read_pictures(self.live)[self.first - 1:][:len(replayed)]
        if len(replayed) < DURING or len(live) != len(replayed):
            return "%d pictures replayed, %d live" % (len(replayed), len(live))
        difference = pictures.Difference()
        for number, (first, second) in enumerate(zip(live, replayed)):
            difference.add_pictures(first, second, "frame %d" % (self.first + number))
        print("    %s on %s: frames %d to %d, %d pixels differ" % (os.path.basename(self.command[0]), " ".join(tiles), self.first,
                                                                  self.first + len(replayed) - 1, difference.pixels))
        return None if difference.pixels == 0 else "%d pixels differ, %s" % (difference.pixels, difference.place)


def exact(context, name, tiles=LAYOUTS, **more):
    recorded = Recorded(context, [context.program(name), "--frames", "100000", "--size", SIZE], **more)
    wrong = recorded.record()
    for layout in tiles:
        wrong = wrong or recorded.differing(layout)
    return wrong and "%s: %s" % (name, wrong)


@cases.case
def scene(context):
    """Textures that change, a buffer, a framebuffer object, a list, a query; the pictures also equal native ones."""
    recorded = Recorded(context, [context.program("long_scene"), "--frames", "100000", "--size", SIZE], environment={"SCENE_MIB": "4"})
    wrong = recorded.record() or recorded.differing(("--tiles", "2x2")) or recorded.differing(("--tiles", "1x3"))
    if wrong is not None:
        return wrong
    replayed = read_pictures(recorded.path("replayed"))
    native = programs.run_program(context.build, "long_scene", recorded.path("native"), context.display, SIZE,
                                  recorded.first - 1 + len(replayed), more_environment={"SCENE_MIB": "4", "SCENE_PAUSE_US": "0"})
    alone = [pictures.read_ppm(path) for _, path in sorted(native.frames().items())][recorded.first - 1:]
    difference = pictures.Difference()
    for number, (first, second) in enumerate(zip(alone, replayed)):
        difference.add_pictures(first, second, "frame %d" % (recorded.first + number))
    print("    %d native pictures, %d pixels differ" % (len(alone), difference.pixels))
    return None if len(alone) == len(replayed) and difference.pixels == 0 else "native: %s" % difference.place


@cases.case
def scene_that_keeps_its_picture(context):
    """Only the first frame clears, so the recording contains the draws of all earlier frames. The session's end completes
    the file."""
    return exact(context, "long_scene", environment={"SCENE_MIB": "4", "SCENE_KEEPS": "1"}, stops=False)


@cases.case
def programs_of_all_kinds(context):
    """Lists, large values, copies of windows, reads, threads, shared contexts, several windows, ES."""
    names = ("display_lists", "persistent_frames", "framebuffers", "pixels_read", "accum_buffer", "frames_kept", "threads_windows",
             "shared_contexts", "several_windows", "glsl_uniforms", "es2_scene", "queries_later")
    wrong = [exact(context, name, tiles=(("--tiles", "2x2"),)) for name in length.some(names)]
    return "; ".join(text for text in wrong if text) or None


@cases.case
def several_programs(context):
    """Two programs at the start of the recording, and one that begins and ends during the recording."""
    program = context.program("long_scene")
    script = ('"$0" --frames 100000 --size 131x77 > /dev/null & '
              '(until test -e "$LATE_BEGIN"; do sleep 0.1; done; "$0" --frames 5 --size 99x60 > /dev/null; : > "$LATE_END") & '
              'exec "$0" --frames 100000 --size ' + SIZE)
    recorded = Recorded(context, ["/bin/sh", "-c", script, program], environment={"SCENE_MIB": "4"}, programs=2)
    recorded.environment.update(LATE_BEGIN=recorded.path("late_begin"), LATE_END=recorded.path("late_end"))
    return recorded.record() or recorded.differing(("--tiles", "2x2"))


@cases.case
def two_recordings(context):
    """A second recording of a session is as exact as the first one."""
    recorded = Recorded(context, [context.program("long_scene"), "--frames", "100000", "--size", SIZE], environment={"SCENE_MIB": "4"})
    with context.run(recorded.command, ["--tiles", "2x1", "--display", "none"]) as run:
        frames = []
        for name in ("a.mural", "b.mural"):
            if not wait_for_frames(context, run, BEFORE):
                return "no frames"
            begun = result_of(context, run, "record", "start", recorded.path(name))
            wait_for_frames(context, run, begun.get("firstFrame", 0) + DURING)
            ended = result_of(context, run, "record", "stop")
            frames.append((begun.get("firstFrame"), ended.get("frames", 0)))
        ctl(context, str(run.process.pid), "stop")
        wrong = cases.check_end(run, 0)
    print("    first frames and numbers of frames: %s" % frames)
    return wrong or (None if frames[1][0] >= frames[0][0] + frames[0][1] and frames[1][1] >= DURING else "the recordings overlap")


@cases.case
def errors(context):
    """Each error is one line with the next step, and leaves no file."""
    wrong = []

    def refused(run, words, text, status=1):
        got, output, message = ctl(context, str(run.process.pid), *words)
        if got != status or text not in message or message.count("\n") != 1:
            wrong.append("%s: status %d, %s%s" % (" ".join(words), got, output, message))

    with tempfile.TemporaryDirectory(prefix="mural-recordings.") as folder:
        file = os.path.join(folder, "a.mural")
        command = [context.program("long_run"), "--frames", "100000", "--size", SIZE]
        with context.run(command, ["--tiles", "2x1", "--display", "none"]) as run:
            wait_for_frames(context, run, 5)
            refused(run, ("record", "stop"), "record start FILE")
            refused(run, ("record", "start", "/nowhere/a.mural"), "/nowhere/a.mural: cannot be written")
            refused(run, ("record", "start", "/dev/full"), "No space left")
            refused(run, ("record", "start"), "usage: mural ctl", 2)
            refused(run, ("record", "begin"), "record start FILE", 2)
            ctl(context, str(run.process.pid), "record", "start", file)
            refused(run, ("record", "start", file + "2"), "already records into " + file)
            frames = result_of(context, run, "status")["frames"]
            wrong += [] if wait_for_frames(context, run, frames + 10) else ["the program does not continue"]
            ctl(context, str(run.process.pid), "stop")
            wrong += [text for text in [cases.check_end(run, 0)] if text]
        for options, text in ((("--tiles", "1x1"), "with two nodes"), (("--tiles", "2x1", "--restart-nodes", "0"), "--restart-nodes 1")):
            with context.run(command, list(options) + ["--display", "none"]) as run:
                wait_for_frames(context, run, 5)
                refused(run, ("record", "start", file + "3"), text)
        with context.run([context.program("long_scene"), "--frames", "100000", "--size", SIZE],
                         ["--tiles", "2x1", "--display", "none", "--cache-size", "1MiB"], {"SCENE_MIB": "12"}) as run:
            wait_for_frames(context, run, 5)
            refused(run, ("record", "start", file + "3"), "--cache-size")
        wrong += [] if sorted(os.listdir(folder)) == ["a.mural"] else ["files: %s" % os.listdir(folder)]
    return "; ".join(wrong) or None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
