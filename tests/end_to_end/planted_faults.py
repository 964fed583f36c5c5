#!/usr/bin/env python3
"""Proves that run_exact.py can fail: each planted fault of a render node, or of the head, must be detected.

Values of MURAL_PLANT:
  opcode     changes one argument of one command
  shift      moves one tile by a pixel
  drop       skips one frame's draws
  delta      loses the changed parts of commands that a node has received before
  held       the head loses all uploads that it has deferred
  range      loses the other nodes' pictures (nodes that divide draws)
  tie        the earlier draw wins at equal depths
  order      exchanges earlier and later draws
  band       loses a band that a node has combined
  early      one node adopts moving areas at an earlier clear than the others
  uncleared  all nodes adopt moving areas without a clear
  lateshare  one node uses the previously announced shares of draws
  edges      cuts regions inside the bins of a software driver
Without a fault the same comparison must be exact.
"""

import argparse
import os
import subprocess
import sys

PROGRAMS = "immediate,draw_calls,es2_scene"
RANGES = ["--programs", "fixed_lighting,range_ties", "--layouts", "1x1", "--options", "--display none --db 2", "--frames", "4"]
SWAPS = ["--programs", "range_ties", "--layouts", "1x1", "--options", "--display none --db 3 --composition direct-send", "--frames", "4"]
DELTA = ["--programs", "same_scene,immediate", "--layouts", "2x1", "--options", "--display none --delta on"]
DEFERRED = ["--programs", "late_uploads", "--layouts", "2x1", "--options", "--display none --delta on", "--frames", "3"]
CHUNKS = ["--programs", "fixed_lighting,range_ties", "--layouts", "1x1", "--options", "--display none --db 3 --chunk-queue 40", "--frames", "12"]
EDGES = ["--programs", "blended_rectangles", "--layouts", "3x2", "--frames", "4"]
AREAS = ["--programs", "clears_in_turns,es2_scene", "--tile-queue", "16x16", "--layouts", "2,3", "--frames", "12"]
# Settings of the runs, and the faults that they must detect.
SETTINGS = ((["--layouts", "2x2"], ("opcode", "shift", "drop")), (RANGES, ("range", "tie", "order")), (SWAPS, ("band", "order")), (DELTA, ("delta",)), (DEFERRED, ("held",)), (EDGES, ("edges",)), (AREAS, ("early", "uncleared")), (CHUNKS, ("lateshare",)))


def compare(arguments, setting, fault):
    environment = dict(os.environ)
    environment.pop("MURAL_PLANT", None)
    command = [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_exact.py"),
               "--build", arguments.build, "--programs", arguments.programs,
               "--size", "250x190", "--seconds", "60"] + setting
    if fault:
        environment["MURAL_PLANT"] = fault
        command.append("--until-differs")  # one program that reveals it is sufficient
    if arguments.mural:
        command += ["--mural", arguments.mural]
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=600, check=False)
    return done.returncode, done.stdout


def found_in(output):
    """Returns the program whose pictures reveal the fault: with wrong pixels, not with a crash."""
    return [line.split()[0] for line in output.splitlines() if "pixels differ in" in line]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--mural")
    parser.add_argument("--programs", default=PROGRAMS)
    arguments = parser.parse_args()
    missed = 0
    for setting, faults in SETTINGS:
        status, output = compare(arguments, setting, None)
        if status != 0:
            print("without a fault the comparison must be exact, but:\n" + output)
            return 1
        print("no fault: exact")
        for fault in faults:
            status, output = compare(arguments, setting, fault)
            seen = found_in(output)
            right = status == 1 and bool(seen)
            missed += not right
            print("%-7s %s" % (fault, "found in " + " ".join(seen) if right else "MISSED:\n" + output))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
