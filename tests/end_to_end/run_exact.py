#!/usr/bin/env python3
"""Runs the test programs natively and through Mural and compares all their frames, pixel by pixel.

  run_exact.py --build build/release --programs immediate,pixels --layouts 1x1,2x2,3x1,7x5 --size 250x190
  run_exact.py --build build/release --native      only twice natively: are the programs deterministic?
  run_exact.py --list

Prints one line per program and layout: frames, differing pixels, largest difference, position. The status is 1 when a
pixel differs, a picture is missing, or a program ends differently from its native run; 77 when the driver supports none
of the programs.
"""

import argparse
import json
import os
import shutil
import sys
import tempfile
import time

from harness import display, length, pictures, programs, shared_nodes

CONFIGS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "configs")


def parse_arguments(description, add_arguments):
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--mural", help="the launcher; default BUILD/bin/mural")
    parser.add_argument("--programs", help="programs and groups, separated by commas; default all")
    parser.add_argument("--long-programs", help="further programs of a long run, MURAL_LONG_TESTS=1")
    parser.add_argument("--layouts", default="1x1,2x2,3x1,7x5", help="tiles, columns x rows")
    parser.add_argument("--long-layouts", help="layouts of a long run, MURAL_LONG_TESTS=1; default those of --layouts")
    parser.add_argument("--config", metavar="FILE", help="nodes of this file in configs/; no layouts then")
    parser.add_argument("--tile-queue", metavar="WxH", help="nodes take tiles of this size from a queue; layouts are numbers of nodes then")
    parser.add_argument("--min-changes", type=int, default=0, metavar="N", help="fail when areas or shares changed less often, in all runs together: then nothing was tried")
    parser.add_argument("--size", default="1000x777", help="of the programs' windows")
    parser.add_argument("--frames", type=int, default=4)
    parser.add_argument("--options", default="--display none",
                        help="more options for `mural run`, in one string")
    parser.add_argument("--seconds", type=int, default=120, help="the longest that one run may take")
    parser.add_argument("--bound", type=float, default=0.0, metavar="PERCENT",
                        help="of the pixels that may differ; 0: none (tiling lean is not exact)")
    parser.add_argument("--one-node", action="store_true", help="compare with a run whose picture is not divided instead of a native one: of what drivers do not agree about, or passes change")
    parser.add_argument("--share-nodes", action="store_true", help="start the nodes of each layout once for all programs")
    parser.add_argument("--until-differs", action="store_true", help="end with the first program and layout in which pixels differ")
    parser.add_argument("--native", action="store_true", help="compare two native runs")
    parser.add_argument("--keep", metavar="FOLDER", help="keep all pictures and logs there")
    parser.add_argument("--list", action="store_true", help="show the programs by group and stop")
    add_arguments(parser)
    arguments = parser.parse_args()
    if length.LONG and arguments.long_layouts:
        arguments.layouts = arguments.long_layouts
    if length.LONG and arguments.long_programs:
        arguments.programs += "," + arguments.long_programs
    if arguments.config:
        arguments.layouts = "file"
    return arguments


def list_programs():
    for group, names in programs.GROUPS.items():
        print("%s: %s" % (group, " ".join(names)))


