#!/usr/bin/env python3
"""Counts how often a program waits for a reply of the nodes: never when it reads nothing, and not for results that it
reads a frame later.

  round_trips.py --build build/release [--cases draws_only,queries_later] [--list]
"""

import json
import os
import sys
import tempfile

from harness import cases

FRAMES = 30


def round_trips(case_name, program, at_most, options=()):
    def check(context):
        with tempfile.TemporaryDirectory(prefix="mural-round-trips.") as folder:
            report_file = os.path.join(folder, "report.json")
            command = [context.program(program), "--frames", str(FRAMES), "--size", "253x191"]
            with context.run(command, ["--tiles", "2x2", "--display", "none", "--quiet", "--report", report_file, *options]) as run:
                wrong = cases.check_end(run, 0)
                if wrong is not None:
                    return wrong
            with open(report_file, encoding="utf-8") as file:
                report = json.load(file)
        if report["frames"] < FRAMES:
            return "%d frames instead of %d" % (report["frames"], FRAMES)
        if report["roundTrips"] > at_most:
            return "%d round trips instead of %d at most in %d frames" % (report["roundTrips"], at_most, FRAMES)
        return None
    check.__name__ = case_name
    cases.case(check)


for name in ("immediate", "client_arrays", "core_arrays", "persistent_mapping", "glsl_uniforms", "glsl_blocks", "arb_programs",
             "attribute_stacks", "evaluators", "clipping", "fixed_lighting", "many_triangles", "shared_contexts"):
    round_trips("draws_only_" + name, name, 0)
# Results of the first two frames, before the library knows that they are read later: six each.
round_trips("queries_later", "queries_later", 12)
# Reads into pixel buffers that are mapped two frames later. On a busy machine some replies are late, but not all.
round_trips("reads_later", "reads_later", 20)

if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
