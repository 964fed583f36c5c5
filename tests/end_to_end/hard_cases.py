#!/usr/bin/env python3
"""Pictures in which rounding decides much, with every exact decomposition, compared with a native run: prints a table.

  hard_cases.py --build build/release
  hard_cases.py --build build/release --ways "2x2 tiles,3 ranges" --size 506x378

A cell is the number of pixels that differ from the program's native picture, and the largest difference; 0 is required.
The arithmetic that the pictures depend on has a table of its own: bin/numerics_test --gtest_brief=1.
"""

import argparse
import json
import os
import shutil
import sys
import tempfile

from harness import display, length, pictures, programs, shared_nodes

# Names of the frames of tests/programs/state/hard_cases.cpp, in its order.
CASES = ["coplanar, GL_LESS, D24", "coplanar, GL_LEQUAL, D24", "near 10^-3, far 10^7", "near 10^-4, far 10^6", "far plane infinitely far", "far plane lost in floats",
         "reversed Z", "world at 10^6, matrices by the program", "eye 1 cm from a wall", "through the near plane, ground of 10^5", "lines and points of 1 pixel",
         "lines of 7, points of 9 pixels", "stippled lines and strips", "smooth lines", "mipmaps, anisotropy, derivatives", "gl_FragCoord, stipples, raster position",
         "rays and sprites by the screen's size", "four viewports, clears in scissors", "through a texture with D32F", "flat, first and last vertex",
         "200 layers, alpha 0.3", "200 layers, alpha 0.03", "200 layers, added"]

WAYS = {"2x2 tiles": ["--tiles", "2x2"], "7x5 tiles on 4 nodes": ["--tiles", "7x5", "--local-nodes", "4"],
        "3x2 culled": ["--tiles", "3x2", "--tiling", "culled", "--local-nodes", "4"], "3 ranges": ["--db", "3"], "3 turns": ["--dplex", "3"],
        "2x1 tiles of 2 ranges": ["--tiles", "2x1", "--db", "2", "--local-nodes", "4"]}
# The same with tiles of one pixel each. The picture is small, because each tile has a cost.
SMALL_SIZE, SMALL_WAY = "37x23", {"tiles of 1 pixel": ["--tiles", "37x23", "--local-nodes", "3"]}
PROGRAMS = {"hard_cases": "", "hard_cases_samples": ", 4 samples"}
# "7x5 tiles on 4 nodes" includes its borders.
LONG_WAYS = ("2x2 tiles",)
# of the ways, those that short runs also try with samples
SAMPLED_WAYS = ("3x2 culled", "3 turns", "2x1 tiles of 2 ranges")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--ways", help="only these, separated by commas: " + ", ".join(list(WAYS) + list(SMALL_WAY)))
    parser.add_argument("--size", default="253x191", help="of the window")
    parser.add_argument("--seconds", type=int, default=170, help="the longest that one run may take")
    arguments = parser.parse_args()
    chosen = arguments.ways.split(",") if arguments.ways else [way for way in list(WAYS) + list(SMALL_WAY) if length.LONG or way not in LONG_WAYS]
    unknown = [name for name in chosen if name not in WAYS and name not in SMALL_WAY]
    if unknown:
        parser.error("no way is called \"%s\"; there are: %s" % (unknown[0], ", ".join(list(WAYS) + list(SMALL_WAY))))
    arguments.chosen = chosen
    arguments.build = os.path.abspath(arguments.build)
    return arguments


def pictures_of(run):
    """Returns the frames of one run, in order; None and the messages if any is missing."""
    frames = [path for _, path in sorted(run.frames().items())]
    if run.status == 0 and len(frames) == len(CASES):
        return frames, ""
    return None, "status %s, %d pictures; output: %s" % (run.status, len(frames), " | ".join(run.output.splitlines()[-3:]))


def frames_of(report):
    try:
        with open(report, encoding="utf-8") as file:
            return json.load(file)["frames"]
    except (OSError, ValueError, KeyError):
        return 0


def draw(arguments, screen, folder, names, size, options):
    """Returns for each program its frames, and the messages if any is missing. One session draws all programs."""
    report = folder + ".json"
    launcher = [os.path.join(arguments.build, "bin", "mural"), "run", "--quiet", "--display", "none", "--report", report] + options + ["--"]
    nodes = shared_nodes.SharedNodes(launcher, screen, folder)
    drawn = {name: pictures_of(nodes.run_program(arguments.build, name, os.path.join(folder, name), size, len(CASES), arguments.seconds)) for name in names}
    status, frames = nodes.end(arguments.seconds), frames_of(report)
    if status == 0 and frames >= len(names) * len(CASES):
        return drawn
    return {name: (None, drawn[name][1] or "status %s, %d frames drawn by nodes" % (status, frames)) for name in names}


def cell_of(wanted, got):
    difference = pictures.Difference()
    difference.add_pictures(pictures.read_ppm(wanted), pictures.read_ppm(got), "")
    return "0" if difference.pixels == 0 else "**%d, by %d**" % (difference.pixels, difference.largest)


def columns_of(arguments, screen, folder, size, ways, programs_of):
    """Compares with native pictures. Returns {program: {way: cells}}, and the number of pictures that could not be drawn.
    programs_of: function(way) → programs."""
    ways = {name: options for name, options in ways.items() if name in arguments.chosen}
    native, columns, wrong = {}, {}, 0
    for way, options in ways.items():
        for program in programs_of(way):
            if program not in native:
                native[program], printed = pictures_of(programs.run_program(arguments.build, program, os.path.join(folder, "native", program), screen, size, len(CASES), (), arguments.seconds))
                if native[program] is None:
                    raise SystemExit("%s fails natively: %s" % (program, printed))
        for program, (got, printed) in draw(arguments, screen, os.path.join(folder, way.replace(" ", "_")), programs_of(way), size, options).items():
            if got is None:
                print("%s, %s: %s" % (program, way, printed))
                wrong += 1
            else:
                columns.setdefault(program, {})[way] = [cell_of(a, b) for a, b in zip(native[program], got)]
    return columns, wrong


def print_table(columns, size, title):
    """Returns the number of cells that violate the requirement."""
    print("\n%d pictures of %s pixels%s; pixels that differ from the native ones\n" % (len(CASES), size, title))
    print("| case | %s |\n|---|%s" % (" | ".join(columns), "---|" * len(columns)))
    wrong = 0
    for i, case in enumerate(CASES):
        cells = [column[i] for column in columns.values()]
        wrong += sum(cell != "0" for cell in cells)
        print("| %s | %s |" % (case, " | ".join(cells)), flush=True)
    return wrong


def main():
    arguments = parse_arguments()
    wrong = 0
    several = lambda way: [name for name in PROGRAMS if name == "hard_cases" or way in SAMPLED_WAYS or length.LONG or arguments.ways]
    scratch = tempfile.mkdtemp(prefix="hard-cases.")
    try:
        with display.PrivateDisplay() as screen:
            for size, ways, programs_of in ((arguments.size, WAYS, several), (SMALL_SIZE, SMALL_WAY, lambda way: ["hard_cases"])):
                columns, missing = columns_of(arguments, screen, os.path.join(scratch, size), size, ways, programs_of)
                wrong += missing + sum(print_table(columns[name], size, PROGRAMS[name]) for name in PROGRAMS if name in columns)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    print("\n%d cells are not 0" % wrong)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
