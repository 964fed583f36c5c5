#!/usr/bin/env python3
"""Traffic to the nodes with delta coding: little for similar frames, with exact pictures.

delta.py --build build/release [--cases same_scene,same_texture] [--list]
"""

import json
import os
import shlex
import sys
import tempfile

from harness import cases, length

PATCH_BYTES = 64 * 64 * 4
ENVIRONMENT = {"TEXTURE_SIDE": "4096" if length.LONG else "1024"}


def report_of(context, names, frames, *options):
    """Returns the report of one session that draws programs one after another, or an error text. names: separated by
    spaces."""
    with tempfile.TemporaryDirectory(prefix="mural-delta.") as folder:
        report_file = os.path.join(folder, "report.json")
        commands = [shlex.join([context.program(name), "--frames", str(frames), "--size", "253x191"]) for name in names.split()]
        command = ["sh", "-c", " && ".join(commands)] if len(commands) > 1 else shlex.split(commands[0])
        with context.run(command, ["--display", "none", "--quiet", "--report", report_file, *options], ENVIRONMENT) as run:
            wrong = cases.check_end(run, 0)
            if wrong is not None:
                return wrong
        with open(report_file, encoding="utf-8") as file:
            return json.load(file)


def verified(context, names, frames, *options, every=1):
    """Returns the report of a run with exact pictures; every Nth frame is compared."""
    report = report_of(context, names, frames, "--delta", "on", "--verify=%d" % every, *options)
    if isinstance(report, dict) and (report["verifiedFrames"] != len(names.split()) * (frames // every) or report["differingPixels"] != 0):
        return "%s %s: %d frames verified, %d pixels differ" % (names, " ".join(options), report["verifiedFrames"], report["differingPixels"])
    return report


def per_frame(case_name, program, at_least, at_most, frames=(4, 10)):
    """Compares a run of few frames with one of more: nodes know all data of the additional frames except the changes."""
    def check(context):
        wire = []
        for count in frames:
            report = report_of(context, program, count, "--delta", "on")
            if not isinstance(report, dict):
                return report
            if report["frames"] != count:
                return "%d frames instead of %d" % (report["frames"], count)
            wire.append(report["delta"]["wireBytes"])
        each = (wire[1] - wire[0]) / (frames[1] - frames[0])
        if min(wire) <= 0:
            return "no bytes on the wire were counted: %s" % wire
        if not at_least <= each <= at_most:
            return "%.0f bytes per frame on the wire instead of %d to %d; in all %s" % (each, at_least, at_most, wire)
        print("  %.0f bytes per frame on the wire" % each)
        return None
    check.__name__ = case_name
    cases.case(check)


# Measured times select the coding of the first frames, so the totals of two runs differ by some bytes in either direction.
per_frame("same_scene", "same_scene", 0.5, 100, (10, 110))
per_frame("same_texture", "same_texture", -1024, 1024)
per_frame("changed_texture", "changed_texture", PATCH_BYTES, 1.5 * PATCH_BYTES + 1024)

# Values of 16 to 36 kB that recur in random order: a source, vertices, or an image costs only a reference. Measured times
# select the compression of the first values, so the totals of two runs differ by up to 8 kB in either direction.
for value in ("same_sources", "same_arrays", "same_pixels"):
    per_frame(value, value, -8192 / 60, 300, (30, 90))


@cases.case
def verified_values(context):
    report = verified(context, "same_sources same_arrays same_pixels", 10, "--tiles", "2x1")
    return None if isinstance(report, dict) else report


@cases.case
def verified_texture(context):
    """Patches arrive at their position, also with a store that is too small for the texture."""
    for store in ("1GiB", "1MiB"):
        report = verified(context, "changed_texture", 3, "--cache-size", store)
        if not isinstance(report, dict):
            return report
    return None


def left_out_of(report):
    e, frames = report["delta"], report["frames"]
    print("  %d records held, %d left out; %.0f of %.0f kB per frame" % (e["deferredRecords"], e["droppedRecords"], e["rawBytes"] / frames / 1e3, e["programBytes"] / frames / 1e3))
    return e


@cases.case
def late_uploads(context):
    """Uploads that are replaced, unchanged, or never drawn are not sent; uploads that are drawn late are sent late."""
    report = verified(context, "late_uploads", 103)
    if not isinstance(report, dict):
        return report
    e = left_out_of(report)
    # Dropped per frame, at least: two of three textures and of three buffers, two of four parts, the unused, the equal
    # and the deleted one.
    if e["droppedRecords"] < 900 or e["deferredRecords"] < 600 or e["rawBytes"] > 0.7 * e["programBytes"]:
        return "too little was left out: %s" % e
    return None


@cases.case
def equal_state(context):
    """State that does not change, or is set again before a draw, is not sent, and the pictures are exact.

    The filter decides by CPU time whether it skips frames, and other load of the machine makes that time longer. A test
    without a clock asserts the choice where it is cheaper (tests/filter/redundancy_tuner_test.cpp). Here it is at least
    tried."""
    report = verified(context, "equal_state", 300, every=10)
    if not isinstance(report, dict):
        return report
    e = left_out_of(report)
    # Each of 48 objects makes 2 x 19 state changes, and at least 30 have no effect on its draw. That is over 1 400
    # per frame, in at least eight frames of a run.
    if e["droppedRecords"] < 8 * 1400 or e["programBytes"] - e["rawBytes"] < 0.4 * 8 / 300 * e["programBytes"]:
        return "too little was left out: %s" % e
    return None


@cases.case
def off(context):
    """Nodes of this machine receive everything, unless configured otherwise."""
    report = report_of(context, "same_scene", 5)
    if not isinstance(report, dict):
        return report
    return None if report["delta"] is None and report["bytesPerFrame"] > 1000 else "the report says %s" % report


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
