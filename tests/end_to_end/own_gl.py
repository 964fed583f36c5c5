#!/usr/bin/env python3
"""Programs with a GL library that GLVND does not load. Either the preloaded library captures them exactly, or one line
reports that their calls bypass Mural.

  own_gl.py --build build/release [--cases caught,reported] [--list]
"""

import json
import os
import sys
import tempfile

from harness import cases, length, session

FRAMES = 3
OPTIONS = ["--tiles", "2x1", "--display", "none", "--verify"]


def libraries(context, kind):
    return os.path.join(context.build, "tests", "programs", "own_gl", kind)


def caught(case_name, program, kind, options=(), in_script=False, more=None):
    """Adds a case: the program with the GL library of that folder is exact, frame by frame."""
    def check(context):
        with tempfile.TemporaryDirectory(prefix="mural-own-gl.") as folder:
            report_file = os.path.join(folder, "report.json")
            command = [context.program(program), "--frames", str(FRAMES), "--size", "253x191"]
            environment = {"LD_LIBRARY_PATH": libraries(context, kind), **(more or {})}
            if in_script:
                command = ["sh", "-c", 'LD_LIBRARY_PATH="$0" exec "$@"', libraries(context, kind)] + command
                environment = None
            with context.run(command, OPTIONS + ["--report", report_file] + list(options), environment) as run:
                wrong = cases.check_end(run, 0)
                if wrong is not None:
                    return wrong
                printed = cases.error_lines(run, ["bypass", "two GL libraries", "no frame was captured"])
                if printed:
                    return "output: " + " | ".join(printed)
            with open(report_file, encoding="utf-8") as file:
                report = json.load(file)
        if report["frames"] != FRAMES:
            return "%d frames instead of %d" % (report["frames"], FRAMES)
        if report["verifiedPixels"] == 0 or report["differingPixels"] != 0:
            return "%d of %d pixels differ" % (report["differingPixels"], report["verifiedPixels"])
        return None
    check.__name__ = "caught_" + case_name
    cases.case(check)


for name in (*length.some(("client_arrays", "immediate", "display_lists", "core_arrays", "threads_windows", "textures_classic", "shared_contexts", "glsl_legacy"), 4),
             "route_dlsym", "route_deepbind", "route_glx_proc", "route_plugin"):
    caught(name, name, "glx")
caught("es2", "es2_scene", "egl")
caught("egl_proc", "route_egl_proc", "egl")
caught("once_by_both_entries", "immediate", "forwarding")
caught("once_by_both_entries_dlsym", "route_dlsym", "forwarding")
caught("glvnd_with_preload", "immediate", "none", ("--capture-via", "preload"))
caught("glvnd_with_preload_dlsym", "route_dlsym", "none", ("--capture-via", "preload"))
# The advice in the message of reported_mixed_….
caught("mixed_linked_when_glvnd_is_first", "mixed_linked", "none", more={"LD_PRELOAD": "libGL.so.1"})
caught("in_script_on_request", "immediate", "glx", ("--capture-via", "preload"), in_script=True)


def reported(case_name, program, words, in_script=None, options=(), output=None, shell=None, status=0):
    """Adds a case: the program, or a line of shell, runs as without Mural, and one line says why the wall shows nothing
    of it."""
    def check(context):
        command = ["sh", "-c", shell] if shell else [context.program(program), "--frames", str(FRAMES), "--size", "253x191"]
        if in_script is not None:
            command = ["sh", "-c", 'LD_LIBRARY_PATH="$0" exec "$@"', libraries(context, in_script)] + command
        with tempfile.TemporaryDirectory(prefix="mural-own-gl.") as folder:
            report_file = os.path.join(folder, "report.json")
            fixed = ["--tiles", "1x1", "--display", "none", "--quiet", "--report", report_file]
            with context.run(command, fixed + list(options)) as run:
                wrong = cases.check_end(run, status)
                if wrong is not None:
                    return wrong
            with open(report_file, encoding="utf-8") as file:
                frames = json.load(file)["frames"]
            if frames != 0:
                return "%d frames are on the wall" % frames
        printed = [line for line in run.standard_error if line.startswith("mural:")]
        if len(printed) != 1 or not all(word in printed[0] for word in words):
            return "it printed %d lines: %s" % (len(printed), " | ".join(printed))
        if output is not None and output not in run.standard_output:
            return "the program printed: " + " | ".join(run.standard_output)
        return None
    check.__name__ = "reported_" + case_name
    cases.case(check)


reported("own_gl_in_script", "immediate", ["own_gl/glx/libGL.so.1", "--capture-via preload"], "glx")
reported("own_gl_with_preload_off", "immediate", ["own_gl/glx/libGL.so.1", "--capture-via preload"], "glx", ("--capture-via", "glvnd"))
reported("osmesa", "osmesa_window", ["OSMesa", "libOSMesa.so", "no frame was captured"])
reported("drawn_elsewhere", "route_glapi", ["bypass Mural", "--capture-via preload"], output="the window shows the picture")
for name, library in (("mixed_glx_driver", "libGLX_mesa.so.0"), ("mixed_glx_osmesa", "libOSMesa.so.8"),
                      ("mixed_egl_osmesa", "libOSMesa.so.8"), ("mixed_linked", "libOSMesa.so.8")):
    reported(name, name, ["some GL calls of the program", library, "LD_PRELOAD=libGL.so.1"], output="the window shows the whole picture")
