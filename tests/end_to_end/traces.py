#!/usr/bin/env python3
"""Traces of programs' GL streams: a replay, on any nodes, shows the program's native pictures.

traces.py --build build/release [--cases replay,trim] [--list]
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from harness import cases, length, pictures, programs, session

FRAMES = 6
SIZE = (253, 191)
RECORD = ("--display", "none", "--tiles", "1x1")
LAYOUTS = ("1x1", "2x2") if length.LONG else ("2x2",)
RECORDED = {}  # bytes and pictures of traces by their programs, because several cases need the same


class Workplace:
    """A folder with traces and pictures, and the commands that make them."""

    def __init__(self, context, folder):
        self.context = context
        self.folder = folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def session(self, arguments, environment=None):
        return session.Session([self.context.mural] + list(arguments), self.context.display, environment)

    def record(self, *names, options=RECORD, frames=FRAMES):
        """Records programs, which run one after the other, into a.mural, and returns their pictures of --out."""
        key = (names, options, frames)
        if key not in RECORDED:
            RECORDED[key] = self._record(names, options, frames)
        whole, live = RECORDED[key]
        with open(self.path("a.mural"), "wb") as file:
            file.write(whole)
        return live

    def _record(self, names, options, frames):
        out = self.path("live")
        shutil.rmtree(out, ignore_errors=True)
        command = [self.context.program(names[0]), "--size", "%dx%d" % SIZE, "--frames", str(frames)]
        if len(names) > 1:
            command = ["sh", "-c", 'for program; do "$program" %s || exit; done' % " ".join(command[1:]), "sh"] + [self.context.program(name) for name in names]
        with self.context.run(command, list(options) + ["--record", self.path("a.mural"), "--out", out]) as run:
            self.check(run, 0)
        with open(self.path("a.mural"), "rb") as file:
            return file.read(), shown(out)

    def replay(self, options, file="a.mural", environment=None):
        out = self.path("replayed")
        shutil.rmtree(out, ignore_errors=True)
        with self.session(["replay", self.path(file), "--display", "none", "--out", out] + list(options), environment) as run:
            self.check(run, 0)
        return shown(out)

    def trim(self, frames, file="a.mural", into="b.mural"):
        """Trims a trace, and returns the messages."""
        done = self.mural("trim", self.path(file), frames, "-o", self.path(into))
        if done.returncode != 0:
            raise AssertionError("trim fails: " + done.stderr)
        return done.stdout + done.stderr

    def mural(self, *arguments):
        return subprocess.run([self.context.mural] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=60,
                              env=programs.clean_environment(self.context.display), check=False)

    def refused(self, words, *arguments, status=2):
        """Returns None if the only message is one line with these words, and standard output is empty."""
        done = self.mural(*arguments)
        if done.returncode == status and done.stderr.count("\n") == 1 and words in done.stderr and not done.stdout:
            return None
        return "mural %s: status %d, %d lines, %s" % (" ".join(arguments), done.returncode, done.stdout.count("\n"), done.stderr.strip())

    def change(self, into, change):
        """Writes another file from the bytes of a.mural."""
        with open(self.path("a.mural"), "rb") as file:
            whole = bytearray(file.read())
        with open(self.path(into), "wb") as file:
            file.write(change(whole))

    def native(self, program, arguments=(), frames=FRAMES):
        """Returns the pictures of all frames, by window."""
        shutil.rmtree(self.path("native"), ignore_errors=True)
        run = programs.run_program(self.context.build, program, self.path("native"), self.context.display, "%dx%d" % SIZE, frames, arguments=arguments)
        if run.status != 0:
            raise AssertionError("%s fails natively: %s" % (program, run.output))
        windows = {}
        for name, path in sorted(run.frames().items()):
            windows.setdefault(name.split("/")[0], []).append(pictures.read_ppm(path))
        return windows

    @staticmethod
    def check(run, status):
        wrong = cases.check_end(run, status)
        if wrong is not None:
            raise AssertionError(wrong)


def flipped(whole, at):
    whole[at] ^= 0x40
    return whole


def shown(folder):
    names = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    return [pictures.read_png(os.path.join(folder, name)) for name in names]


def differing(expected, got):
    """Returns None, or the number of differing pixels and the first position."""
    if not expected or len(expected) != len(got):
        return "%d pictures instead of %d" % (len(got), len(expected))
    difference = pictures.Difference()
    for number, (first, second) in enumerate(zip(expected, got)):
        difference.add_pictures(first, second, "frame %d" % (number + 1))
    return None if difference.pixels == 0 else "%d pixels differ, largest %d, %s" % (difference.pixels, difference.largest, difference.place)


def alike(expected, got):
    return bool(expected) and len(expected) == len(got) and all(a.rows == b.rows for a, b in zip(expected, got))


def unlike_all(windows, got):
    """Returns None if the pictures are one of the windows'. Differences are counted only if they match none."""
    if any(alike(expected, got) for expected in windows.values()):
        return None
    wrong = {name: differing(expected, got) for name, expected in windows.items()}
    return "; ".join("%s: %s" % item for item in wrong.items())


