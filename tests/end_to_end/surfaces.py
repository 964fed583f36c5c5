#!/usr/bin/env python3
"""Surfaces of programs: the contents of new ones, the surfaces that a swap shows, and drawing while the program ends.

The programs (tests/programs/surfaces) print the pixels that they read from OpenGL and from the X server. Each runs
natively and through Mural, with --verify and with --display app: the lines, the status and the number of compared
frames must be correct.

  surfaces.py --build build/release [--cases fresh] [--list]
"""

import json
import os
import shlex
import subprocess
import sys
import tempfile

from harness import cases, length, programs

MODES = {"verify": ["--verify"], "app": ["--display", "app"]}
SIZE = "253x191"
# glibc fills new memory of nodes with a pattern, which makes missing clears visible. New memory of programs holds 0, because
# Mesa's EGL does not clear the surfaces of windows.
OF_NODES = {"MALLOC_PERTURB_": "165"}
OF_PROGRAMS = {"MALLOC_PERTURB_": "255"}


def natively(context, program, wanted_status, environment):
    """Returns the printed lines, or None after a wrong exit status.

    OpenGL after the end of main() works natively only if Mesa compiles no shader then. After another attempt its disk
    cache contains the shaders."""
    for _ in range(4):
        run = subprocess.run([context.program(program), "--size", SIZE], env={**programs.clean_environment(context.display), **environment}, stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False)
        if run.returncode == wanted_status:
            return run.stdout.decode(errors="replace").splitlines()
    return None


def difference(wanted, got):
    """Returns the first line that differs."""
    for number, line in enumerate(wanted):
        if number >= len(got) or got[number] != line:
            return "it printed \"%s\" instead of \"%s\"" % (got[number] if number < len(got) else "nothing", line)
    return "it printed \"%s\" besides" % got[len(wanted)] if len(got) > len(wanted) else None


class Program:
    """A program, and its expected results: status, frames on the wall, and frames that --verify cannot compare, by
    reason."""

    def __init__(self, name, frames, status=0, uncompared=None, environment=None):
        self.name, self.frames, self.status = name, frames, status
        self.uncompared, self.environment = uncompared or {}, environment or {}

    def command(self, context):
        settings = "".join("%s=%s " % item for item in self.environment.items())
        return '%s%s --size %s; echo "%s: status $?"' % (settings, shlex.quote(context.program(self.name)), SIZE, self.name)


def report_is_wrong(report, mode, group):
    frames = sum(program.frames for program in group)
    if report["frames"] < frames:
        return "%d frames are on the wall instead of %d" % (report["frames"], frames)
    if mode != "verify":
        return None
    if report["differingPixels"] != 0 or report["verifiedFrames"] == 0:
        return "%d pixels of %d frames differ" % (report["differingPixels"], report["verifiedFrames"])
    reasons = {}
    for program in group:
        for reason, count in program.uncompared.items():
            reasons[reason] = reasons.get(reason, 0) + count
    if report["uncomparedFramesBy"] != reasons or report["uncomparedFrames"] != sum(reasons.values()):
        return "frames that were not compared: %s" % report["uncomparedFramesBy"]
    return None


def through_mural(context, group, mode, wanted, layout):
    """Runs the programs one after the other. They share a session, whose start takes longer than a program."""
    with tempfile.TemporaryDirectory(prefix="mural-surfaces.") as folder:
        report_file = os.path.join(folder, "report.json")
        options = ["--tiles", layout, "--quiet", "--report", report_file] + MODES[mode]
        command = ["sh", "-c", "; ".join(program.command(context) for program in group)]
        with context.run(command, options, OF_NODES) as run:
            wrong = cases.check_end(run, 0) or difference(wanted, run.standard_output)
            if wrong is not None:
                return "%s: %s" % (mode, wrong)
        with open(report_file, encoding="utf-8") as file:
            wrong = report_is_wrong(json.load(file), mode, group)
    return "%s: %s" % (mode, wrong) if wrong else None


def surfaces(name, layout, *group):
    """Adds a case for these programs; in a long run one for each of them."""
    if length.LONG and len(group) > 1:
        for program in group:
            surfaces(program.name, "2x2", program)
        return

    def check(context):
        wanted = []
        for program in group:
            lines = natively(context, program.name, program.status, program.environment)
            if lines is None:
                return "%s fails natively" % program.name
            wanted += lines + ["%s: status %d" % (program.name, program.status)]
        for mode in MODES:
            wrong = through_mural(context, group, mode, wanted, layout)
            if wrong is not None:
                return wrong
        return None
    check.__name__ = name
    cases.case(check)


surfaces("fresh_ones", "2x2",
         Program("fresh_drawables", 38, uncompared={"window size unknown": 8}, environment=OF_PROGRAMS),
         Program("fresh_objects", 1),
         Program("egl_surfaces", 8, uncompared={"window size unknown": 2}, environment=OF_PROGRAMS))
surfaces("swaps_and_ends", "2x1",
         Program("swaps_elsewhere", 11, uncompared={"front buffer": 1}),
         Program("at_exit_glx", 9, status=9),
         Program("at_exit_egl", 9, status=9),
         Program("at_exit_es", 9, status=9, uncompared={"own picture not readable": 6}))

if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
