"""One run of a program whose nodes are killed and rejoin: its pictures, the states of its nodes, and the comparison with
native pictures. The cases of rejoin.py use it."""

import json
import os
import re
import signal
import tempfile
import time

from harness import cases, length, pictures, programs, session

CONFIGS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "configs")

WIDTH, HEIGHT = 252, 190
BACK = "rejoined "
# Pause in each frame. A rejoin takes the same time with longer ones, and there are fewer pictures to save and compare.
PAUSE_US = "15000" if length.LONG else "45000"
PROGRAM = "long_scene"
# limit of frames per run: on a busy machine a rejoin takes seconds, and a run without an end file takes too long
MAX_FRAMES = 6000
START = 25  # frames before the first loss
TAIL = 40  # frames drawn after the awaited event of a case
EXACT = 20  # the last frames of these, which must not differ


NATIVE = {}  # pictures by environment, because several cases draw the same


def native_pictures(context, folder, frames, environment):
    """Returns the first pictures as the program draws them alone and without pauses; they do not depend on the number
    of later ones."""
    environment = {name: value for name, value in environment.items() if name.startswith("SCENE_")}
    environment["SCENE_PAUSE_US"] = "0"
    key = tuple(sorted(environment.items()))
    if len(NATIVE.get(key, ())) < frames:
        drawn = frames + frames // 4  # a reserve for the next case
        run = programs.run_program(context.build, PROGRAM, os.path.join(folder, "native"), context.display,
                                   "%dx%d" % (WIDTH, HEIGHT), drawn, more_environment=environment)
        if run.status != 0:
            raise SystemExit("the program fails natively: status %s: %s" % (run.status, run.output[-200:]))
        NATIVE[key] = [pictures.read_ppm(path) for _, path in sorted(run.frames().items())]
        if len(NATIVE[key]) != drawn:
            raise SystemExit("%d native pictures of %d" % (len(NATIVE[key]), drawn))
    return NATIVE[key][:frames]


def saved_pictures(folder, last=0):
    """Returns all pictures, or only the last ones."""
    return [pictures.read_png(os.path.join(folder, name)) for name in sorted(os.listdir(folder))[-last:]]


class Watch:
    """One run of the program with pictures in files, and the states of its nodes. It ends when enough was seen, or with
    its last frame."""

    def __init__(self, context, frames=MAX_FRAMES, options=(), environment=None, tiles="2x1", every=1, beside=False, display="none"):
        self.context, self.frames, self.tiles = context, frames, tiles
        self.every = every  # frames between two saved pictures
        self.beside = beside  # the same program also runs a second time, in a smaller window
        self.environment = {"SCENE_PAUSE_US": PAUSE_US}
        self.environment.update(environment or {})
        self.folder = tempfile.TemporaryDirectory(prefix="mural-rejoin.")
        self.out = os.path.join(self.folder.name, "out")
        self.report_file = os.path.join(self.folder.name, "report.json")
        self.end_file = os.path.join(self.folder.name, "end")
        self.minimum, self.drawn = frames, None  # minimum number of frames, and the actual number
        self.options = divided(tiles) + ["--display", display, "--report", self.report_file] + list(options)
        if display == "none":
            self.options += ["--out", self.out]
        if every > 1:
            self.options += ["--save", ",".join(map(str, range(every, frames + 1, every)))]

    def start(self):
        command = [self.context.program(PROGRAM), "--frames", str(self.frames), "--size", "%dx%d" % (WIDTH, HEIGHT)]
        if self.beside:
            command = ["/bin/sh", "-c", '"$1" "$2" "$3" "$4" 131x77 > /dev/null & exec "$@"', "sh"] + command
        return self.context.run(command, self.options, dict(self.environment, END_FILE=self.end_file))

    def enough(self, run, tail=TAIL):
        """Reports that the awaited event was seen: the program draws a fixed number of further frames."""
        self.minimum = min(self.frames, latest_frame(run) + 1 + tail)
        session.end_after(self.end_file, tail)

    def end(self, run):
        """Returns the error of the run's end; sets the number of frames."""
        wrong = cases.check_end(run, 0)
        self.drawn = len(frame_times(run))
        if wrong is None and self.drawn < self.minimum:
            wrong = "the program drew %d frames, not %d at least" % (self.drawn, self.minimum)
        return wrong

    def report(self):
        with open(self.report_file, encoding="utf-8") as file:
            return json.load(file)

    def native(self):
        """Returns the native picture of each drawn frame."""
        return native_pictures(self.context, self.folder.name, self.drawn, self.environment)

    def differing(self, run):
        """Returns, by picture, the columns that differ from the native one, or an error text."""
        wrong = self.end(run)
        if wrong is not None:
            return wrong
        saved = saved_pictures(self.out)
        native = self.native()[self.every - 1::self.every]
        if len(saved) != len(native):
            return "%d pictures instead of %d" % (len(saved), len(native))
        return [columns_that_differ(a, b) for a, b in zip(native, saved)]


