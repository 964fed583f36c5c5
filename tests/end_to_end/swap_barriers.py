#!/usr/bin/env python3
"""Windows of several nodes that show each frame together (swap barriers).

  swap_barriers.py --build build/release [--cases short_form,over_tcp,files,leader,member] [--list]
"""

import json
import os
import re
import signal
import sys
import tempfile

from harness import cases, length

FRAMES = 120 if length.LONG else 40
FILE = """#Equalizer 1.2 ascii
server { config {
  appNode { pipe {
    window { viewport [ 0 0 200 160 ] channel { name "left" } }
    window { viewport [ 200 0 200 160 ] channel { name "right" } } } }
  observer {}
  layout { name "simple" view { observer 0 } }
  canvas { layout "simple" wall { bottom_left [ -.8 -.4 -1 ] bottom_right [ .8 -.4 -1 ] top_left [ -.8 .4 -1 ] }
    %s
    segment { channel "left" viewport [ 0 0 .5 1 ] }
    segment { channel "right" viewport [ .5 0 .5 1 ] } }
  compound { compound { channel ( segment 0 view 0 ) } compound { channel ( segment 1 view 0 ) } }
} }
"""


def swapped_together(context, options, folder):
    """Returns (explain lines of barriers, the reported numbers or None, error)."""
    report_file = os.path.join(folder, "report.json")
    command = [context.program("long_run"), "--frames", str(FRAMES), "--size", "400x160"]
    with context.run(command, options + ["--display", "windows", "--explain", "--report", report_file]) as run:
        wrong = cases.check_end(run, 0)
        lines = [line for line in run.standard_error if "swap barrier" in line]
    with open(report_file, encoding="utf-8") as file:
        nodes = json.load(file)["nodes"]
    barriers = [n["swapBarrier"] for n in nodes if n["swapBarrier"]]
    return lines, barriers[0] if len(barriers) == 1 else None, wrong


def wrong_numbers(numbers, members):
    if numbers is None:
        return "not one barrier was reported"
    if numbers["members"] != members or not FRAMES - 3 <= numbers["swaps"] <= FRAMES:
        return "%d members and about %d swaps were wanted: %s" % (members, FRAMES, numbers)
    in_order = 0 <= numbers["medianNs"] <= numbers["p99Ns"] <= numbers["maxNs"] and numbers["clockErrorNs"] > 0
    return None if in_order else "these are no times: %s" % numbers


@cases.case
def short_form(context):
    """--tiles: windows of all nodes; the report has the times."""
    for tiles, members in (("3x1", 3), ("2x2", 4)):
        with tempfile.TemporaryDirectory(prefix="mural-swap.") as folder:
            lines, numbers, wrong = swapped_together(context, ["--tiles", tiles], folder)
        wrong = wrong or wrong_numbers(numbers, members)
        if wrong:
            return "%s: %s" % (tiles, wrong)
        print("  %s: within %.2f ms (median), %.2f ms (99 %%)" % (tiles, numbers["medianNs"] / 1e6, numbers["p99Ns"] / 1e6))
        if not any("windows of %d nodes" % members in line for line in lines) or not any("ms of each other" in line for line in lines):
            return "%s: output: %s" % (tiles, lines)
    return None


@cases.case
def over_tcp(context):
    """Nodes connected by TCP."""
    with tempfile.TemporaryDirectory(prefix="mural-swap.") as folder:
        _, numbers, wrong = swapped_together(context, ["--tiles", "2x1", "--nodes", "localhost,localhost"], folder)
    return wrong or wrong_numbers(numbers, 2)


@cases.case
def files_name_barriers(context):
    """A file's canvas with a swap barrier, and without."""
    for barrier, members in (("swapbarrier { name \"front\" }", 2), ("", 0)):
        with tempfile.TemporaryDirectory(prefix="mural-swap.") as folder:
            path = os.path.join(folder, "wall.eqc")
            with open(path, "w", encoding="utf-8") as file:
                file.write(FILE % barrier)
            lines, numbers, wrong = swapped_together(context, ["--config", path, "--all-local"], folder)
        wrong = wrong or (wrong_numbers(numbers, members) if members else None)
        if wrong:
            return "%s: %s" % (barrier or "without", wrong)
        if not members and (lines or numbers):
            return "no barrier was wanted: %s, %s" % (lines, numbers)
        if members and not any('swap barrier "front"' in line for line in lines):
            return "output: %s" % lines
    return None


def lost(context, which, words):
    with context.run([context.program("long_run"), "--frames", "1000000", "--size", "400x160"], ["--tiles", "3x1", "--display", "windows"]) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        nodes = sorted(run.processes(cases.NODE))
        if len(nodes) != 3:
            return "%d nodes instead of 3" % len(nodes)
        os.kill(nodes[which], signal.SIGKILL)
        if not run.wait_for_line(words):
            return "no message with \"%s\": %s" % (words, " | ".join(run.standard_error[-5:]))
        frame = max(int(n) for n in re.findall(r"frame (\d+)", " ".join(run.standard_output + run.standard_error)))
        if not run.wait_for_line("frame %d" % (frame + 60)):
            return "no frames after a node had been killed"
    return None


@cases.case
def leader_lost(context):
    """The leading node is killed: the others show their frames on their own."""
    return lost(context, 0, "its leader is lost")


@cases.case
def member_lost(context):
    """Another node is killed: the rest continues together."""
    return lost(context, 2, "the others swap without it")


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
