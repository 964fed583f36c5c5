#!/usr/bin/env python3
"""Windows with alpha, and with 5, 8 and 10 bits per channel, show and read all bits of every pixel as natively.

  colour_depths.py --build build/release [--depths 16,24,30] [--programs …] [--options "…"]

Runs the programs on X screens of each depth, natively and through Mural, and compares their output: sums of the pixels
that GL reads and that the X server shows. With --display app their windows are also compared by --verify.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

from harness import display, length, programs

# A warning appears exactly for windows shown with fewer bits than they have.
EIGHT_BITS = "bits per channel; its picture is shown and saved with 8"


def run(command, display_name, seconds):
    """Returns status, output, and messages of a run."""
    done = subprocess.run(command, env=programs.clean_environment(display_name), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=seconds, check=False)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def first_difference(native, through):
    kind = ""
    for wanted, found in zip(native.splitlines(), through.splitlines()):
        if not wanted.startswith(" "):
            kind = wanted
        if wanted != found:
            return "%s: \"%s\" instead of \"%s\"" % (kind, found.strip(), wanted.strip())
    return "%d lines instead of %d" % (len(through.splitlines()), len(native.splitlines()))


class Comparison:
    def __init__(self, arguments):
        self.build = arguments.build
        self.seconds = arguments.seconds
        self.programs = arguments.programs.split(",")
        self.failures = 0

    def say(self, name, problems):
        print("%s: %s" % (name, "; ".join(problems) if problems else "ok"), flush=True)
        self.failures += bool(problems)

    def through(self, display_name, program, options, native):
        """Returns the error of one run through Mural, or None."""
        with tempfile.TemporaryDirectory() as folder:
            report = os.path.join(folder, "report.json")
            status, output, messages = run([os.path.join(self.build, "bin", "mural"), "run", "--report", report] + options + ["--", program], display_name, self.seconds)
            problems = []
            if status != 0:
                problems.append("status %d: %s" % (status, messages.strip()))
            if output != native:
                problems.append(first_difference(native, output))
            with open(report, encoding="utf-8") as file:
                numbers = json.load(file)
        if numbers.get("frames", 0) == 0:
            problems.append("no frame was drawn by nodes")
        if "--verify" in options:
            if numbers.get("verifiedFrames", 0) == 0:
                problems.append("no frame was verified")
            if numbers.get("differingPixels", 0) != 0:
                problems.append("%d pixels differ" % numbers["differingPixels"])
        halves = os.path.basename(program) == "deep_framebuffers"  # pbuffers of half floats are not windows
        if "app" in options and (EIGHT_BITS in messages) != halves:
            problems.append("the line about 8 bits " + ("is missing" if halves else "was printed"))
        return problems

    def compare(self, depth, names, options):
        with display.PrivateDisplay("640x480x%d" % depth) as display_name:
            for name in names:
                program = os.path.join(self.build, "tests", "programs", name)
                status, native, messages = run([program], display_name, self.seconds)
                if status != 0:
                    self.say("depth %d, %s natively" % (depth, name), ["status %d: %s" % (status, messages.strip())])
                    continue
                for words in options:
                    self.say("depth %d, %s, %s" % (depth, name, words), self.through(display_name, program, words.split(), native))

    def lines(self):
        """Checks the line about windows shown with fewer bits: it appears for windows of 10 bits, and nowhere else."""
        for depth, expected in ((24, False), (30, True)):
            with display.PrivateDisplay("640x480x%d" % depth) as display_name, tempfile.TemporaryDirectory() as folder:
                program = os.path.join(self.build, "tests", "programs", "window_colours")
                command = [os.path.join(self.build, "bin", "mural"), "run", "--display", "none", "--out", os.path.join(folder, "out"), "--", program]
                _, _, messages = run(command, display_name, self.seconds)
                printed = EIGHT_BITS in messages
                self.say("depth %d, pictures in files" % depth, [] if printed == expected else ["the line about 8 bits %s: %s" % ("is missing" if expected else "was printed", messages.strip())])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--depths", default="16,24,30", help="of the X screens")
    parser.add_argument("--long-depths", help="depths of a long run, MURAL_LONG_TESTS=1; default those of --depths")
    parser.add_argument("--programs", default="window_colours,deep_framebuffers")
    parser.add_argument("--options", action="append", help="of one run; may be given several times")
    parser.add_argument("--lines", action="store_true", help="check the messages instead")
    parser.add_argument("--seconds", type=int, default=120, help="the longest that one run may take")
    arguments = parser.parse_args()
    comparison = Comparison(arguments)
    if arguments.lines:
        comparison.lines()
    else:
        depths = (length.LONG and arguments.long_depths or arguments.depths).split(",")
        for depth in depths:
            # Pixel buffers and framebuffer objects have the same formats on all screens.
            names = [name for name in comparison.programs if name != "deep_framebuffers" or length.LONG or depth == depths[-1]]
            comparison.compare(int(depth), names, arguments.options or ["--tiles %s --display app --verify" % ("2x2" if length.LONG else "2x1")])
    return 1 if comparison.failures else 0


if __name__ == "__main__":
    sys.exit(main())
