#!/usr/bin/env python3
"""`mural stat`: its output for a running session, and the commands that the report names for round trips.

mural_stat.py --build build/release [--cases running,trips,none] [--list]
"""

import json
import os
import signal
import subprocess
import sys
import tempfile

from harness import cases

PATIENCE_SECONDS = 60


def stat(context, *options):
    return subprocess.run([context.mural, "stat", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=PATIENCE_SECONDS, check=False)


def own_session(context, run):
    """Returns the output of `mural stat --json` for this run; None if the run is missing."""
    shown = stat(context, "--json")
    if shown.returncode != 0:
        return None
    return next((s for s in json.loads(shown.stdout)["sessions"] if s["runPid"] == run.process.pid), None)


@cases.case
def running_session(context):
    """Runs a program that draws on two nodes."""
    with context.run([context.program("long_run"), "--frames", "1000000", "--size", "250x190"], ["--tiles", "2x1", "--display", "none"]) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        session = own_session(context, run)
        if session is None or len(session["programs"]) != 1 or len(session["nodes"]) != 2:
            return "shown is %s" % session
        program = session["programs"][0]
        wrong = [name for name in ("frames", "calls", "bytes") if program[name] < 50]
        wrong += [name for name in ("framesPerSecond", "callsPerFrame", "bytesPerFrame") if program["recent"][name] <= 0]
        wrong += ["roundTrips"] if program["roundTrips"] != 0 or program["recent"]["roundTripsPerFrame"] != 0 else []
        wrong += ["command"] if "long_run --frames" not in program["command"] else []
        wrong += ["pid"] if program["pid"] not in run.processes(r"long_run") else []
        wrong += ["node"] if any(n["state"] != "alive" or n["frames"] < 50 or n["pid"] not in run.processes(cases.NODE) for n in session["nodes"]) else []
        text = stat(context).stdout.decode()
        wrong += ["text"] if "session %d " % run.process.pid not in text or "0.00 round trips per frame" not in text else []
        return "wrong are %s in %s\n%s" % (", ".join(wrong), session, text) if wrong else None


@cases.case
def who_is_waited_for(context):
    """A stopped node is named as the one for which the program waits."""
    with context.run([context.program("long_run"), "--frames", "1000000", "--size", "250x190"], ["--tiles", "3x1", "--display", "none"]) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        stopped = next(n for n in own_session(context, run)["nodes"] if n["node"] == 1)
        os.kill(stopped["pid"], signal.SIGSTOP)
        session = own_session(context, run)
        text = stat(context).stdout.decode()
        os.kill(stopped["pid"], signal.SIGCONT)
        waited = session["programs"][0]["waitsForNodes"]
        return None if waited == [1] and "now for node 1" in text else "waited for is %s\n%s" % (waited, text)


@cases.case
def trips_are_named(context):
    """The report names round trips by command, with the correct sum."""
    with tempfile.TemporaryDirectory(prefix="mural-stat.") as folder:
        for program, wanted in (("pixels_read", "glReadPixels"), ("queries", "glGetQueryObjectuiv"), ("framebuffers", None), ("immediate", "")):
            report_file = os.path.join(folder, program + ".json")
            with context.run([context.program(program), "--frames", "3"], ["--tiles", "2x2", "--display", "none", "--report", report_file]) as run:
                wrong = cases.check_end(run, 0)
                output = " ".join(run.standard_error)
            if wrong is not None:
                return "%s: %s" % (program, wrong)
            with open(report_file, encoding="utf-8") as file:
                report = json.load(file)
            by = report["roundTripsBy"]
            if sum(by.values()) != report["roundTrips"] or any(not name.startswith("gl") for name in by):
                return "%s: %d round trips, by %s" % (program, report["roundTrips"], by)
            if wanted == "" and (by or "0 round trips" not in output):
                return "%s: round trips without need: %s; output: %s" % (program, by, output)
            if wanted and (by.get(wanted, 0) < 1 or wanted not in output):
                return "%s: no %s in %s; output: %s" % (program, wanted, by, output)
    return None


@cases.case
def none_of_this_user(context):
    """A user without sessions receives a message. Not tested as root, because sessions of other tests may run."""
    shown = stat(context)
    if shown.returncode == 0:
        return None if shown.stdout else "nothing shown, status 0"
    output = shown.stderr.decode()
    return None if shown.returncode == 1 and output.count("\n") == 1 and output.startswith("mural stat: ") else "status %d, output: %s" % (shown.returncode, output)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
