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

from harness import display, pictures, programs

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


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--ways", help="only these, separated by commas: " + ", ".join(list(WAYS) + list(SMALL_WAY)))
    parser.add_argument("--size", default="253x191", help="of the window")
    parser.add_argument("--seconds", type=int, default=170, help="the longest that one run may take")
    arguments = parser.parse_args()
    chosen = arguments.ways.split(",") if arguments.ways else list(WAYS) + list(SMALL_WAY)
    unknown = [name for name in chosen if name not in WAYS and name not in SMALL_WAY]
    if unknown:
        parser.error("no way is called \"%s\"; there are: %s" % (unknown[0], ", ".join(list(WAYS) + list(SMALL_WAY))))
    arguments.chosen = chosen
    arguments.build = os.path.abspath(arguments.build)
    return arguments


def drawn_by_nodes(report):
    try:
        with open(report, encoding="utf-8") as file:
            return json.load(file)["frames"] >= len(CASES)
    except (OSError, ValueError, KeyError):
        return False


def draw(arguments, screen, folder, program, size, options=None):
    """Returns the frames of one run, in order; None and the messages if any is missing."""
    report = folder + ".json"
    launcher = [] if options is None else [os.path.join(arguments.build, "bin", "mural"), "run", "--quiet", "--display", "none", "--report", report] + options + ["--"]
    run = programs.run_program(arguments.build, program, folder, screen, size, len(CASES), launcher, arguments.seconds)
    frames = [path for _, path in sorted(run.frames().items())]
    if options is not None and not drawn_by_nodes(report):
        return None, "no frame was drawn by nodes; output: " + " | ".join(run.output.splitlines()[-3:])
    if run.status == 0 and len(frames) == len(CASES):
        return frames, ""
    return None, "status %s, %d pictures; output: %s" % (run.status, len(frames), " | ".join(run.output.splitlines()[-3:]))


def cell_of(wanted, got):
    difference = pictures.Difference()
    difference.add_pictures(pictures.read_ppm(wanted), pictures.read_ppm(got), "")
    return "0" if difference.pixels == 0 else "**%d, by %d**" % (difference.pixels, difference.largest)


def table_of(arguments, screen, scratch, program, title, size, ways):
    """Prints the table, and returns the number of cells that violate the requirement."""
    ways = {name: options for name, options in ways.items() if name in arguments.chosen}
    if not ways:
        return 0
    folder = os.path.join(scratch, program + size)
    native, printed = draw(arguments, screen, os.path.join(folder, "native"), program, size)
    if native is None:
        print("%s fails natively: %s" % (program, printed))
        return 1
    columns, wrong = {}, 0
    for name, options in ways.items():
        got, printed = draw(arguments, screen, os.path.join(folder, name.replace(" ", "_")), program, size, options)
        if got is None:
            print("%s, %s: %s" % (program, name, printed))
            wrong += 1
            continue
        columns[name] = [cell_of(a, b) for a, b in zip(native, got)]
    if not columns:
        return wrong
    print("\n%d pictures of %s pixels%s; pixels that differ from the native ones\n" % (len(CASES), size, title))
    print("| case | %s |\n|---|%s" % (" | ".join(columns), "---|" * len(columns)))
    for i, case in enumerate(CASES):
        cells = [column[i] for column in columns.values()]
        wrong += sum(cell != "0" for cell in cells)
        print("| %s | %s |" % (case, " | ".join(cells)), flush=True)
    shutil.rmtree(folder)
    return wrong


def main():
    arguments = parse_arguments()
    wrong = 0
    scratch = tempfile.mkdtemp(prefix="hard-cases.")
    try:
        with display.PrivateDisplay() as screen:
            for program, title in PROGRAMS.items():
                wrong += table_of(arguments, screen, scratch, program, title, arguments.size, WAYS)
            wrong += table_of(arguments, screen, scratch, "hard_cases", "", SMALL_SIZE, SMALL_WAY)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    print("\n%d cells are not 0" % wrong)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
