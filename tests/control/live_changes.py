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
STILL_SECONDS = 0.6  # a program that waits draws nothing for this time; otherwise it draws a frame in about 10 ms


def drawn(run):
    return sum(line.startswith("frame ") for line in run.standard_output)


def draws_further(run, count):
    """Returns whether the program draws that number of further frames in time."""
    wanted, deadline = drawn(run) + count, time.monotonic() + PATIENCE_SECONDS
    while drawn(run) < wanted and time.monotonic() < deadline:
        time.sleep(0.02)
    return drawn(run) >= wanted


def finished(context, run):
    """Returns the number of frames that all nodes have finished, or None."""
    listed = result_of(context, run, "status").get("programs")
    return listed[0]["frames"] if listed else None


def fault_of_wait(context, run, ahead):
    """Waits until the program is that number of frames ahead of the nodes, and stands still; returns an error, or None.

    The head may count the last frames of a stopped node late. The difference does not depend on that.
    """
    deadline, still, since = time.monotonic() + PATIENCE_SECONDS, None, 0.0
    frames = done = None
    while time.monotonic() < deadline and run.process.poll() is None:
        frames = drawn(run)  # before the finished ones, whose number may grow meanwhile
        done = finished(context, run)
        if done is not None and frames - done > ahead:
            break
        if done is None or frames - done < ahead:
            still = None
        elif still != (frames, done):
            still, since = (frames, done), time.monotonic()
        elif time.monotonic() - since > STILL_SECONDS:
            return None
        time.sleep(0.05)
    return "%s frames drawn, %s finished, instead of %d ahead" % (frames, done, ahead)


@cases.case
def latency_of_a_waiting_program(context):
    """While a node stands still, the program draws exactly as many frames as a larger latency permits."""
    command = [context.program("long_run"), "--frames", "1000000", "--size", SIZE]
    with context.run(command, ["--tiles", "2x1", "--display", "none", "--latency", "1"]) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        stopped = run.wait_for_processes(cases.NODE, 2)[0]
        wrong = []
        for before, after in ((1, 4), (4, 2), (2, 9), (9, 0), (0, 3)):
            # The program waits in the swap of the frame after those that the latency permits. It has drawn that frame.
            began = time.monotonic()
            os.kill(stopped, signal.SIGSTOP)
            fault = fault_of_wait(context, run, before + 1)
            if fault is None and result_of(context, run, "latency", str(after)) != {"latency": after}:
                fault = "no such latency"
            fault = fault or fault_of_wait(context, run, max(before, after) + 1)
            # The stops are short, because the head gives up a node after 20 s.
            try:
                os.kill(stopped, signal.SIGCONT)
            except ProcessLookupError:
                fault = fault or "the head gave up the node"
            print("    latency %d, then %d: the node stood still for %.1f s" % (before, after, time.monotonic() - began))
            if fault is None and not draws_further(run, 20):  # more than the node had to catch up
                fault = "the program does not continue"
            if fault is not None:
                wrong.append("latency %d, then %d: %s" % (before, after, fault))
                break
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
                if not draws_further(run, 8):
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
