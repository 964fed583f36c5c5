#!/usr/bin/env python3
"""Effects of loaders: GL libraries unloaded and loaded again, environments cleared, programs that execute others, hooks
of other preloaded libraries, sandboxes with their own namespaces. Each program prints the pixels that it reads;
natively they must be equal.

  loaders.py --build build/release [--cases reloaded,executed,hooked,sandboxed] [--list]
"""

import glob
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile

from harness import cases, length, processes, session

SOCKETS = ("/tmp", os.environ.get("XDG_RUNTIME_DIR") or "/tmp")


def sockets_of(run):
    """Returns the folders of the run's session; other sessions may have theirs at the same time."""
    return [path for place in set(SOCKETS) for path in glob.glob("%s/mural-%d-*" % (place, run.process.pid))]


def compared(context, command, frames, options=(), output=(), through=None):
    """Compares the command's output natively and through Mural (where it may differ: `through`). Returns None if they
    agree, `frames` are on the wall with equal pixels, and standard error has exactly one line for each of the words
    of `output`."""
    with session.Session(command, context.display) as native:
        status = native.status()
        wanted = list(native.standard_output)
    statuses = [status] + [int(line.split()[-1]) for line in wanted if ": status " in line]
    if not set(statuses) <= {0, 6} or not wanted:
        return "natively status %s: %s" % (statuses, " | ".join(native.standard_error[-3:]))
    with tempfile.TemporaryDirectory(prefix="mural-loaders.") as folder:
        report_file = os.path.join(folder, "report.json")
        fixed = ["--tiles", "2x1", "--display", "app", "--quiet", "--verify", "--report", report_file] + list(options)
        with context.run(through or command, fixed) as run:
            wrong = cases.check_end(run, status)
            if wrong is not None:
                return wrong
        with open(report_file, encoding="utf-8") as file:
            report = json.load(file)
    if run.standard_output != wanted:
        both = zip(run.standard_output + ["nothing"] * len(wanted), wanted)
        return "it printed %s" % next(("\"%s\" instead of \"%s\"" % pair for pair in both if pair[0] != pair[1]), "more")
    if report["frames"] != frames:
        return "%d frames on the wall instead of %d; %s" % (report["frames"], frames, " | ".join(run.standard_error))
    if report["differingPixels"] != 0 or (frames and report["verifiedPixels"] == 0):
        return "%d of %d pixels differ" % (report["differingPixels"], report["verifiedPixels"])
    lines = [line for line in run.standard_error if line.startswith("mural:")]
    if len(lines) != len(output) or not all(word in line for word, line in zip(output, lines)):
        return "it printed %d lines: %s" % (len(lines), " | ".join(lines))
    left = sockets_of(run)
    return "left over: " + ", ".join(left) if left else None


def in_turn(commands):
    """Returns one command that runs several. They share a session, whose start takes longer than a program. Their statuses
    are part of the output."""
    return ["sh", "-c", "; ".join(shlex.join(command) + "; echo \"%s: status $?\"" % " ".join(command[1:]) for command in commands)]


def reloaded(name, *changes):
    def check(context):
        programs = [[context.program("gl_reloaded"), "both", change] for change in changes]
        return compared(context, in_turn(programs), 18 * len(changes))
    check.__name__ = "reloaded_" + name
    cases.case(check)


CHANGES = ("untouched", "cleared", "unset", "put", "other")
if length.LONG:
    for changed in CHANGES:
        reloaded(changed, changed)
else:
    reloaded("in_turn", *CHANGES)


def executed(name, *ways, frames=6, output=()):
    def check(context):
        return compared(context, in_turn([context.program("exec_rounds"), way] for way in ways), frames * len(ways), output=output)
    check.__name__ = "executed_by_" + name
    cases.case(check)


REPLACED = ("execl", "execlp", "execle", "execv", "execvp", "execvpe", "execve", "fexecve", "execveat")
STARTED = ("posix_spawn", "posix_spawnp", "vfork")
if length.LONG:
    for call in REPLACED + STARTED:
        executed(call, call)
else:
    executed("replacing", *REPLACED)
    executed("starting", *STARTED)
executed("system", "system", frames=3, output=["exec_rounds"])


def hooked(name, program, frames, options=()):
    """Runs with an overlay in LD_PRELOAD, before Mural's library and after it."""
    def check(context):
        overlay = os.path.join(context.build, "tests", "end_to_end", "overlay.so")
        orders = ("%s${LD_PRELOAD:+ $LD_PRELOAD}", "${LD_PRELOAD:+$LD_PRELOAD }%s")
        command = shlex.join([context.program(program[0])] + program[1:])
        shell = "; ".join('LD_PRELOAD="%s" %s; echo "LD_PRELOAD=%s: status $?"' % (order % overlay, command, name)
                          for order, name in zip(orders, ("before", "after")))
        return compared(context, ["sh", "-c", shell], 2 * frames, options)
    check.__name__ = "hooked_" + name
    cases.case(check)


hooked("reloaded", ["gl_reloaded", "both", "untouched"], 18)
hooked("with_capture_via", ["gl_reloaded", "both", "untouched"], 18, ["--capture-via", "preload"])


def sandboxed(name, unshare, script='exec "$@"'):
    """Runs in namespaces of its own; skipped where the kernel does not permit them for this user."""
    def check(context):
        program = [context.program("gl_reloaded"), "both", "untouched"]
        words = ["unshare"] + unshare + ["sh", "-c", script, "sh"]
        tried = subprocess.run(words + ["true"], capture_output=True, text=True, timeout=20, check=False) if shutil.which("unshare") else None
        if tried is None or tried.returncode != 0:
            print("skipped: unshare %s: %s" % (" ".join(unshare), tried.stderr.strip() if tried else "is not installed"), flush=True)
            return None
        return compared(context, program, 18, through=words + program)
    check.__name__ = "sandboxed_" + name
    cases.case(check)


sandboxed("network", ["-Urn"])
sandboxed("network_and_processes", ["-Urnp", "--fork", "--mount-proc"])
sandboxed("network_without_user", ["-n"])


@cases.case
def sandboxed_socket_of_a_killed_launcher_is_removed(context):
    with context.run([context.program("long_run"), "--frames", "100000"], ["--quiet", "--display", "none"]) as run:
        if not run.wait_for_line("frame 10"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        if len(sockets_of(run)) != 1:
            return "%d folders while it runs" % len(sockets_of(run))
        os.kill(run.process.pid, signal.SIGKILL)
        return None if processes.until(lambda: not sockets_of(run), 10) else "its folder is still there"


@cases.case
def sandboxed_stale_sockets_go(context):
    """The next session removes the files of a session that was killed completely; other folders stay."""
    stale, foreign = "/tmp/mural-1-0123456789abcdef", "/tmp/mural-1-not-a-session"
    for folder in (stale, foreign):
        os.makedirs(folder, exist_ok=True)
    with open(stale + "/socket", "w", encoding="ascii"):
        pass
    os.utime(stale, (1, 1))
    try:
        with context.run(["true"], ["--quiet", "--display", "none"], {"XDG_RUNTIME_DIR": None}) as run:
            wrong = cases.check_end(run, 0)
        if wrong is None and os.path.exists(stale):
            wrong = stale + " is still there"
        if wrong is None and not os.path.exists(foreign):
            wrong = foreign + " is missing"
        return wrong
    finally:
        for folder in (stale, foreign):
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