class Comparison:
    """Compares one native run of a program with any number of other runs."""

    def __init__(self, arguments, display_name, folder):
        self.arguments = arguments
        self.display_name = display_name
        self.folder = folder
        self.failures = 0
        self.known = 0
        self.skipped = 0
        self.healed = []
        self.taken = 0
        self.ended = False  # --until-differs
        self.shared = {}  # nodes that start once for all programs, by layout
        self.drawn = {}  # frames that shared nodes have drawn, by layout

    def finish(self):
        """Makes the checks that follow all programs."""
        for label in list(self.shared):
            self.end_shared(label)
        if len(set(self.drawn.values())) > 1:
            self.failures += 1
            print("WRONG: nodes of different layouts drew different numbers of frames: %s" % self.drawn, flush=True)

    def run(self, name, label, launcher=(), environment=None):
        arguments = self.arguments
        folder = os.path.join(self.folder, name, label)
        return programs.run_program(arguments.build, name, folder, self.display_name, arguments.size,
                                    arguments.frames, launcher, arguments.seconds, environment)

    def launchers(self):
        arguments = self.arguments
        if arguments.native:
            return {"native": []}
        mural = arguments.mural or os.path.join(arguments.build, "bin", "mural")
        options = arguments.options.split()
        def divided(layout):
            if arguments.config:
                return ["--config", os.path.join(CONFIGS, arguments.config), "--all-local"]
            return ["--tile-queue", arguments.tile_queue, "--local-nodes", layout] if arguments.tile_queue else ["--tiles", layout]
        return {layout: [mural, "run"] + divided(layout) + ["--report", self.report_file(layout)] + options + ["--"]
                for layout in arguments.layouts.split(",")}

    def one_node(self):
        return [os.path.join(self.arguments.build, "bin", "mural"), "run"] + self.arguments.options.split() + ["--"]

    def report_file(self, label):
        return os.path.join(self.folder, "report.%s.json" % label)

    def report_of(self, label):
        """Returns the report of the last run with this layout; empty if there is none."""
        try:
            with open(self.report_file(label), encoding="utf-8") as report:
                return json.load(report)
        except (OSError, ValueError):
            return {}

    def forget_report(self, label):
        if os.path.exists(self.report_file(label)):
            os.remove(self.report_file(label))

    def captured(self, label):
        """Returns how many frames of the last run the nodes drew: a program that ran alone is exact, too."""
        return self.report_of(label).get("frames", 0)

    def moves(self, label):
        """Returns how often areas or ranges of the nodes changed from one frame to the next, according to the last
        report."""
        equalizers = self.report_of(label).get("equalizers")
        if not equalizers:
            return ""
        taken = sum(equalizer["taken"] for equalizer in equalizers)
        self.taken += taken
        return ", parts changed %d times, busy %.0f %%" % (taken, 100 * equalizers[0]["efficiency"])

    def run_alone(self, name, label, launcher):
        # In the second native run new memory is not zero, which reveals reads of uninitialised memory.
        environment = {"MALLOC_PERTURB_": "165"} if self.arguments.native else None
        self.forget_report(label)
        through = self.run(name, label, launcher, environment)
        through.captured = None if self.arguments.native else self.captured(label)
        return through

    def run_shared(self, name, label, launcher):
        """Runs on nodes that have drawn the programs before this one."""
        arguments = self.arguments
        if label not in self.shared:
            self.forget_report(label)
            self.shared[label] = shared_nodes.SharedNodes(launcher, self.display_name, os.path.join(self.folder, "shared." + label))
        nodes = self.shared[label]
        through = nodes.run_program(arguments.build, name, os.path.join(self.folder, name, label), arguments.size, arguments.frames, arguments.seconds)
        through.captured = nodes.new_frames(launcher[0])
        if through.status is None:  # the next program gets new nodes
            self.end_shared(label)
        return through

    def end_shared(self, label):
        nodes = self.shared.pop(label)
        status = nodes.end(self.arguments.seconds)
        frames = self.captured(label)
        self.drawn[label] = self.drawn.get(label, 0) + frames
        wrong = "status %s of the run for all programs" % status if status != 0 else None
        self.failures += wrong is not None
        print("%-24s %-9s %3d frames  %s%s" % ("by the same nodes", label, frames, "WRONG: " + wrong if wrong else "right", self.moves(label)), flush=True)
        shutil.rmtree(os.path.join(self.folder, "shared." + label), ignore_errors=True)

    def check(self, name):
        native = self.run(name, "reference", self.one_node() if self.arguments.one_node else ())
        wanted = programs.STATUS.get(name, 0)
        if native.status == programs.SKIPPED:
            self.skipped += 1
            print("%-24s %s" % (name, native.output.splitlines()[-1]), flush=True)
            return
        if native.status != wanted or not native.frames():
            self.report(name, "reference", 0, "fails natively: status %s, %d pictures%s" % (
                native.status, len(native.frames()), printed(native)))
            return
        for label, launcher in self.launchers().items():
            start = time.monotonic()
            run = self.run_shared if self.arguments.share_nodes else self.run_alone
            through = run(name, label, launcher)
            wrong = self.compare(native, through)
            self.report(name, label, len(native.frames()), wrong, time.monotonic() - start)
            self.ended = self.arguments.until_differs and wrong is not None and "pixels differ in" in wrong
            if self.ended:
                return

    def report(self, name, label, frames, wrong, seconds=0.0):
        known = programs.KNOWN_DIFFERENCES.get(name) if label in self.launchers() and label != "native" else None
        if known and wrong is not None and "pixels differ in" in wrong:
            self.known += 1
            wrong = "known to differ (%s): %s" % (known, wrong.split(",")[0])
            print("%-24s %-9s %3d frames  %s  (%.1f s)" % (name, label, frames, wrong, seconds), flush=True)
            return
        if known and wrong is None and label not in ("1x1",):
            self.healed.append(name)
        self.failures += wrong is not None
        print("%-24s %-9s %3d frames  %s  (%.1f s)" % (
            name, label, frames, (("within the bound" if self.arguments.bound else "0 pixels differ") if wrong is None else "WRONG: " + wrong) + ("" if label in self.shared else self.moves(label)), seconds),
            flush=True)

    def compare(self, native, through):
        """Returns None if all frames are equal, otherwise an error."""
        if not programs.same_status(native.status, through.status):
            return "status %s instead of %s%s" % (
                "none in time" if through.status is None else through.status, native.status, printed(through))
        if through.captured == 0:
            return "no frame was drawn by nodes" + printed(through)
        expected, got = native.frames(), through.frames()
        if set(expected) != set(got):
            missing = sorted(set(expected) - set(got))
            extra = sorted(set(got) - set(expected))
            return "missing pictures: %s; unexpected: %s%s" % (
                " ".join(missing) or "none", " ".join(extra) or "none", printed(through))
        difference = pictures.Difference()
        wrong_frames = 0
        for frame in expected:
            with open(expected[frame], "rb") as first, open(got[frame], "rb") as second:
                if first.read() == second.read():
                    continue
            wrong_frames += 1
            self.compare_pictures(expected[frame], got[frame], frame, difference)
        if wrong_frames == 0:
            return None
        pixels = sum(os.path.getsize(path) // 3 for path in expected.values())
        if difference.pixels * 100 <= self.arguments.bound * pixels:
            print("%-24s %d of %d pixels differ, %.4f %%, largest difference %d" % (
                got_name(got), difference.pixels, pixels, difference.pixels * 100 / pixels, difference.largest))
            return None
        return "%d pixels differ in %d frames, largest difference %d, %s%s" % (
            difference.pixels, wrong_frames, difference.largest, difference.place, printed(through))

    def compare_pictures(self, expected, got, frame, difference):
        first, second = pictures.read_ppm(expected), pictures.read_ppm(got)
        difference.add_pictures(first, second, frame)
        if self.arguments.keep:
            pictures.write_difference(got[:-len(".ppm")] + ".difference.ppm", first, second)


def got_name(frames):
    """Returns the program's name and layout from the path of its pictures."""
    return "/".join(next(iter(frames.values())).split(os.sep)[-4:-2])


def printed(run):
    """Returns the last lines that a failed run printed, on one line."""
    lines = [line for line in run.output.splitlines() if line.strip()]
    return "; output: " + " | ".join(lines[-3:]) if lines else ""


def main(description=__doc__, add_arguments=lambda parser: None, comparison_class=Comparison):
    arguments = parse_arguments(description, add_arguments)
    if arguments.list:
        list_programs()
        return 0
    names = programs.choose(arguments.programs)
    arguments.build = os.path.abspath(arguments.build)
    folder = os.path.abspath(arguments.keep) if arguments.keep else tempfile.mkdtemp(prefix="run-exact.")
    try:
        with display.PrivateDisplay() as display_name:
            comparison = comparison_class(arguments, display_name, folder)
            for name in names:
                shutil.rmtree(os.path.join(folder, name), ignore_errors=True)
                comparison.check(name)
                if not arguments.keep:
                    shutil.rmtree(os.path.join(folder, name), ignore_errors=True)
                if comparison.ended:
                    break
            comparison.finish()
    finally:
        if not arguments.keep:
            shutil.rmtree(folder, ignore_errors=True)
    if comparison.taken < arguments.min_changes:
        print("WRONG: areas or ranges changed %d times, not %d at least" % (comparison.taken, arguments.min_changes))
        comparison.failures += 1
    print("%d programs, %d comparisons wrong, %d known to differ, %d skipped" % (len(names), comparison.failures, comparison.known, comparison.skipped))
    for name in comparison.healed:
        print("%s is exact now: take it out of KNOWN_DIFFERENCES in programs.py" % name)
    if comparison.skipped == len(names):
        return programs.SKIPPED
    return 1 if comparison.failures else 0


if __name__ == "__main__":
    sys.exit(main())
