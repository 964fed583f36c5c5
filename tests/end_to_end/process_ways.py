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

from harness import display, length, programs

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
LAYOUT = "2x2" if length.LONG else "2x1"
MESSAGES = {"inherited": "a forked child draws with a context of its parent"}


# Cases that share no session: a setting, output in no particular order, a number of frames that depends on timing.
ALONE = {"inherited", "daemonised", "threads"}
# Runs each way, and prints its status.
IN_TURN = 'program=$1; shift; for way; do "$program" $way; echo "$way: status $?"; done'


def run(command, names, seconds=120):
    environment = programs.clean_environment(os.environ["DISPLAY"])
    environment.update(SETTINGS.get(names[0], {}))
    done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=seconds, check=False)
    return done.returncode, sorted(done.stdout.splitlines()) if "daemonised" in names else done.stdout.splitlines(), done.stderr


def unlike(native, through):
    for i, line in enumerate(native):
        if i >= len(through) or through[i] != line:
            return "line %d is \"%s\" instead of \"%s\"" % (i + 1, through[i] if i < len(through) else "missing", line)
    return "it printed %d more lines" % (len(through) - len(native)) if len(through) > len(native) else None


def in_turn(build, program, names):
    return ["sh", "-c", IN_TURN, "sh", os.path.join(build, "tests", "programs", program)] + names


def differs(build, program, names, native, report):
    mural = [os.path.join(build, "bin", "mural"), "run", "--tiles", LAYOUT, "--verify", "--report", report, "--"]
    status, reported, output = run(mural + in_turn(build, program, names), names, 120 + 20 * len(names))
    if status != 0:
        return "status %d: %s" % (status, output[-400:])
    wrong = unlike(native, reported)
    if wrong:
        return "%s; output: %s" % (wrong, output[-400:])
    with open(report, encoding="utf-8") as file:
        facts = json.load(file)
    if facts.get("differingPixels", 0):
        return "%d pixels differ" % facts["differingPixels"]
    frames = sum(CASES[name][1] for name in names)
    if facts.get("verifiedFrames", 0) < frames:  # over all processes; "frames" counts only the main window's
        return "%d frames on the wall instead of %d: %s" % (facts.get("verifiedFrames", 0), frames, output[-400:])
    missing = [name for name in names if MESSAGES.get(name, "") not in output]
    return "it did not print \"%s\"" % MESSAGES[missing[0]] if missing else None


def check(build, names, repeat):
    """Runs cases of one program in one session, each as often as its repetitions. Returns a text, and whether it is an
    error."""
    program = CASES[names[0]][0]
    native = {}
    for name in names:
        status, lines, output = run(in_turn(build, program, [name]), [name])
        if "has no seccomp" in output:
            print("skipped: %s: %s" % (name, output.strip()))
        elif not {"%s: status %d" % (name, ending) for ending in (0, 3)} & set(lines):
            return "natively status %d: %s: %s" % (status, " | ".join(lines[-1:]), output[-400:]), True
        else:
            native[name] = lines
    ways = [name for name in native for _ in range(repeat or RUNS.get(name, 1))]
    if not ways:
        return "skipped", False
    with tempfile.TemporaryDirectory() as folder:
        wrong = differs(build, program, ways, [line for way in ways for line in native[way]], os.path.join(folder, "report.json"))
    return wrong or "as natively", wrong is not None


def sessions(names):
    """Returns the cases of each session. Those of a program share one, because its start takes longer than a case."""
    if length.LONG:
        return [[name] for name in names]
    shared = {}
    for name in names:
        shared.setdefault(name if name in ALONE else CASES[name][0], []).append(name)
    return list(shared.values())


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
        for together in sessions(names):
            text, wrong = check(os.path.abspath(arguments.build), together, arguments.repeat)
            failed += wrong
            print("%s: %s" % (", ".join(together), text), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
