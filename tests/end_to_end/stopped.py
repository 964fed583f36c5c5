#!/usr/bin/env python3
"""Processes that are stopped for a while, and programs that hold a grab of the X server.

  stopped.py --build build/release --cases program,head,grabs [--list]

A stop lasts much longer than a healthy process takes to reply, and less than a test may take. Unit tests with simulated
clocks cover limits of 20 s and more (running_time_test, head_session_test).
"""

import os
import re
import signal
import subprocess
import sys
import time

from harness import cases, length, programs

STOP_SECONDS = 1
STOPS = 2 if length.LONG else 1
LAYOUT = ("--tiles", "2x1", "--display", "none")


def pids_of(run, pattern):
    return run.wait_for_processes(pattern, 1)


def stop_for_a_while(pids, seconds=STOP_SECONDS):
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)
    time.sleep(seconds)
    for pid in pids:
        os.kill(pid, signal.SIGCONT)


def what_it_read(run, wanted_status=0):
    """Returns the program's own counts, or an error text after an unexpected end."""
    status = run.status()
    counts = [re.match(r"reads (\d+) differ (\d+) errors (\d+)", line) for line in run.standard_output]
    counts = [[int(number) for number in found.groups()] for found in counts if found]
    if status != wanted_status or not counts:
        return "status %s, it printed %s; Mural printed: %s" % (status, run.standard_output[-2:], " | ".join(run.standard_error[-4:]))
    return counts[0]


def reads_through_stops(context, kind, pattern, stops=STOPS):
    """Checks that all reads are correct, no message is printed, and the program stays on the wall to its end."""
    with context.run([context.program("stopped_reads"), kind, str(2 + stops * STOP_SECONDS)], LAYOUT) as run:
        if not run.wait_for_line("begins"):
            return "it did not begin: " + " | ".join(run.standard_error[-3:])
        pids = pids_of(run, pattern)
        if not pids:
            return "no process fits " + pattern
        for number in range(stops):
            time.sleep(0.31 + 0.07 * number)  # wherever that is
            stop_for_a_while(pids)
        counts = what_it_read(run)
        if isinstance(counts, str):
            return counts
        if counts[0] < 2 or counts[1] or counts[2]:
            return "%d reads, %d differ, %d errors" % tuple(counts)
        output = [line for line in run.standard_error if "alone" in line or "dropped" in line or "lost" in line]
        return "it was lost: " + " | ".join(output) if output else None


PROGRAM_ALONE = r"^\S*stopped_reads \w+ \d+$"


@cases.case
def program_pixels(context):
    return reads_through_stops(context, "pixels", PROGRAM_ALONE)


@cases.case
def program_buffer(context):
    return reads_through_stops(context, "buffer", PROGRAM_ALONE, stops=1)


@cases.case
def program_texture(context):
    return reads_through_stops(context, "texture", PROGRAM_ALONE, stops=1)


@cases.case
def program_query(context):
    return reads_through_stops(context, "query", PROGRAM_ALONE, stops=1)


@cases.case
def program_swaps(context):
    return reads_through_stops(context, "swaps", PROGRAM_ALONE, stops=1)


@cases.case
def head_pixels(context):
    return reads_through_stops(context, "pixels", r"mural head\b")


@cases.case
def all_of_it(context):
    """Ctrl-Z and fg: stops and continues the program, its launcher, the head and the nodes."""
    return reads_through_stops(context, "pixels", r".")


@cases.case
def program_killed_while_stopped(context):
    with context.run([context.program("stopped_reads"), "pixels", "60"], LAYOUT) as run:
        if not run.wait_for_line("begins"):
            return "it did not begin"
        pids = pids_of(run, PROGRAM_ALONE)
        time.sleep(0.4)
        for pid in pids:
            os.kill(pid, signal.SIGSTOP)
        time.sleep(0.5)
        began = time.monotonic()
        for pid in pids:
            os.kill(pid, signal.SIGKILL)
        status = run.status()
        if status != 128 + signal.SIGKILL or time.monotonic() - began > 15:
            return "status %s after %.0f s" % (status, time.monotonic() - began)
        left = run.left_behind()
        return "left over: " + ", ".join(left) if left else None


