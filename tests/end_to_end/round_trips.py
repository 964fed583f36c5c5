#!/usr/bin/env python3
"""Counts how often a program waits for a reply of the nodes: never when it reads nothing, and not for results that it
reads a frame later.

  round_trips.py --build build/release [--cases draws_only,queries_later] [--list]
"""

import json
import os
import shlex
import sys
import tempfile

from harness import cases

FRAMES = 30


def wrong_round_trips(context, programs, at_most):
    """Draws the programs in one session, and checks the number of waits in all."""
    with tempfile.TemporaryDirectory(prefix="mural-round-trips.") as folder:
        report_file = os.path.join(folder, "report.json")
        commands = [[context.program(program), "--frames", str(FRAMES), "--size", "253x191"] for program in programs]
        command = commands[0] if len(commands) == 1 else ["sh", "-c", " && ".join(map(shlex.join, commands))]
        with context.run(command, ["--tiles", "2x1", "--display", "none", "--quiet", "--report", report_file]) as run:
            wrong = cases.check_end(run, 0)
            if wrong is not None:
                return wrong
        with open(report_file, encoding="utf-8") as file:
            report = json.load(file)
    frames = FRAMES * len(programs)
    if report["frames"] < frames:
        return "%d frames instead of %d" % (report["frames"], frames)
    if report["roundTrips"] > at_most:
        return "%d round trips instead of %d at most in %d frames" % (report["roundTrips"], at_most, frames)
    return None


def round_trips(case_name, program, at_most, register=cases.case):
    def check(context):
        return wrong_round_trips(context, [program], at_most)
    check.__name__ = case_name
    register(check)


DRAWS_ONLY = ("immediate", "client_arrays", "core_arrays", "persistent_mapping", "glsl_uniforms", "glsl_blocks", "arb_programs",
              "attribute_stacks", "evaluators", "clipping", "fixed_lighting", "many_triangles", "shared_contexts")


@cases.case
def programs_that_read_nothing(context):
    """Nodes start once for all of them. Each alone: cases draws_only_*."""
    return wrong_round_trips(context, DRAWS_ONLY, 0)


for name in DRAWS_ONLY:
    round_trips("draws_only_" + name, name, 0, cases.long_case)
# Results of the first two frames, before the library knows that they are read later: six each.
round_trips("queries_later", "queries_later", 12)
# Reads into pixel buffers that are mapped two frames later. On a busy machine some replies are late, but not all.
round_trips("reads_later", "reads_later", 20)

if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
