#!/usr/bin/env python3
"""Makes random GL calls natively and through Mural, and compares errors, results and pictures.

  run_random_gl.py --build build/release --seconds 30                        seeds from 1 on, all profiles
  run_random_gl.py --build build/release --seconds 600 --first-seed 5000     a long run
  run_random_gl.py --build build/release --seconds 20 --today                other seeds every day
  run_random_gl.py --build build/release --profiles core --seeds 17:17 --steps 200
  run_random_gl.py --build build/release --profiles core --case "17 3,9,12"  these steps of a seed, calls shown

Each difference is minimised (steps are removed while it persists) and printed with its calls. The status is 1 if there
is one. A lost node is a difference, too. Seeds that differ between two native runs, or end the native run, are counted
and are no failures of Mural.
"""

import argparse
import difflib
import os
import shlex
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "end_to_end"))
from harness import display   # noqa: E402
from harness import length    # noqa: E402
from harness import programs  # noqa: E402

PROFILES = ["compat", "core", "es3", "es1"]
BATCH = 6            # seeds of one run
LAST_LINE = "picture"
NODE_LOST = " was lost"


class Transcript:
    """{case: [lines]}, the program's output, and its end."""

    def __init__(self, path, status, output):
        self.status, self.output, self.cases = status, output, {}
        if os.path.exists(path):
            for line in open(path, encoding="utf-8"):
                if line.endswith("\n"):
                    case, rest = line.rstrip("\n").split(" ", 1)
                    self.cases.setdefault(int(case), []).append(rest)

    def complete(self, case):
        lines = self.cases.get(case, [])
        return bool(lines) and lines[-1].startswith(LAST_LINE + " ")


def first_difference(one, other):
    """Returns (index, line of one, line of other); None: no difference."""
    for i in range(max(len(one), len(other))):
        pair = (one[i] if i < len(one) else "ended", other[i] if i < len(other) else "ended")
        if pair[0] != pair[1]:
            return (i,) + pair
    return None


class Bench:
    """Runs cases (a seed with its steps) natively and through Mural."""

    def __init__(self, arguments, display_name, folder):
        self.arguments, self.folder = arguments, folder
        self.environment = programs.clean_environment(display_name)
        self.environment["LP_NUM_THREADS"] = "0"  # the order of fragments is the order of the draws
        mural = os.path.join(arguments.build, "bin", "mural")
        self.launcher = [mural, "run", "--quiet", "--tiles", arguments.tiles] + arguments.options.split() + ["--"]
        self.program = os.path.join(arguments.build, "tests", "fuzz", "random_gl")
        self.extensions = {}

    def execute(self, profile, launcher, options, label):
        out = os.path.join(self.folder, label)
        if os.path.exists(out):
            os.unlink(out)
        command = launcher + [self.program, "--profile", profile, "--out", out] + options
        try:
            done = subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=self.arguments.limit, check=False)
            return Transcript(out, done.returncode, done.stdout.decode(errors="replace"))
        except subprocess.TimeoutExpired as late:
            return Transcript(out, None, (late.stdout or b"").decode(errors="replace"))

    def extension_file(self, profile):
        if profile not in self.extensions:
            # One session writes the files of all profiles.
            self.extensions = {name: os.path.join(self.folder, "extensions." + name) for name in {profile, *self.arguments.profiles.split(",")}}
            lines = ["%s --profile %s --out %s --print-extensions" % (shlex.quote(self.program), name, shlex.quote(path))
                     for name, path in sorted(self.extensions.items())]
            command = self.launcher + ["sh", "-c", " && ".join(lines)]
            done = subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=self.arguments.limit, check=False)
            if done.returncode != 0:
                raise SystemExit("run_random_gl: %s: %s" % (" ".join(command), done.stdout.decode(errors="replace")))
        return self.extensions[profile]

    def run(self, profile, cases, native, trace=False):
        """Returns a Transcript with the cases numbered from 0; cases after a crash run separately."""
        merged, first = None, 0
        while first < len(cases):
            path = os.path.join(self.folder, "cases")
            with open(path, "w", encoding="utf-8") as file:
                for seed, steps in cases[first:]:
                    file.write("%d %s\n" % (seed, ",".join(map(str, steps)) or "0"))
            options = ["--extensions", self.extension_file(profile), "--cases", path] + (["--trace"] if trace else [])
            part = self.execute(profile, [] if native else self.launcher, options, "transcript")
            numbered = {case + first: lines for case, lines in part.cases.items()}
            ended = max(part.cases, default=0)
            if merged is None:
                merged = part
                merged.cases = numbered
            else:
                merged.cases.update(numbered)
                merged.output += part.output
                merged.status = merged.status or part.status
            if part.complete(ended) and ended == len(cases) - first - 1:
                break
            first += ended + (0 if part.complete(ended) and ended > 0 and part.status == 0 else 1)
        return merged