def head_killed(context, kind):
    """A read during which the head is killed is correct or raises an error. It never returns only wrong pixels."""
    with context.run([context.program("stopped_reads"), kind, "3"], LAYOUT) as run:
        if not run.wait_for_line("begins"):
            return "it did not begin"
        time.sleep(0.5)
        for pid in pids_of(run, r"mural head\b"):
            os.kill(pid, signal.SIGKILL)
        counts = what_it_read(run)
        if isinstance(counts, str):
            return counts
        return "%d of %d reads are wrong without an error" % (counts[1], counts[0]) if counts[1] else None


@cases.case
def head_killed_pixels(context):
    return head_killed(context, "pixels")


@cases.case
def head_killed_buffer(context):
    return head_killed(context, "buffer")


# ---- grabs

def sums(text):
    return [line for line in text.splitlines() if re.search(r" [0-9a-f]{8}$", line)]


def natively(context, way):
    run = subprocess.run([context.program("grabbed_server"), way], env=programs.clean_environment(context.display), capture_output=True,
                         text=True, timeout=60, check=False)
    return sums(run.stdout) if run.returncode == 0 else "natively: status %d, %s" % (run.returncode, run.stderr[-200:])


def grabbed(context, ways):
    """Compares what the program sees in each way. All ways share a session, whose start takes longer than they do."""
    # Another connection's grab holds up the program's own GL natively, so these are compared with the first way.
    wanted = [natively(context, "xlib" if way in ("second", "closed") else way) for way in ways]
    wrong = next((text for text in wanted if isinstance(text, str)), None)
    if wrong is not None:
        return wrong
    shell = 'program=$1; shift; for way; do "$program" $way || exit 1; echo "end of $way"; done'
    command = ["sh", "-c", shell, "sh", context.program("grabbed_server")] + list(ways)
    with context.run(command, options=("--tiles", "2x1", "--display", "app")) as run:
        if run.status() != 0:
            return "it failed after \"%s\": %s" % (" ".join(run.standard_output[-1:]), " | ".join(run.standard_error[-3:]))
        printed = "\n".join(run.standard_output)
        for way, pixels in zip(ways, wanted):
            text, printed = printed.split("end of %s" % way, 1)
            if sums(text) != pixels:
                return "%s: it saw %s instead of %s" % (way, sums(text), pixels)
        took = [float(found.group(1)) for found in map(lambda line: re.search(r"grabbed for ([\d.]+) s", line), run.standard_error) if found]
        if len(took) != len(ways) or max(took) > 10:  # a picture that waits for the head takes 5 s, each
            return "the grabs lasted %s s" % took
        output = [line for line in run.standard_error if "does not answer" in line]
        return "it printed: " + output[0] if output else None


def grabs(name, *ways):
    cases.CASES["grabs_" + name] = lambda context: grabbed(context, ways)


for group in (("xlib", "nested", "second", "front", "large", "thread", "egl"), ("early", "xcb", "checked", "closed", "two", "opened", "copy")):
    if length.LONG:
        for only in group:
            grabs(only, only)
    else:
        grabs("%s_and_others" % group[0], *group)


@cases.case
def grabs_of_another_program(context):
    """The pictures and the program's reads wait for the end of the grab. The program still reads each of its frames."""
    wanted = natively(context, "without")
    with context.run([context.program("grabbed_server"), "without"], options=("--tiles", "2x1", "--display", "app")) as run:
        if not run.wait_for_line("without a grab"):
            return "it did not begin: " + " | ".join(run.standard_error[-3:])
        time.sleep(0.3)
        subprocess.run([context.program("grabbed_server"), "hold"], env=programs.clean_environment(context.display), timeout=60, check=True)
        status = run.status()
        got = sums("\n".join(run.standard_output))
        return None if status == 0 and got == wanted else "status %s, it saw %s instead of %s" % (status, got, wanted)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
