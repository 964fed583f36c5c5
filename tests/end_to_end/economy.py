#!/usr/bin/env python3
"""What goes to the nodes, with economy: little where frames are alike, and the pictures are right.

  economy.py --build build/release [--cases same_scene,same_texture] [--list]
"""

import json
import os
import sys
import tempfile

import failures

failures.CASES.clear()  # keeps only the cases of this file
PATCH_BYTES = 64 * 64 * 4


def report_of(context, program, frames, *options):
    """The report of a run; a text when it went wrong."""
    with tempfile.TemporaryDirectory(prefix="mural-economy.") as folder:
        report_file = os.path.join(folder, "report.json")
        command = [context.program(program), "--frames", str(frames), "--size", "253x191"]
        with context.run(command, ["--display", "none", "--quiet", "--report", report_file, *options]) as run:
            wrong = failures.check_end(run, 0)
            if wrong is not None:
                return wrong
        with open(report_file, encoding="utf-8") as file:
            return json.load(file)


def verified(context, program, frames, *options, every=1):
    """The same, of a run whose pictures were right; each so many frames are compared."""
    report = report_of(context, program, frames, "--economy", "on", "--verify=%d" % every, *options)
    if isinstance(report, dict) and (report["verifiedFrames"] != frames // every or report["differingPixels"] != 0):
        return "%s %s: %d frames verified, %d pixels differ" % (program, " ".join(options), report["verifiedFrames"], report["differingPixels"])
    return report


def per_frame(case_name, program, at_least, at_most, frames=(4, 10)):
    """Between a run of few and one of more frames lie frames that nodes know all but the news of."""
    def check(context):
        wire = []
        for count in frames:
            report = report_of(context, program, count, "--economy", "on")
            if not isinstance(report, dict):
                return report
            if report["frames"] != count:
                return "%d frames instead of %d" % (report["frames"], count)
            wire.append(report["economy"]["wireBytes"])
        each = (wire[1] - wire[0]) / (frames[1] - frames[0])
        if not at_least <= each <= at_most:
            return "%.0f bytes per frame on the wire instead of %d to %d; in all %s" % (each, at_least, at_most, wire)
        print("  %.0f bytes per frame on the wire" % each)
        return None
    check.__name__ = case_name
    failures.case(check)


per_frame("same_scene", "same_scene", 0.5, 100, (10, 310))  # measured times select the coding of the first frames
per_frame("same_texture", "same_texture", 1, 1024)
per_frame("changed_texture", "changed_texture", PATCH_BYTES, 1.5 * PATCH_BYTES + 1024)

# Values of 16 to 36 kB that recur in random order: a source, vertices, or an image costs only a reference.
for value in ("same_sources", "same_arrays", "same_pixels"):
    per_frame(value, value, 1, 300, (30, 90))


@failures.case
def verified_values(context):
    for program in ("same_sources", "same_arrays", "same_pixels"):
        report = verified(context, program, 10, "--tiles", "2x1")
        if not isinstance(report, dict):
            return report
    return None


@failures.case
def verified_texture(context):
    """Patches arrive where they belong; also with a store that is too small for the texture."""
    for store in ("1GiB", "1MiB"):
        report = verified(context, "changed_texture", 3, "--store", store)
        if not isinstance(report, dict):
            return report
    return None


def left_out_of(report):
    e, frames = report["economy"], report["frames"]
    print("  %d records held, %d left out; %.0f of %.0f kB per frame" % (e["heldRecords"], e["leftOutRecords"], e["rawBytes"] / frames / 1e3, e["programBytes"] / frames / 1e3))
    return e


@failures.case
def late_uploads(context):
    """What is replaced, the same again, or never drawn with does not go; what is drawn with late goes late."""
    report = verified(context, "late_uploads", 103)
    if not isinstance(report, dict):
        return report
    e = left_out_of(report)
    # Dropped per frame, at least: two of three textures and of three buffers, two of four parts, the unused, the equal
    # and the deleted one.
    if e["leftOutRecords"] < 900 or e["heldRecords"] < 600 or e["rawBytes"] > 0.7 * e["programBytes"]:
        return "too little was left out: %s" % e
    return None


@failures.case
def equal_state(context):
    """State that is as it was, or set again before a draw, stays behind, and the pictures are right.

    Whether frames go on without it is chosen by what they cost, CPU time with it, which another load of the machine makes longer: that it is chosen where
    it is cheaper is asserted without a clock (tests/holding/small_choice_test.cpp). Here at least it is tried.
    """
    report = verified(context, "equal_state", 300, every=10)
    if not isinstance(report, dict):
        return report
    e = left_out_of(report)
    # Each of 48 objects makes 2 x 19 state changes, of which at least 30 have no effect on its draw. That is over 1 400
    # per frame, in at least eight frames of a run.
    if e["leftOutRecords"] < 8 * 1400 or e["programBytes"] - e["rawBytes"] < 0.4 * 8 / 300 * e["programBytes"]:
        return "too little was left out: %s" % e
    return None


@failures.case
def off(context):
    """Nodes of this machine are sent everything, unless asked otherwise."""
    report = report_of(context, "same_scene", 5)
    if not isinstance(report, dict):
        return report
    return None if report["economy"] is None and report["bytesPerFrame"] > 1000 else "the report says %s" % report


if __name__ == "__main__":
    sys.exit(failures.main())
