#!/usr/bin/env python3
"""Statistics of frames: the timeline, the stages and the metrics of a running session, also after the loss of a node.

frame_statistics.py --build build/release [--cases trace,metrics] [--list]
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, frame_trace  # noqa: E402

PATIENCE_SECONDS = 60
MAX_ERROR_NS, MAX_DRIFT_NS = 20_000_000, 5_000_000  # on a machine whose cores are all busy
PROGRAM = ["--frames", "1000000", "--size", "250x190"]


def stat(context, run, *options, seconds=PATIENCE_SECONDS):
    return subprocess.run([context.mural, "stat", str(run.process.pid), *options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=seconds, check=False)


def output_until(command, patterns):
    """Runs a command that has no end until its output matches all patterns, or patience ends; returns the output."""
    output = ""
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        patience = threading.Timer(PATIENCE_SECONDS, process.kill)
        patience.start()
        for line in process.stdout:
            output += line
            if all(re.search(pattern, output) for pattern in patterns):
                break
        patience.cancel()
        process.kill()
    return output


def faults_of_trace(context, options, nodes, environment=None, frames=60):
    """Runs a program and returns the faults of its trace."""
    with context.run([context.program("long_run")] + PROGRAM, options, environment) as run:
        if not run.wait_for_line("frame 20"):
            return ["no frames: %s" % " | ".join(run.standard_error[-3:])]
        return trace_of(context, run, nodes, frames)


def trace_of(context, run, nodes, frames, clocks=None):
    with tempfile.TemporaryDirectory(prefix="mural-trace.") as folder:
        path = os.path.join(folder, "trace.json")
        shown = stat(context, run, "--trace", path, "--frames", str(frames))
        if shown.returncode != 0 or "%d frames in" % frames not in shown.stdout:
            return ["status %d: %s" % (shown.returncode, shown.stdout)]
        trace = frame_trace.Trace(path)
    if clocks is not None:
        clocks += trace.json["otherData"]["clocks"]
    found = frame_trace.faults(trace, nodes)
    if len(trace.done) < frames * 9 // 10:
        found.append("only %d frames end" % len(trace.done))
    if trace.program() is None or not trace.named("stream") or len(trace.named("reader")) != nodes:
        found.append("threads are %s" % sorted(trace.threads))
    return found


def first(found):
    return "%d faults: %s" % (len(found), "; ".join(found[:4])) if found else None


@cases.case
def trace_without_pictures(context):
    return first(faults_of_trace(context, ["--tiles", "3x1", "--display", "none"], 3))


@cases.case
def trace_with_pictures(context):
    return first(faults_of_trace(context, ["--tiles", "2x2", "--display", "app"], 4))


@cases.case
def trace_of_ranges(context):
    return first(faults_of_trace(context, ["--db", "2", "--display", "none"], 2))


@cases.case
def trace_over_tcp(context):
    """The head estimates the clocks of these nodes. They are on this machine, so the true offset is 0."""
    with context.run([context.program("long_run")] + PROGRAM, ["--tiles", "2x1", "--nodes", "127.0.0.1,127.0.0.1", "--display", "none"]) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        clocks = []
        found = trace_of(context, run, 2, 60, clocks)
    wrong = [clock for clock in clocks if abs(clock["offsetNs"]) > clock["errorNs"] + MAX_DRIFT_NS or clock["errorNs"] > MAX_ERROR_NS]
    return "clocks are %s" % clocks if wrong or len(clocks) != 2 else first(found)


@cases.case
def trace_with_late_clock(context):
    """A planted fault: the spans of one node lie one second late. The checks must find it."""
    found = faults_of_trace(context, ["--tiles", "2x1", "--display", "none"], 2, {"MURAL_PLANT": "spans"})
    return None if any("after the frame" in fault for fault in found) else "found is %s" % found[:3]


@cases.case
def trace_after_a_loss(context):
    """A restarted node has statistics again, while a client requests them."""
    with context.run([context.program("long_run")] + PROGRAM, ["--tiles", "2x1", "--display", "none"]) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        before = trace_of(context, run, 2, 20)
        if before:
            return first(before)
        os.kill(run.processes(cases.NODE)[1], signal.SIGKILL)
        if not run.wait_for_line("rejoined"):
            return "the node did not rejoin: %s" % " | ".join(run.standard_error[-3:])
        time.sleep(1.0)
        with tempfile.TemporaryDirectory(prefix="mural-trace.") as folder:
            path = os.path.join(folder, "trace.json")
            shown = stat(context, run, "--trace", path, "--frames", "600", seconds=3 * PATIENCE_SECONDS)
            if shown.returncode != 0:
                return shown.stdout
            trace = frame_trace.Trace(path)
        last = max(trace.done)
        missing = [node for node in range(2) if not trace.thread("node %d" % node, "replay").of_frame(last)]
        return "frame %d has no spans of nodes %s" % (last, missing) if missing else None


@cases.case
def stages_and_metrics(context):
    stages = (r"slowest stage: \w+ on (node [01]|head|program)", r"node 1 +[0-9.]+ +[0-9.]+")
    metrics = (r'mural_node_up\{session="[^"]+",node="1"\} 1\n', r'mural_frame_seconds\{[^}]*\} [0-9.e-]+\n',
               r'mural_stage_seconds\{[^}]*process="node",node="0",stage="replay"\} [0-9.e-]+\n', r"# TYPE mural_frames_total counter\n")
    with context.run([context.program("long_run")] + PROGRAM, ["--tiles", "2x1", "--display", "none"]) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        watched = output_until([context.mural, "stat", str(run.process.pid), "--watch", "0.5"], stages)
        deadline = time.monotonic() + PATIENCE_SECONDS
        text = stat(context, run, "--prometheus").stdout
        while not all(re.search(wanted, text) for wanted in metrics) and time.monotonic() < deadline:
            text = stat(context, run, "--prometheus").stdout  # a slow program finishes no frame in the second of a report
    wrong = [wanted for wanted in stages if not re.search(wanted, watched)]
    wrong += [wanted for wanted in metrics if not re.search(wanted, text)]
    return "missing are %s in\n%s\n%s" % (wrong, watched, text) if wrong else None


@cases.case
def no_such_session(context):
    shown = subprocess.run([context.mural, "stat", "1", "--trace", "/dev/null"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=PATIENCE_SECONDS, check=False)
    right = shown.returncode == 1 and shown.stderr.startswith("mural stat: no session \"1\"") and shown.stderr.count("\n") == 1
    return None if right else "status %d: %s" % (shown.returncode, shown.stderr)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
