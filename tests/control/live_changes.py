#!/usr/bin/env python3
"""Changes to a running session by `mural ctl`: each happens at a frame boundary, and the pictures stay exact.

live_changes.py --build build/release [--cases latency] [--list]
"""

import json
import os
import signal
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, session  # noqa: E402
from harness.control import PATIENCE_SECONDS, ctl, result_of  # noqa: E402

SIZE = "250x190"
STILL_SECONDS = 0.6  # a program without a line for this time waits; it draws a frame in about 10 ms


def drawn(run):
    return sum(line.startswith("frame ") for line in run.standard_output)


def drawn_when_still(run):
    """Returns the number of frames when the program has drawn none for a while; None if it does not stop."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    frames, since = drawn(run), time.monotonic()
    while time.monotonic() < deadline:
        time.sleep(0.05)
        if drawn(run) != frames:
            frames, since = drawn(run), time.monotonic()
        elif time.monotonic() - since > STILL_SECONDS:
            return frames
    return None


@cases.case
def latency_of_a_waiting_program(context):
    """While a node stands still, the program draws exactly as many frames as a larger latency permits."""
    command = [context.program("long_run"), "--frames", "1000000", "--size", SIZE]
    with context.run(command, ["--tiles", "2x1", "--display", "none", "--latency", "1"]) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        stopped = run.wait_for_processes(cases.NODE, 2)[0]
        os.kill(stopped, signal.SIGSTOP)
        wrong, before = [], drawn_when_still(run)
        for latency, more in ((4, 3), (2, 0), (9, 5), (0, 0)):  # more: frames beyond the largest latency so far
            if result_of(context, run, "latency", str(latency)) != {"latency": latency}:
                wrong.append("no latency %d" % latency)
            frames = drawn_when_still(run)
            print("    latency %d: %d further frames" % (latency, frames - before))
            if frames - before != more:
                wrong.append("%d further frames instead of %d with latency %d" % (frames - before, more, latency))
            before = frames
        os.kill(stopped, signal.SIGCONT)
        deadline = time.monotonic() + PATIENCE_SECONDS
        while drawn(run) < before + 20 and time.monotonic() < deadline:
            time.sleep(0.05)
        wrong += [] if drawn(run) >= before + 20 else ["the program does not continue"]
        status, _, errors = ctl(context, str(run.process.pid), "latency", "65")
        wrong += [] if status == 1 and "0 to 64" in errors and errors.count("\n") == 1 else ["latency 65: %s" % errors]
        ctl(context, str(run.process.pid), "stop")
        return "; ".join(wrong) or cases.check_end(run, 0)


def exact_with_changes(context, display):
    """Changes the latency while the program compares each of its frames with its own GL."""
    with tempfile.TemporaryDirectory(prefix="mural-changes.") as folder:
        report, end_file = os.path.join(folder, "report.json"), os.path.join(folder, "end")
        command = [context.program("long_scene"), "--frames", "100000", "--size", SIZE]
        options = ["--tiles", "2x1", "--display", display, "--verify", "--report", report]
        with context.run(command, options, {"SCENE_MIB": "4", "END_FILE": end_file}) as run:
            if not run.wait_for_line("frame 5"):
                return "no frames: %s" % " | ".join(run.standard_error[-3:])
            for latency in (0, 3, 64, 1, 0, 2):
                if result_of(context, run, "latency", str(latency)) != {"latency": latency}:
                    return "no latency %d" % latency
                before, deadline = drawn(run), time.monotonic() + PATIENCE_SECONDS
                while drawn(run) < before + 8 and time.monotonic() < deadline:
                    time.sleep(0.02)
                if drawn(run) < before + 8:
                    return "no frames with latency %d" % latency
            session.end_after(end_file, 3)
            wrong = cases.check_end(run, 0)
        if wrong is not None:
            return wrong
        with open(report, encoding="utf-8") as file:
            numbers = json.load(file)
        print("    %d frames, %d pixels compared, %d differ" % (numbers["verifiedFrames"], numbers["verifiedPixels"], numbers["differingPixels"]))
        return None if numbers["verifiedFrames"] > 40 and numbers["differingPixels"] == 0 else "the pictures differ"


@cases.case
def latency_is_exact(context):
    """No pixel differs while the latency changes."""
    return exact_with_changes(context, "none")


@cases.case
def latency_with_windows(context):
    """The same with pictures in the program's own window, whose credit depends on latency 0."""
    return exact_with_changes(context, "app")


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