def divided(tiles):
    """2x1 tiles, or nodes whose areas move: "queue 32x32", "balance auto", "config FILE" of configs/."""
    if tiles.startswith("config"):
        return ["--config", os.path.join(CONFIGS, tiles.split()[1]), "--all-local", "--projection", "program", "--size", "%dx%d" % (WIDTH, HEIGHT)]
    if tiles.startswith("balance"):
        return ["--balance", tiles.split()[1], "--local-nodes", "2"]
    return ["--tile-queue", tiles.split()[1], "--local-nodes", "2"] if tiles.startswith("queue") else ["--tiles", tiles]


def columns_that_differ(first, second):
    different = 0  # a bit mask of all rows: far cheaper than pixel by pixel
    for a, b in zip(first.rows, second.rows):
        if a != b:
            different |= int.from_bytes(a, "little") ^ int.from_bytes(b, "little")
    found = different.to_bytes((different.bit_length() + 7) // 8, "little")
    return {at // 3 for at, value in enumerate(found) if value}


def nodes_of(run, count=2):
    """Returns the pids of the nodes by their number: the head starts them one after the other."""
    return sorted(run.wait_for_processes(cases.NODE, count))


def printed(run, text):
    return [line for line in run.standard_error if text in line]


def judged(differing, spans, tail, every=1):
    """Compares the pictures. spans: (first frame, columns that may differ), …, each from its frame on for one run of
    differences. At least `tail` frames after the last difference must be exact. `every`: as for the run."""
    allowed, behind = set(), every * len(differing)
    frames = range(every - 1, behind, every)
    for frame, columns in zip(frames, differing):
        for first, more in spans:
            if frame >= first:
                allowed = allowed | set(more)
        strange = columns - allowed
        if strange:
            return "frame %d differs in columns %d to %d" % (frame, min(strange), max(strange))
    late = [(frame, len(columns)) for frame, columns in zip(frames, differing) if columns]
    if late and late[-1][0] >= behind - tail:
        return "frame %d of %d still differs, in %d columns" % (late[-1][0], behind, late[-1][1])
    return None


def kill_and_compare(context, frames=MAX_FRAMES, options=(), environment=None, victims=(1,), at=START, tiles="2x1", missing_columns=None, where="local", every=1, maximum=None):
    """Kills the nodes one after the other, each after the rejoin of the previous one."""
    watch = Watch(context, frames, options, environment, tiles, every)
    half = WIDTH // 2
    columns = {0: range(0, half), 1: range(half, WIDTH)}
    spans = []
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % at):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        for number in victims:
            pids = nodes_of(run)
            victim = node_pid(run, number, where)
            frame = latest_frame(run)
            spans.append((frame - 3, missing_columns or columns[number]))
            os.kill(victim, signal.SIGKILL)
            if not run.wait_for_line(BACK, 30):
                return "node %d did not rejoin (of %s): %s" % (number, pids, " | ".join(run.standard_error[-4:]))
            time.sleep(0.3)  # a frame in progress at the rejoin contains only the other node's part
        watch.enough(run, max(TAIL, 4 * every))
        differing = watch.differing(run)
        if isinstance(differing, str):
            return differing
        wrong = judged(differing, spans, max(EXACT, 3 * every), every)
        if wrong is None and every == 1 and not any(differing) and not tiles.startswith(("queue", "balance", "config")):
            wrong = "no picture was incomplete; check that a process was killed"
        if wrong is None and maximum is not None and sum(map(bool, differing)) > maximum:
            wrong = "%d frames lack something, not %d at most" % (sum(map(bool, differing)), maximum)
        nodes = watch.report()["nodes"]
        joins = sum(node["joins"] for node in nodes)
        if wrong is None and joins != len(victims):
            wrong = "%d returns instead of %d" % (joins, len(victims))
        for line in printed(run, BACK):
            print("    " + line)
        return wrong


def frame_times(run):
    """Returns the time of each frame of the program in ms."""
    return [float(line.split()[2]) for line in run.standard_output if line.startswith("frame ")]


def latest_frame(run):
    frames = [int(line.split()[1]) for line in run.standard_output if line.startswith("frame ")]
    return frames[-1] if frames else 0


def node_pid(run, number, where="local"):
    """Returns the pid of the node with that number, as the head names it, or in the order of the starts."""
    back = [re.search(r"node %d \(%s, pid (\d+)\) " % (number, where) + BACK, line) for line in run.standard_error]
    pids = [int(match.group(1)) for match in back if match]
    return pids[-1] if pids else first_nodes(run)[number]


def first_nodes(run):
    if not hasattr(run, "first_nodes"):
        run.first_nodes = nodes_of(run)
    return run.first_nodes
