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
Without a fault the same comparison must be exact. Long runs show it here; in short ones the tests end_to_end.exact_*,
ranges, compositions and delta_exact do.
"""

import argparse
import contextlib
import io
import os
import sys
import tempfile
from unittest import mock

import run_exact
from harness import display, length

TILES = ["--programs", "immediate", "--layouts", "2x2"]
RANGES = ["--programs", "range_ties", "--layouts", "1x1", "--options", "--display none --db 2"]
SWAPS = ["--programs", "range_ties", "--layouts", "1x1", "--options", "--display none --db 3 --composition direct-send"]
DELTA = ["--programs", "same_scene", "--layouts", "2x1", "--options", "--display none --delta on"]
DEFERRED = ["--programs", "late_uploads", "--layouts", "2x1", "--options", "--display none --delta on", "--frames", "3"]
CHUNKS = ["--programs", "fixed_lighting,range_ties", "--layouts", "1x1", "--options", "--display none --db 3 --chunk-queue 40", "--frames", "12"]
EDGES = ["--programs", "blended_rectangles", "--layouts", "3x2"]
AREAS = ["--programs", "clears_in_turns,es2_scene", "--tile-queue", "16x16", "--layouts", "2,3", "--frames", "12"]
# Settings of the runs, and the faults that they must detect.
SETTINGS = ((TILES, ("opcode", "shift", "drop")), (RANGES, ("range", "tie", "order")), (SWAPS, ("band", "order")), (DELTA, ("delta",)), (DEFERRED, ("held",)), (EDGES, ("edges",)), (AREAS, ("early", "uncleared")), (CHUNKS, ("lateshare",)))


class Comparison(run_exact.Comparison):
    """Runs each program natively once for all faults."""

    references = {}

    def run(self, name, label, launcher=(), environment=None):
        if label != "reference":
            return super().run(name, label, launcher, environment)
        key = name, self.arguments.frames
        if key not in self.references:
            self.references[key] = super().run(name, label, launcher, environment)
        return self.references[key]


def compare(words, fault, display_name, folder):
    """Returns the number of wrong comparisons, and what run_exact.py prints."""
    if fault:
        words = words + ["--until-differs"]  # one program that reveals it is sufficient
    with mock.patch.object(sys, "argv", ["run_exact.py"] + words):
        arguments = run_exact.parse_arguments(__doc__, lambda parser: None)
    comparison = Comparison(arguments, display_name, tempfile.mkdtemp(dir=folder))
    printed = io.StringIO()
    with mock.patch.dict(os.environ, {"MURAL_PLANT": fault} if fault else {}), contextlib.redirect_stdout(printed):
        if not fault:
            os.environ.pop("MURAL_PLANT", None)
        for name in arguments.programs.split(","):
            comparison.check(name)
            if comparison.ended:
                break
    return comparison.failures, printed.getvalue()


def found_in(output):
    """Returns the program whose pictures reveal the fault: with wrong pixels, not with a crash."""
    return [line.split()[0] for line in output.splitlines() if "pixels differ in" in line]


def missed_faults(settings, words, display_name, folder):
    """Returns the number of faults that are not found; None if the comparison is not exact without a fault."""
    missed = 0
    for setting, faults in settings:
        if length.LONG:
            failures, output = compare(words + setting, None, display_name, folder)
            if failures != 0:
                print("without a fault the comparison must be exact, but:\n" + output)
                return None
            print("no fault: exact")
        for fault in faults:
            failures, output = compare(words + setting, fault, display_name, folder)
            seen = found_in(output)
            right = failures > 0 and bool(seen)
            missed += not right
            print("%-9s %s" % (fault, "found in " + " ".join(seen) if right else "MISSED:\n" + output), flush=True)
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--mural")
    parser.add_argument("--part", default="1/1", metavar="K/N", help="only the Kth of N parts of the settings")
    arguments = parser.parse_args()
    part, parts = (int(number) for number in arguments.part.split("/"))
    words = ["--build", os.path.abspath(arguments.build), "--size", "250x190", "--seconds", "60", "--frames", "4"]
    if arguments.mural:
        words += ["--mural", arguments.mural]
    with display.PrivateDisplay() as display_name, tempfile.TemporaryDirectory(prefix="planted-faults.") as folder:
        return 1 if missed_faults(SETTINGS[part - 1::parts], words, display_name, folder) != 0 else 0


if __name__ == "__main__":
    sys.exit(main())
