#!/usr/bin/env python3
"""Shows that run_exact.py can fail: each fault that a render node, or the head, makes on purpose must be found.

MURAL_PLANT=opcode changes one argument of one command, shift moves one tile by a pixel, drop leaves
out one frame's draws; economy loses what has changed in commands that a node has had before, and the head with held
all uploads that it has held back; of nodes that share draws, range loses the others' pictures, tie lets the
earlier draw win where depths are equal, order takes later draws for earlier ones, and band loses a band that a node
has put together; where areas move, early has one node take them before the clear that the others take them at, and uncleared all
nodes without one; where shares of draws move, lateshare has one node take those that were announced before; edges cuts
regions inside the bins of a software driver. Without a fault, the same comparison must be exact.
"""

import argparse
import os
import subprocess
import sys

PROGRAMS = "immediate,draw_calls,es2_scene"
RANGES = ["--programs", "fixed_lighting,range_ties", "--layouts", "1x1", "--options", "--display none --db 2", "--frames", "4"]
SWAPS = ["--programs", "range_ties", "--layouts", "1x1", "--options", "--display none --db 3 --composition direct-send", "--frames", "4"]
ECONOMY = ["--programs", "same_scene,immediate", "--layouts", "2x1", "--options", "--display none --economy on"]
HELD = ["--programs", "late_uploads", "--layouts", "2x1", "--options", "--display none --economy on", "--frames", "3"]
CHUNKS = ["--programs", "fixed_lighting,range_ties", "--layouts", "1x1", "--options", "--display none --db 3 --chunk-queue 40", "--frames", "12"]
EDGES = ["--programs", "blended_rectangles", "--layouts", "3x2", "--frames", "4"]
AREAS = ["--programs", "clears_in_turns,es2_scene", "--tile-queue", "16x16", "--layouts", "2,3", "--frames", "12"]
# Settings of the runs, and the faults that they must detect.
SETTINGS = ((["--layouts", "2x2"], ("opcode", "shift", "drop")), (RANGES, ("range", "tie", "order")), (SWAPS, ("band", "order")), (ECONOMY, ("economy",)), (HELD, ("held",)), (EDGES, ("edges",)), (AREAS, ("early", "uncleared")), (CHUNKS, ("lateshare",)))


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
    """The program in whose pictures the fault was seen: not by a crash, but by wrong pixels."""
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
