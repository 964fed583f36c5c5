"""Cases of an end-to-end test: their registration, the checks they share, and the command line that runs them."""

import argparse
import os
import signal
import time

from harness import display, length, session

CASES = {}  # name: function(context) → None or an error
LONG_CASES = set()  # names of cases that only long runs include


def case(function):
    CASES[function.__name__] = function
    return function


def long_case(function):
    """Registers a case that only long runs include, because other cases cover most of it."""
    LONG_CASES.add(function.__name__)
    return case(function)


class Context:
    def __init__(self, build, mural, display_name):
        self.build = build
        self.mural = mural
        self.display = display_name

    def program(self, name):
        return os.path.join(self.build, "tests", "programs", name)

    def run(self, program_command, options=("--tiles", "2x2", "--display", "none"), environment=None):
        command = [self.mural, "run"] + list(options) + ["--"] + list(program_command)
        return session.Session(command, self.display, environment)

    def drawing(self, name, frames=5, **more):
        return self.run([self.program(name), "--frames", str(frames), "--size", "250x190"], **more)


def error_lines(run, words):
    return [line for line in run.standard_error if any(word in line for word in words)]


def check_end(run, wanted_status, frames=None):
    """Checks the status, the drawn frames, and that nothing remains: common to all cases."""
    status = run.status()
    if status != wanted_status:
        return "status %s instead of %s; output: %s" % (
            "none in time" if status is None else status, wanted_status, " | ".join(run.standard_error[-3:]))
    if frames is not None:
        drawn = sum(line.startswith("frame ") for line in run.standard_output)
        if drawn != frames:
            return "the program drew %d frames instead of %d" % (drawn, frames)
    left = run.left_behind()
    return "left over: " + ", ".join(left) if left else None


def kill_all(pids):
    for pid in pids:
        os.kill(pid, signal.SIGKILL)


NODE = r"mural node\b"
HEAD = r"mural head\b"


def main(description):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--mural", help="the launcher; default BUILD/bin/mural")
    parser.add_argument("--cases", help="beginnings of the cases' names, separated by commas; default all")
    parser.add_argument("--list", action="store_true", help="show the cases and stop")
    arguments = parser.parse_args()
    beginnings = tuple(arguments.cases.split(",")) if arguments.cases else ("",)
    chosen = [name for name in CASES if name.startswith(beginnings)]
    if arguments.list:
        print("\n".join(chosen))
        return 0
    # A case whose whole name is given runs in any case.
    by_name = [name for name in chosen if name in (arguments.cases or "").split(",")]
    left_out = [] if length.LONG else [name for name in chosen if name in LONG_CASES and name not in by_name]
    chosen = [name for name in chosen if name not in left_out]
    if left_out:
        print("only with MURAL_LONG_TESTS=1: " + ", ".join(left_out))
    if not chosen:
        raise SystemExit("no case begins with \"%s\"; --list shows all" % arguments.cases)
    build = os.path.abspath(arguments.build)
    mural = os.path.abspath(arguments.mural) if arguments.mural else os.path.join(build, "bin", "mural")
    wrong = 0
    with display.PrivateDisplay() as display_name:
        context = Context(build, mural, display_name)
        for name in chosen:
            began = time.monotonic()
            result = CASES[name](context)
            wrong += result is not None
            print("%-32s %5.1f s  %s" % (name, time.monotonic() - began, "right" if result is None else "WRONG: " + result), flush=True)
    print("%d cases, %d wrong" % (len(chosen), wrong))
    return 1 if wrong else 0