def case(function):
    def performed(context):
        with tempfile.TemporaryDirectory(prefix="mural-recordings.") as folder:
            try:
                return function(Workplace(context, folder))
            except AssertionError as error:
                return str(error)
    performed.__name__ = function.__name__
    cases.case(performed)
    return function


# ---- a replay shows the recorded pictures

def sessions(names):
    """Returns the programs of each session. They share one, because its start takes longer than a program."""
    return [(name,) for name in names] if length.LONG else [tuple(names)]


def matched(natively, got, what):
    """Compares the pictures of programs that ran one after the other with native ones. Returns, by program, the number of
    earlier pictures, and its pictures."""
    places, at = {}, 0
    for name, windows in natively.items():
        found = next((frames for frames in windows.values() if alike(frames, got[at:at + len(frames)])), None)
        if found is None:
            frames = min(map(len, windows.values()))
            raise AssertionError("%s, %s: %s" % (what, name, unlike_all(windows, got[at:at + frames])))
        places[name] = (at, found)
        at += len(found)
    if at != len(got):
        raise AssertionError("%s: %d pictures instead of %d" % (what, len(got), at))
    return places


def recorded(place, names):
    """Records programs into a.mural. Returns their native pictures, and the result of the comparison with these."""
    natively = {name: place.native(name) for name in names}
    return natively, matched(natively, place.record(*names), "recorded")


def all_replayed(place, names, layouts=tuple(("--tiles", layout) for layout in LAYOUTS)):
    for together in sessions(names):
        natively = recorded(place, together)[0]
        for options in layouts:
            matched(natively, place.replay(options), " ".join(options))


@case
def replay_vertices(place):
    """Calls of all kinds: immediate, in lists, from the program's memory, from buffers and mappings; large values."""
    return all_replayed(place, ("immediate", "display_lists", "client_arrays", "core_arrays", "persistent_frames", "large_objects"))


@case
def replay_reads(place):
    """Requests whose replies are not read, and copies of windows: recorded with one node, replayed with four."""
    return all_replayed(place, ("pixels_read", "reads_deferred", "queries_later", "accum_buffer", "frames_kept", "front_and_back"))


@case
def replay_threads(place):
    return all_replayed(place, ("loader_thread", "shared_contexts", "threads_windows", "glsl_uniforms", "es2_scene"))


@case
def replay_shared_work(place):
    """The same file with time-multiplexing and with ranges of draws."""
    return all_replayed(place, ("immediate", "fixed_lighting"), (("--dplex", "2"), ("--db", "2")))


@case
def replay_windows(place):
    """Windows that are created and destroyed, and several processes: the wall shows the same as before."""
    for together in sessions(("several_windows", "window_switch", "window_churn", "fork_child", "fork_exec")):
        live = place.record(*together)
        for tiles in LAYOUTS:
            wrong = differing(live, place.replay(["--tiles", tiles]))
            if wrong is not None:
                return "%s, %s: %s" % (", ".join(together), tiles, wrong)
    return None


@case
def replay_on_a_display(place):
    """The replay opens its own windows for the program's."""
    live = place.record("immediate")
    out = place.path("replayed")
    with place.session(["replay", place.path("a.mural"), "--display", "app", "--tiles", "2x1", "--out", out]) as run:
        place.check(run, 0)
    return differing(live, shown(out))


@case
def replay_finds_a_planted_fault(place):
    """A node that draws differently from the trace is detected."""
    live = place.record("immediate")
    for fault in ("opcode", "drop"):
        if differing(live, place.replay(["--tiles", "2x1"], environment={"MURAL_PLANT": fault})) is None:
            return "the fault %s was not seen" % fault
    return None