class Hunt:
    def __init__(self, bench, arguments):
        self.bench, self.arguments = bench, arguments
        self.seeds = self.steps = self.unstable = self.crashes = 0
        self.faults = []

    def run(self, profiles, started):
        """Runs all profiles in turn, until the seeds or the time are exhausted."""
        first, last = self.arguments.first_seed, None
        if self.arguments.seeds:
            first, last = self.arguments.seeds
        if self.arguments.today:
            first = int(time.strftime("%Y%m%d", time.gmtime())) * 1000
            print("seeds of today: --first-seed %d repeats them" % first, flush=True)
        while last is None or first <= last:
            end = first + BATCH - 1 if last is None else min(first + BATCH - 1, last)
            for profile in profiles:
                self.batch(profile, range(first, end + 1))
                if self.arguments.seconds and time.monotonic() - started > self.arguments.seconds:
                    return
            first = end + 1

    def batch(self, profile, seeds):
        cases = [(seed, list(range(self.arguments.steps))) for seed in seeds]
        native = self.bench.run(profile, cases, True)
        through = self.bench.run(profile, cases, False)
        self.seeds += len(seeds)
        if NODE_LOST in through.output and all(native.complete(i) for i in range(len(cases))):
            print("%s seeds %d:%d: a node was lost" % (profile, seeds[0], seeds[-1]), flush=True)
            self.faults.append((profile, seeds[0], cases[0][1]))
        for i, (seed, steps) in enumerate(cases):
            self.steps += len(steps)
            if not native.complete(i):
                self.crashes += 1
                last = native.cases.get(i, ["begin"])[-1]
                print("%s seed %d: the native run ends after: %s" % (profile, seed, last), flush=True)
                continue
            difference = first_difference(native.cases[i], through.cases.get(i, []))
            if difference:
                self.difference(profile, seed, steps, difference)

    def difference(self, profile, seed, steps, difference):
        again = [self.bench.run(profile, [(seed, steps)], True).cases.get(0) for _ in range(2)]
        if again[0] != again[1]:
            self.unstable += 1
            print("%s seed %d: two native runs are not the same" % (profile, seed), flush=True)
            return
        print("%s seed %d differs:\n  native  %s\n  Mural   %s" % ((profile, seed) + difference[1:]), flush=True)
        # Steps after the first difference do not contribute to it.
        kept = steps[:difference[0]] if 0 < difference[0] <= len(steps) else steps
        if not self.arguments.no_shrink:
            kept = self.shrink(profile, seed, kept)
        self.faults.append((profile, seed, kept))
        self.show(profile, seed, kept)

    def differing(self, profile, cases):
        native = self.bench.run(profile, cases, True)
        through = self.bench.run(profile, cases, False)
        return [native.complete(i) and first_difference(native.cases[i], through.cases.get(i, [])) is not None
                for i in range(len(cases))]

    def shrink(self, profile, seed, steps):
        """Removes parts of decreasing size while the difference persists."""
        parts = 4
        if not self.differing(profile, [(seed, steps)])[0]:
            return steps
        while len(steps) > 1:
            parts = min(parts, len(steps))
            cuts = [len(steps) * i // parts for i in range(parts + 1)]
            fewer = [steps[:a] + steps[b:] for a, b in zip(cuts, cuts[1:])]
            answers = self.differing(profile, [(seed, candidate) for candidate in fewer])
            # All parts that can be removed one by one, if they can be removed together.
            spare = {step for (a, b), yes in zip(zip(cuts, cuts[1:]), answers) if yes for step in steps[a:b]}
            together = [step for step in steps if step not in spare]
            if sum(answers) > 1 and together and self.differing(profile, [(seed, together)])[0]:
                steps = together
            elif any(answers):
                steps = fewer[answers.index(True)]
                parts = max(parts - 1, 2)
            elif parts == len(steps):
                break
            else:
                parts *= 2
        return steps

    def show(self, profile, seed, steps):
        native = self.bench.run(profile, [(seed, steps)], True, trace=True)
        through = self.bench.run(profile, [(seed, steps)], False, trace=True)
        difference = first_difference(native.cases.get(0, []), through.cases.get(0, []))
        print("  small: --profiles %s --case \"%d %s\"" % (profile, seed, ",".join(map(str, steps))))
        if difference:
            print("    native  %s\n    Mural   %s" % difference[1:])
        lines = difflib.unified_diff(native.output.splitlines(), through.output.splitlines(), "native", "Mural", "", "", 4000, "")
        for line in [line for line in lines if line[0] != " " or not line.startswith("     state(")]:
            print("  " + line)
        sys.stdout.flush()


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--profiles", default=",".join(PROFILES))
    parser.add_argument("--tiles", default="2x2")
    parser.add_argument("--options", default="--display none", help="more options for `mural run`, in one string")
    parser.add_argument("--steps", type=int, default=150, help="of each seed")
    parser.add_argument("--seconds", type=float, help="stop after that long")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--today", action="store_true", help="seeds from one on that the date gives")
    parser.add_argument("--seeds", metavar="FIRST:LAST", type=span_of, help="these, and no more")
    parser.add_argument("--long-seeds", metavar="FIRST:LAST", type=span_of, help="instead of --seeds with MURAL_LONG_TESTS=1")
    parser.add_argument("--case", metavar="\"SEED STEPS\"", help="one case, with its calls")
    parser.add_argument("--limit", type=float, default=120, help="the longest that one run may take, in seconds")
    parser.add_argument("--no-shrink", action="store_true", help="show differences as they are found")
    return parser.parse_args()


def span_of(text):
    """Parses "17:20", or "17" alone."""
    try:
        numbers = [int(number) for number in text.split(":")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2) or numbers[0] > numbers[-1]:
        raise argparse.ArgumentTypeError("'%s' is not FIRST:LAST, as in 17:20" % text)
    return numbers[0], numbers[-1]


def main():
    arguments = parse_arguments()
    if length.LONG and arguments.long_seeds:
        arguments.seeds = arguments.long_seeds
    profiles = arguments.profiles.split(",")
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="mural-random.") as folder, display.PrivateDisplay("800x600x24") as name:
        hunt = Hunt(Bench(arguments, name, folder), arguments)
        if arguments.case:
            seed, steps = arguments.case.split()
            hunt.show(profiles[0], int(seed), [int(step) for step in steps.split(",")])
            return 0
        hunt.run(profiles, started)
    print("%d seeds, %d steps in %.0f s: %d differ; natively %d not the same twice, %d end the program"
          % (hunt.seeds, hunt.steps, time.monotonic() - started, len(hunt.faults), hunt.unstable, hunt.crashes))
    return 1 if hunt.faults else 0


sys.exit(main())
