"""Pictures of programs, without Mural and of the wall, and their comparison. Several cases share a run."""

import itertools
import os
import shlex
import tempfile

from harness import cases, pictures, programs

FRAMES = 4
SIZE = (253, 191)


def case(function):
    """Registers a case, and prints its result after its measurements."""
    def measured(context):
        notes = []
        wrong = function(context, notes)
        if notes:
            print("%-32s %s" % (function.__name__, "; ".join(notes)))
        return wrong
    measured.__name__ = function.__name__
    cases.case(measured)
    return function


NATIVE = {}  # pictures by program, arguments, size and number of frames: several cases compare with them


def native(context, program, arguments=(), size=SIZE, frames=FRAMES):
    """Returns the pictures of all frames of the first window, without Mural."""
    key = program, tuple(arguments), size, frames
    if key not in NATIVE:
        NATIVE[key] = drawn_natively(context, program, arguments, size, frames)
    return NATIVE[key]


def drawn_natively(context, program, arguments, size, frames):
    with tempfile.TemporaryDirectory(prefix="mural-pictures.") as folder:
        run = programs.run_program(context.build, program, os.path.join(folder, "native"), context.display,
                                   "%dx%d" % size, frames, arguments=arguments)
        if run.status != 0:
            raise SystemExit("%s fails natively: %s" % (program, run.output))
        return [pictures.read_ppm(path) for name, path in sorted(run.frames().items()) if name.startswith("w0/")]


def through(context, options, program, arguments=(), size=SIZE, frames=FRAMES):
    """Returns the pictures that the head has combined, in the order of --out."""
    return through_all(context, options, [(program, arguments)], size, frames)[0]


def through_all(context, options, scenes, size=SIZE, frames=FRAMES, counts=None):
    """Returns the pictures of each (program, arguments). One session draws all of them, one after another: most of a
    session's time is its start. counts: pictures of each scene, if programs show more than one per frame."""
    counts = counts or [frames] * len(scenes)
    commands = [[context.program(program), "--frames", str(frames), "--size", "%dx%d" % size] + list(arguments) for program, arguments in scenes]
    # A program that fails ends the session with its status.
    command = commands[0] if len(commands) == 1 else ["sh", "-c", " && ".join(map(shlex.join, commands))]
    with tempfile.TemporaryDirectory(prefix="mural-pictures.") as folder:
        with context.run(command, ["--display", "none", "--out", folder] + list(options)) as run:
            wrong = cases.check_end(run, 0)
            if wrong is not None:
                raise AssertionError(wrong)
        names = sorted(os.listdir(folder))
        drawn = [pictures.read_png(os.path.join(folder, name)) for name in names]
    if len(scenes) == 1:
        return [drawn]
    if len(drawn) != sum(counts):
        raise AssertionError("%d pictures of %s instead of %s" % (len(drawn), [program for program, _ in scenes], counts))
    ends = list(itertools.accumulate(counts))
    return [drawn[end - count:end] for end, count in zip(ends, counts)]


def of_programs(names):
    """Returns scenes of programs without arguments."""
    return [(name, ()) for name in names]


SESSIONS = {}  # pictures by options, then by (program, arguments)


def in_session(context, options, scene, scenes):
    """Returns the pictures of one (program, arguments) of a session that draws all `scenes`. Cases share the session."""
    key = tuple(options)
    if key not in SESSIONS:
        SESSIONS[key] = dict(zip(scenes, through_all(context, options, scenes)))
    return SESSIONS[key][scene]


def differing(expected, got):
    """Returns None, or the number of differing pixels and the first position."""
    if len(expected) != len(got):
        return "%d pictures instead of %d" % (len(got), len(expected))
    difference = pictures.Difference()
    for number, (first, second) in enumerate(zip(expected, got)):
        difference.add_pictures(first, second, "frame %d" % number)
    return None if difference.pixels == 0 else "%d pixels differ, largest %d, %s" % (
        difference.pixels, difference.largest, difference.place)


def first_wrong(results):
    """Returns the first error of {name: None or error}."""
    return next(("%s: %s" % item for item in results.items() if item[1] is not None), None)