@case
def replay_again_and_again(place):
    """--loop continues until --frames; --pace takes the recorded time."""
    live = place.record("immediate")
    return differing(live + live + live[:2], place.replay(["--loop", "--pace", "--frames", str(2 * FRAMES + 2)]))


@case
def replay_of_a_replay(place):
    live = place.record("immediate")
    place.replay(["--tiles", "2x1", "--record", place.path("b.mural")])
    return differing(live, place.replay(["--tiles", "1x2"], "b.mural"))


# ---- recordings that end early

@case
def killed_head_leaves_what_is_whole(place):
    with place.context.drawing("long_run", 20000, options=list(RECORD) + ["--record", place.path("a.mural")]) as run:
        if not run.wait_for_line("frame 20"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        time.sleep(2.5)  # data older than about a second is in the file
        cases.kill_all(run.wait_for_processes(cases.HEAD))
        if not run.wait_for_line("head"):
            return "no message about the ended head"
        run.process.send_signal(signal.SIGTERM)  # the program would continue without nodes
        run.status()
    done = place.mural("dump", place.path("a.mural"), "--summary")
    if done.returncode == 2 and "is not a trace" in done.stderr:
        return "not even the header was written"
    if done.returncode != 0 or done.stderr.count("\n") != 1 or "its end is missing" not in done.stderr:
        return "status %d, %s" % (done.returncode, done.stderr)
    frames = int(re.search(r"(\d+) complete frames", done.stderr).group(1))
    return None if len(place.replay(["--tiles", "2x1"])) >= frames else "not all whole frames were shown"


@case
def full_disk_ends_the_recording_only(place):
    with place.context.drawing("long_run", 60, options=list(RECORD) + ["--record", "/dev/full"]) as run:
        wrong = cases.check_end(run, 0, 60)
        printed = cases.error_lines(run, ["No space left"])
    return wrong or (None if len(printed) == 1 and "the program continues" in printed[0] else "output: " + " | ".join(run.standard_error))


@case
def arguments_that_are_wrong(place):
    """Each causes one line with the next step, and status 2."""
    with open(place.path("text"), "w", encoding="utf-8") as file:
        file.write("no recording\n" * 10)
    place.record("immediate", frames=2)
    place.change("damaged", lambda whole: flipped(whole, len(whole) // 2))
    wrong = []
    commands = {"is not a trace": ["replay", place.path("text")], "cannot be read": ["replay", place.path("nowhere")], "is damaged": ["replay", place.path("damaged")],
                "cannot be written": ["run", "--record", "/nowhere/a.mural", "--display", "none", "--", place.context.program("immediate")],
                "is not a trace ": ["dump", place.path("text")], "is damaged ": ["dump", place.path("damaged")], "--frames \"7-3\"": ["dump", place.path("a.mural"), "--frames", "7-3"],
                "the file being replayed": ["replay", place.path("a.mural"), "--record", place.path("a.mural")]}
    for words, command in commands.items():
        done = place.mural(*command)
        if done.returncode != 2 or done.stderr.count("\n") != 1 or words.strip() not in done.stderr:
            wrong.append("mural %s: status %d, %s" % (" ".join(command), done.returncode, done.stderr.strip()))
    return "; ".join(wrong) or None


@case
def arguments_of_a_damaged_file(place):
    """The message names the valid part before the damage and a command that saves it; the command works."""
    live = place.record("fixed_lighting", frames=20)  # several blocks
    place.change("damaged.mural", lambda whole: flipped(whole, len(whole) * 2 // 3))
    file = place.path("damaged.mural")
    done = place.mural("replay", file)
    hint = re.search(r"earlier frames are valid \(1-(\d+)\): extract them with mural (trim \S+ 1-\1) -o good\.mural, ", done.stderr)
    if done.returncode != 2 or done.stderr.count("\n") != 1 or hint is None:
        return "status %d, %s" % (done.returncode, done.stderr)
    frames = int(hint.group(1))
    if hint.group(2).split() != ["trim", file, "1-%d" % frames]:
        return "it suggests: mural " + hint.group(2)
    place.trim("1-%d" % frames, "damaged.mural")
    return place.refused(hint.group(0), "trim", file, "1-20", "-o", place.path("c.mural")) or differing(live[:frames], place.replay(["--tiles", "2x1"], "b.mural"))


@case
def arguments_of_a_file_without_a_frame(place):
    """A file truncated before its first frame differs from a trace of a program without pictures."""
    place.record("immediate", frames=2)
    place.change("cut.mural", lambda whole: whole[:len(whole) // 2])
    cut = place.path("cut.mural")
    why = "has no complete frame: its end is missing (the head was killed, or the file is truncated)"
    return place.refused(why, "replay", cut) or place.refused(why, "trim", cut, "2-5", "-o", place.path("b.mural")) or place.refused(why, "dump", cut, "--frames", "1") or \
        place.refused("0 complete frames", "dump", cut, status=0)


# ---- trim

def all_trimmed(place, names, frames=(3, 5), leaves_out=False):
    """Checks that a trimmed trace shows, on other tiles, the programs' native pictures."""
    number = 0
    # The draws left out of one program are countable only in a trace without others.
    for together in [(name,) for name in names] if leaves_out else sessions(names):
        places = recorded(place, together)[1]
        for name, (earlier, native) in places.items():
            printed = place.trim("%d-%d" % tuple(earlier + frame for frame in frames))
            number += 1
            for tiles in ("2x2", "3x1") if length.LONG else ("2x1",) if number % 2 == 1 else ("1x1",):
                wrong = differing(native[frames[0] - 1:frames[1]], place.replay(["--tiles", tiles], "b.mural"))
                if wrong is not None:
                    return "%s, %s: %s; %s" % (name, tiles, wrong, printed)
            if leaves_out and draws_left_out(printed) == 0:
                return "%s: %s" % (name, printed)
    return None


def draws_left_out(printed):
    return int(re.search(r"(\d+) of \d+ draws", printed).group(1))


@case
def trim_leaves_out_what_nobody_sees(place):
    return all_trimmed(place, ("immediate", "client_arrays", "core_arrays", "many_triangles"), leaves_out=True)


@case
def trim_keeps_what_later_frames_need(place):
    """Kept pictures, copies, textures drawn into, accumulation, the front buffer, memory that shaders write."""
    return all_trimmed(place, length.some(("frames_kept", "pixels_read", "framebuffers", "accum_buffer", "front_and_back", "queries", "fragment_counters", "display_lists")))


@case
def tiles_trimmed(place):
    """State of all kinds. A short run leaves out programs of the cases above."""
    more = ("framebuffers", "textures_classic", "textures_modern", "client_arrays", "core_arrays", "fixed_lighting", "glsl_stages", "glsl_uniforms", "raster_state", "es3_scene")
    return all_trimmed(place, ("pixels_draw", "display_lists", "blend_modes", "accum_buffer", "attribute_stacks", "queries") + (more if length.LONG else ()))


@case
def trim_to_one_frame(place):
    """The last frame, with objects and state of all earlier ones; of several windows."""
    wrong = all_trimmed(place, ("textures_classic", "glsl_uniforms", "persistent_frames"), frames=(FRAMES, FRAMES))
    for program in ("several_windows", "fork_child"):
        if wrong is None:
            live = place.record(program)
            printed = place.trim("%d-%d" % (FRAMES, FRAMES))
            wrong = differing(live[FRAMES - 1:FRAMES], place.replay(["--tiles", "2x1"], "b.mural"))
            wrong = wrong and "%s: %s; %s" % (program, wrong, printed)
    return wrong


@case
def trim_of_a_part(place):
    live = place.record("immediate")
    place.trim("2-5")
    place.trim("2-3", "b.mural", "c.mural")
    return differing(live[2:4], place.replay(["--dplex", "2"], "c.mural"))


@case
def trim_refuses(place):
    place.record("immediate", frames=2)
    for frames, words in (("2-3", "the trace has 2 frames; choose some of them, such as 1-2"), ("0-1", "must be N or N-M"), ("x", "must be N or N-M")):
        done = place.mural("trim", place.path("a.mural"), frames, "-o", place.path("b.mural"))
        if done.returncode != 2 or done.stderr.count("\n") != 1 or words not in done.stderr:
            return "%s: status %d, %s" % (frames, done.returncode, done.stderr)
    done = place.mural("trim", place.path("a.mural"), "1", "-o", place.path("a.mural"))
    return None if done.returncode == 2 and "is the file being trimmed" in done.stderr else done.stderr


# ---- dump

@case
def dump_shows_the_calls(place):
    place.record("immediate", frames=2)
    done = place.mural("dump", place.path("a.mural"))
    lines = done.stdout.splitlines()
    for wanted in (r"^     1 1    program started: immediate, pid \d+$", r"^     1 1\.\d+ +Mural\.CreateContext\(context=1, share=0, api=0, .*double\)$", r"^     2 1\.\d+ +Mural\.Swap\(window=1, frame=2\)$",
                   r"^     1 1\.\d+ +glClear\(mask=GL_DEPTH_BUFFER_BIT\|.*GL_COLOR_BUFFER_BIT\)$", r"^     1 1\.\d+ +glBegin\(mode=GL_TRIANGLES\)$", r"^     1 1\.\d+ +glVertex3f\(x=[-0-9.]+, y=[-0-9.]+, z=[-0-9.]+\)$"):
        if not any(re.match(wanted, line) for line in lines):
            return "no line is like %s among %d" % (wanted, len(lines))
    if any("malformed" in line or "unknown" in line for line in lines):
        return "malformed: " + next(line for line in lines if "malformed" in line or "unknown" in line)
    second = place.mural("dump", place.path("a.mural"), "--frames", "2", "--calls", "glBegin,Mural.S*").stdout.splitlines()
    if [line for line in lines if line.startswith("     2 ") and re.search(r" (glBegin|Mural\.S\w*)\(", line)] != second:
        return "--frames and --calls choose otherwise"
    summary = place.mural("dump", place.path("a.mural"), "--summary").stdout
    counted = int(re.search(r"all frames:(?:\n.*)*?\n +(\d+) +\d+ bytes  glBegin\n", summary).group(1))
    return None if counted == sum(" glBegin(" in line for line in lines) else "the summary counts %d glBegin" % counted


@case
def dump_refuses_what_is_not_there(place):
    """Unknown frames and names are errors; a known call without occurrences is reported."""
    place.record("immediate", frames=2)
    file = place.path("a.mural")
    for words, arguments in (("the trace has 2 frames; choose some of them, such as 1-2", ("--frames", "99")), ("the trace has 2 frames; choose some of them, such as 1-2", ("--frames", "2-9")),
                             ("--calls \"nosuch\": no command matches; mural list-commands lists the GL names", ("--calls", "nosuch")), ("--calls \"glbegin\": no", ("--calls", "glBegin,glbegin"))):
        wrong = place.refused(words, "dump", file, *arguments)
        if wrong is not None:
            return wrong
    absent = "--calls \"glDispatchCompute\": no such call in "
    wrong = place.refused(absent + file, "dump", file, "--calls", "glDispatchCompute", status=0) or \
        place.refused(absent + "frames 1-2 of " + file, "dump", file, "--calls", "glDispatchCompute", "--frames", "1-2", status=0)
    done = place.mural("dump", file, "--calls", "glDispatchCompute,glBegin")
    if wrong is None and (done.returncode != 0 or done.stderr.count("\n") != 1 or absent not in done.stderr or "glBegin(" not in done.stdout):
        wrong = "of two calls: status %d, %s" % (done.returncode, done.stderr)
    behind = place.mural("dump", file, "--frames", "3")  # the program's commands after its last picture
    if wrong is None and (behind.returncode != 0 or not behind.stdout.startswith("     3 ")):
        wrong = "after the last frame: status %d, %s" % (behind.returncode, behind.stderr)
    return wrong


@case
def dump_understands_all_programs(place):
    """The printer finds no malformed record in these."""
    for together in sessions(("client_arrays", "glsl_stages", "textures_modern", "buffers", "display_lists", "feedback_select", "egl_images", "compute_images", "arb_programs")):
        place.record(*together, frames=2)
        done = place.mural("dump", place.path("a.mural"))
        odd = [line for line in done.stdout.splitlines() if "malformed" in line or ", unknown" in line]
        missing = [name for name in together if "program started: %s," % name not in done.stdout]
        if done.returncode != 0 or odd or missing:
            return "%s: %s" % (", ".join(together), odd[:1] or missing or done.stderr)
    return None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
