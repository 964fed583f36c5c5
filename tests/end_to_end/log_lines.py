#!/usr/bin/env python3
"""Lines for the user and diagnostics (docs/reference/logging.md): MURAL_LOG selects topics and levels in all processes of
a session, and lines for the user arrive once, in their own form.

  log_lines.py --build build/release [--cases multicast] [--list]
"""

import os
import re
import stat
import sys

from harness import cases

case = cases.case
DIAGNOSTIC = re.compile(r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z (?P<role>[a-z]+(?: \d+)?)\[\d+\] (?P<topic>[a-z]+) (?P<level>debug|trace): (?P<text>.+)$")
FROM_HOST = re.compile(r"^mural: node \d+ \([^)]*\): ")  # lines of nodes that a launch command has started
BY_MULTICAST = ("--tiles", "2x1", "--display", "none", "--nodes", "localhost,localhost", "--stream", "rsp://239.255.77.9:4299?interface=127.0.0.1")
NO_MULTICAST = BY_MULTICAST[:-1] + ("rsp://239.255.77.9:4299?interface=nowhere0",)
REASON = "the stream is sent to each node over its own connection: no multicast"


def diagnostics(run):
    """Returns the matches of all diagnostics in the run's standard error."""
    return [match for match in (DIAGNOSTIC.match(FROM_HOST.sub("", line)) for line in run.standard_error) if match]


def others(run):
    return [line for line in run.standard_error if not DIAGNOSTIC.match(line) and not line.startswith("mural: ")]


def drawn(context, log, options=("--tiles", "2x1", "--display", "none"), status=0):
    """Draws a few frames with this MURAL_LOG. Returns the run, and the error of its end."""
    with context.drawing("long_run", 20, options=options, environment={"MURAL_LOG": log}) as run:
        return run, cases.check_end(run, status)


def missing(found, wanted):
    """Returns an error if a text of `wanted` (role, part of the text) is in no diagnostic."""
    for role, part in wanted:
        if not any(role == m["role"] and part in m["text"] for m in found):
            return "no diagnostic of %s with \"%s\" in:\n%s" % (role, part, "\n".join(m[0] for m in found[:40]))
    return None


@case
def multicast_diagnostics_alone(context):
    run, wrong = drawn(context, "rsp:debug", BY_MULTICAST)
    found = diagnostics(run)
    foreign = [m[0] for m in found if (m["topic"], m["level"]) != ("rsp", "debug")]
    return wrong or missing(found, [("head", "host of 239.255.77.9:4299"), ("head", "(node0) at 127.0.0.1 joined"), ("head", "(node1) at 127.0.0.1 joined"),
                                    ("head", "(node1) is gone"), ("node 0", "joins the group"), ("node 1", "joins the group")]) or (
        "other diagnostics: %s" % foreign if foreign else "other lines: %s" % others(run) if others(run) else None)


@case
def no_diagnostics_by_default(context):
    for log in (None, "", "info"):
        run, wrong = drawn(context, log, BY_MULTICAST)
        if wrong or diagnostics(run) or others(run):
            return "MURAL_LOG=%s: %s" % (log, wrong or run.standard_error)
    return None


@case
def all_topics(context):
    run, wrong = drawn(context, "debug")
    found = diagnostics(run)
    topics = {m["topic"] for m in found}
    lacking = {"session", "node", "program", "transport", "replay", "launch"} - topics
    return wrong or missing(found, [("run", "started "), ("head", "begins with 2 nodes"), ("head", "has connected"), ("node 0", "draws with"), ("node 1", "window "),
                                    ("head", "the session has ended")]) or (
        "no diagnostics of %s" % lacking if lacking else "other lines: %s" % others(run) if others(run) else None)


@case
def lines_for_the_user_once(context):
    """Diagnostics neither repeat nor change a line for the user."""
    for log, count in ((None, 1), ("debug", 1), ("stream:error", 0), ("off", 0)):
        run, wrong = drawn(context, log, NO_MULTICAST)
        lines = [line for line in run.standard_error if REASON in line and not DIAGNOSTIC.match(line)]
        if wrong or len(lines) != count or any(not line.startswith("mural: " + REASON) for line in lines):
            return "MURAL_LOG=%s: %s: %s" % (log, wrong, lines)
    return None


@case
def unknown_topic_is_an_error(context):
    run, wrong = drawn(context, "rps:debug", status=2)
    lines = run.standard_error
    if wrong or len(lines) != 1 or run.standard_output:
        return "%s: %s" % (wrong, lines)
    parts = ["mural: MURAL_LOG=rps:debug: ", "topic \"rps\"", "session", "rsp", "debug", "off"]
    return None if lines[0].startswith(parts[0]) and all(part in lines[0] for part in parts) else lines[0]


@case
def nodes_of_other_machines_have_the_levels_of_the_head(context):
    """The launch command passes no environment, as ssh."""
    folder = os.path.join(context.build, "tests")
    launch = os.path.join(folder, "log_lines_launch")
    with open(launch, "w", encoding="ascii") as script:
        script.write("#!/bin/sh\nshift\nunset MURAL_LOG\nexec \"$@\"\n")
    os.chmod(launch, stat.S_IRWXU)
    try:
        run, wrong = drawn(context, "node:debug", ("--tiles", "1x1", "--display", "none", "--nodes", "127.0.0.2", "--launch", launch))
        return wrong or missing(diagnostics(run), [("head", "is ready"), ("node 0", "draws with")])
    finally:
        os.remove(launch)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
