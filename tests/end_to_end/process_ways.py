#!/usr/bin/env python3
"""Programs about processes (tests/programs/processes) print the same natively and through Mural: the pixels that they
read, and the ends of their children. --verify finds no differing pixel, and the frames are on the wall.

  process_ways.py --build build/release [--cases calls,closed] [--repeat 20] [--list]
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

from harness import display, programs

# name: minimum number of frames on the wall, over all processes
FORKS = {"calls": 4, "raw_calls": 4, "together": 20, "raw_together": 20, "egl_together": 0, "before": 10, "after": 3,
         "executed": 3, "threads": 17, "daemonised": 6, "inherited": 2}
LIMITS = {"interrupted": 21, "interrupted_restart": 21, "closed": 24, "replaced": 24, "daemon_files": 4,
          "limited_first": 6, "limited_later": 9, "sandbox_refuses": 28, "sandbox_kills": 28}
CASES = dict([(name, ("forked_children", frames)) for name, frames in FORKS.items()] +
             [(name, ("hard_limits", frames)) for name, frames in LIMITS.items()])
SETTINGS = {"inherited": {"LP_NUM_THREADS": "0"}}
# Repetitions, because timing decides whether these detect an error.
RUNS = {"interrupted": 3, "interrupted_restart": 2}
MESSAGES = {"inherited": "a forked child draws with a context of its parent"}


def run(command, name, seconds=120):
    environment = programs.clean_environment(os.environ["DISPLAY"])
    environment.update(SETTINGS.get(name, {}))
    done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=seconds, check=False)
    return done.returncode, sorted(done.stdout.splitlines()) if name == "daemonised" else done.stdout.splitlines(), done.stderr


def unlike(native, through):
    for i, line in enumerate(native):
        if i >= len(through) or through[i] != line:
            return "line %d is \"%s\" instead of \"%s\"" % (i + 1, through[i] if i < len(through) else "missing", line)
    return "it printed %d more lines" % (len(through) - len(native)) if len(through) > len(native) else None


def differs(build, name, native, report):
    program, frames = CASES[name]
    command = [os.path.join(build, "bin", "mural"), "run", "--tiles", "2x2", "--verify", "--report", report, "--",
               os.path.join(build, "tests", "programs", program), name]
    status, reported, output = run(command, name)
    if status != native[0]:
        return "status %d instead of %d: %s" % (status, native[0], output[-400:])
    wrong = unlike(native[1], reported)
    if wrong:
        return "%s; output: %s" % (wrong, output[-400:])
    with open(report, encoding="utf-8") as file:
        facts = json.load(file)
    if facts.get("differingPixels", 0):
        return "%d pixels differ" % facts["differingPixels"]
    if facts.get("verifiedFrames", 0) < frames:  # over all processes; "frames" counts only the main window's
        return "%d frames on the wall instead of %d: %s" % (facts.get("verifiedFrames", 0), frames, output[-400:])
    if MESSAGES.get(name, "") not in output:
        return "it did not print \"%s\"" % MESSAGES[name]
    return None


def check(build, name, repeat):
    program = CASES[name][0]
    native = run([os.path.join(build, "tests", "programs", program), name], name)
    if "has no seccomp" in native[2]:
        return "skipped: " + native[2].strip(), False
    if native[0] not in (0, 3):
        return "natively status %d: %s" % (native[0], native[2][-400:]), True
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(repeat or RUNS.get(name, 1)):
            wrong = differs(build, name, native, os.path.join(folder, "report.json"))
            if wrong:
                return wrong, True
    return "as natively", False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--cases")
    parser.add_argument("--repeat", type=int)
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    if arguments.list:
        print("\n".join(CASES))
        return 0
    names = arguments.cases.split(",") if arguments.cases else list(CASES)
    failed = 0
    with display.PrivateDisplay("1280x1024x24") as name:
        os.environ["DISPLAY"] = name
        for case in names:
            text, wrong = check(os.path.abspath(arguments.build), case, arguments.repeat)
            failed += wrong
            print("%s: %s" % (case, text), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
