#!/usr/bin/env python3
"""Compares pictures that nodes combine with every strategy with the native ones, pixel by pixel.

compositions.py --build build/release --programs range_ties --counts 2,3,4,5 --size 253x191
"""

import os
import sys
import time

import run_exact
from harness import length

STRATEGIES = ("serial", "direct-send", "binary-swap", "2-3-swap", "radix-k", "streaming")


class Compositions(run_exact.Comparison):
    """Each program natively once, then divided among that number of nodes, with each strategy. The nodes of a strategy
    draw all programs, and end before those of the next one start."""

    def check(self, name):
        names = run_exact.programs.choose(self.arguments.programs)
        if name != names[0]:
            return  # compared with the first
        native = {program: self.run(program, "reference") for program in names}
        for program, run in native.items():
            if run.status != 0 or not run.frames():
                self.report(program, "reference", 0, "fails natively: status %s%s" % (run.status, run_exact.printed(run)))
                return
        for label, launcher in self.launchers().items():
            for program, run in native.items():
                began = time.monotonic()
                wrong = self.compare(run, self.run_shared(program, label, launcher))
                self.report(program, label, len(run.frames()), wrong, time.monotonic() - began)
            if label in self.shared:
                self.end_shared(label)

    def launchers(self):
        arguments = self.arguments
        mural = arguments.mural or os.path.join(arguments.build, "bin", "mural")
        def by(label, *options):
            return label, [mural, "run", "--report", self.report_file(label)] + arguments.options.split() + list(options) + ["--"]
        return dict(by("%s.%s" % (strategy, count), "--db", count, "--composition", strategy)
                    for count in arguments.counts.split(",") for strategy in arguments.strategies.split(","))


def add_arguments(parser):
    parser.add_argument("--counts", default="2,3,4,5" if length.LONG else "3,4", help="of nodes")
    parser.add_argument("--strategies", default=",".join(STRATEGIES))


if __name__ == "__main__":
    sys.exit(run_exact.main(__doc__, add_arguments, Compositions))