reported("x11_only", "x11_window", ["loads no GL library"])
# For a program that fails early, missing libraries mean nothing.
reported("failed_early", None, ["sh ended before it created a GL context (exit status 3)", "mural doctor"], shell="exit 3", status=3)
reported("killed_early", None, ["sh ended before it created a GL context (signal 9 (Killed))"], shell="kill -9 $$", status=137)
reported("never_tried", None, ["sh made no GL calls through Mural"], shell="exit 0")


SILENT_FRAMES = 5
MORE_FRAMES = {"front_buffer": 3 * SILENT_FRAMES}  # programs that also show pictures without a swap


def silent(case_name, *names):
    """Adds a case: Mural itself changes the pixels of the programs' windows, so no line is printed, and all frames are
    on the wall. The programs share a session; each of their processes watches its own windows."""
    wanted = sum(MORE_FRAMES.get(name, SILENT_FRAMES) for name in names)

    def check(context):
        command = ["sh", "-c", 'for program; do "$program" --frames %d --size 253x191 || exit; done' % SILENT_FRAMES, "sh"]
        with tempfile.TemporaryDirectory(prefix="mural-own-gl.") as folder:
            report_file = os.path.join(folder, "report.json")
            with context.run(command + [context.program(name) for name in names],
                             ["--tiles", "2x1", "--display", "none", "--quiet", "--report", report_file]) as run:
                wrong = cases.check_end(run, 0)
                if wrong is not None:
                    return wrong
                if run.standard_error:
                    return "output: " + " | ".join(run.standard_error)
            with open(report_file, encoding="utf-8") as file:
                frames = json.load(file)["frames"]
        return None if frames >= wanted else "%d frames instead of %d are on the wall" % (frames, wanted)
    check.__name__ = "silent_" + case_name
    cases.case(check)


SILENT = length.some(("immediate", "display_lists", "x_fonts", "feedback_select", "front_buffer", "pixels_draw", "pixels_read", "framebuffers",
                      "single_buffered", "window_churn", "resize", "window_switch", "several_windows", "threads_windows",
                      "x_pixmaps", "context_migration", "egl_desktop", "shared_contexts", "es2_scene"))
if length.LONG:
    for name in SILENT:
        silent(name, name)
else:
    silent("in_turn", *SILENT)


PRINTING = ("extension_strings", "gl_extensions", "kept_names", "memory_import")
PRINTED = {}  # their lines through Mural


def printed_by(context, program):
    """Returns an error or None, and the program's lines through Mural. All these programs share a session."""
    if not PRINTED:
        command = ["sh", "-c", 'for program; do "$program" || exit; echo "end of $program"; done', "sh"] + [context.program(name) for name in PRINTING]
        with context.run(command, ["--display", "none", "--quiet"]) as run:
            wrong = cases.check_end(run, 0)
            if wrong is not None:
                return wrong, []
        lines = []
        for line in run.standard_output:
            if line.startswith("end of "):
                PRINTED[os.path.basename(line)] = lines
                lines = []
            else:
                lines.append(line)
    return None, PRINTED[program]


def printed_is(context, program, expected):
    """Returns an error if the program's one line through Mural is not as expected."""
    wrong, lines = printed_by(context, program)
    return wrong if wrong is not None or lines == [expected] else "the program printed: " + " | ".join(lines)


@cases.case
def reported_extensions_of_all_machines(context):
    """Checks that no list of a window system's extensions names one that exists only on one machine."""
    return printed_is(context, "extension_strings", "0 of 5 lists name what is on one machine only")


@cases.case
def reported_extensions_in_order(context):
    """Checks that GL_EXTENSIONS keeps the driver's order: old programs read only the first kilobytes of the text."""
    with session.Session([context.program("gl_extensions")], context.display) as run:
        wrong = cases.check_end(run, 0)
        if wrong is not None:
            return wrong
        natively = list(run.standard_output)
    wrong, through = printed_by(context, "gl_extensions")
    if wrong is not None:
        return wrong
    native, reported = ([line.split() for line in lines] for lines in (natively, through))
    if [line[0] for line in reported] != ["text", "names", "beyond"] or reported[2] != native[2]:
        return "the program printed: %s, natively: %s" % (reported, native)
    for own, drivers in zip(reported[:2], native[:2]):
        kept = [name for name in drivers if name in own]
        if own != kept or len(own) < 100:
            return "%s: %d names, not in the driver's order" % (own[0], len(own) - 1)
    return None


@cases.case
def reported_names_stay(context):
    """Checks that extension names are still readable after the end of EGL, which unloads the driver."""
    return printed_is(context, "kept_names", "names, 0 gone")


@cases.case
def reported_memory_of_other_apis(context):
    """Checks that memory objects have no memory, and that their device matches none of another API."""
    expected = "object 1, one UUID 1, import 0x%04x, descriptor left 1, storage 0x%04x" % (0x0502, 0x0502)
    return printed_is(context, "memory_import", expected)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
