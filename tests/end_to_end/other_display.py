#!/usr/bin/env python3
"""A program's window on an X display other than DISPLAY. Its pictures are there, and the window with the same number on
DISPLAY, which belongs to another program, is unchanged, as in a native run.

  other_display.py --build build/release [--ways glx,both,egl,xcb,default]
"""

import argparse
import os
import subprocess
import sys

from harness import display, programs

WAYS = "glx,both,egl,xcb,default"
SECONDS = 60


def run(command, names):
    environment = programs.clean_environment(names[0])
    environment["OTHER_DISPLAY"] = names[1]
    done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=SECONDS)
    return done.returncode, done.stdout, done.stderr


def check(build, way, names):
    """Returns an error text, or None."""
    program = [os.path.join(build, "tests", "programs", "other_display"), way]
    native = run(program, names)
    if native[0] != 0:
        return "fails natively: " + native[2]
    mural = [os.path.join(build, "bin", "mural"), "run", "--tiles", "2x1", "--display", "app", "--"]
    status, output, errors = run(mural + program, names)
    if status != 0 or output != native[1]:
        return "status %d, %s instead of %s; output: %s" % (status, output.split(), native[1].split(), errors)
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--ways", default=WAYS)
    arguments = parser.parse_args()
    failures = 0
    for way in arguments.ways.split(","):
        # Fresh servers give the same numbers to their first programs.
        with display.PrivateDisplay("640x480x24") as first, display.PrivateDisplay("640x480x24") as second:
            wrong = check(os.path.abspath(arguments.build), way, (first, second))
        failures += wrong is not None
        print("%-8s %s" % (way, "as natively" if wrong is None else "WRONG: " + wrong), flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
