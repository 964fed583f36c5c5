#!/usr/bin/env python3
"""Changes of the plan of a running session (`mural change`, `mural ctl layout`): each happens between two frames or not
at all, and every frame stays exact.

plan_changes.py --build build/release [--cases layouts] [--list]
"""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, length, pictures, session  # noqa: E402
from harness.control import PATIENCE_SECONDS, ctl, result_of  # noqa: E402

SIZE = "250x190"
PAUSE_US = "1000" if length.LONG else "40000"  # per frame; a session without pauses takes the CPU time of other tests
LAYOUTS = os.path.join(TOP, "configs", "layouts.eqc")
CANVASES = os.path.join(TOP, "configs", "wall-and-monitor.eqc")
MONITOR = os.path.join(TOP, "configs", "monitor.eqc")


def change(context, run, *options):
    """Returns (exit status, reply as an object, errors) of `mural change`."""
    done = subprocess.run([context.mural, "change", "--json", str(run.process.pid), *options],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=PATIENCE_SECONDS, check=False)
    reply = json.loads(done.stdout) if done.returncode == 0 else {}
    return done.returncode, reply.get("result", {}), done.stderr.decode()


def frames_of(context, run):
    return result_of(context, run, "status").get("frames", 0)


def draws_further(context, run, count):
    """Returns whether the wall shows that number of further frames in time."""
    wanted, deadline = frames_of(context, run) + count, time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline and run.process.poll() is None:
        if frames_of(context, run) >= wanted:
            return True
        time.sleep(0.02)
    return False


def nodes_of(context, run):
    return [node["node"] for node in result_of(context, run, "nodes").get("nodes", [])]


class Drawing:
    """A session whose program draws until finish(), and whose frames are compared with the program's own GL."""

    def __init__(self, context, options, frames=1000000, program="long_scene", pause_us=PAUSE_US):
        self.context = context
        self.folder = tempfile.TemporaryDirectory(prefix="mural-plans.")
        self.report, self.end_file = self.path("report.json"), self.path("end")
        command = [context.program(program), "--frames", str(frames), "--size", SIZE]
        self.run = context.run(command, list(options) + ["--report", self.report],
                               {"SCENE_MIB": "4", "SCENE_PAUSE_US": pause_us, "END_FILE": self.end_file})

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def __enter__(self):
        self.run.__enter__()
        return self

    def __exit__(self, *details):
        self.run.__exit__(*details)
        self.folder.cleanup()

    def begins(self):
        return draws_further(self.context, self.run, 5)

    def finish(self, least=1):
        """Ends the program; returns an error, or None if no pixel of at least that number of frames differs."""
        session.end_after(self.end_file, 3)
        wrong = cases.check_end(self.run, 0)
        if wrong is not None:
            return wrong
        with open(self.report, encoding="utf-8") as file:
            numbers = json.load(file)
        print("    %d frames compared, %d pixels, %d differ" % (numbers["verifiedFrames"], numbers["verifiedPixels"], numbers["differingPixels"]))
        if numbers["differingPixels"] > 0:
            return "%d pixels differ" % numbers["differingPixels"]
        return None if numbers["verifiedFrames"] >= least else "only %d frames were compared" % numbers["verifiedFrames"]


def exact_changes(context, options, changes):
    """changes: functions that perform one change each, and return an error or None."""
    with Drawing(context, list(options) + ["--verify"]) as drawing:
        if not drawing.begins():
            return "no frames: %s" % " | ".join(drawing.run.standard_error[-3:])
        for perform in changes:
            wrong = perform(drawing)
            if wrong is not None:
                return wrong
            if not draws_further(context, drawing.run, 6):
                return "no frames after a change: %s" % " | ".join(drawing.run.standard_error[-3:])
        return drawing.finish(6 * len(changes))


def layout(canvas, name, joined, left=None):
    """Shows a layout, and checks the numbers of nodes that join and leave."""
    def perform(drawing):
        reply = result_of(drawing.context, drawing.run, "layout", canvas, name)
        if "error" in reply:
            return "layout %s: %s" % (name, reply["error"])
        print("    %s: %d nodes joined, %d left, %d continued, %.2f s" % (name, len(reply["joined"]), len(reply["left"]), len(reply["kept"]), reply["seconds"]))
        if len(reply["joined"]) != joined or (left is not None and len(reply["left"]) != left):
            return "layout %s: %s" % (name, reply)
        shown = {entry["canvas"]: entry["layout"] for entry in result_of(drawing.context, drawing.run, "layout")["canvases"]}
        return None if shown.get(canvas) == name else "layout %s: %s is shown" % (name, shown)
    return perform


def options(*words, joined, kept=0):
    def perform(drawing):
        status, reply, errors = change(drawing.context, drawing.run, *words)
        if status != 0:
            return "%s: %s" % (" ".join(words), errors)
        print("    %s: %d nodes joined, %d left, %d continued, %.2f s" % (" ".join(words), len(reply["joined"]), len(reply["left"]), len(reply["kept"]), reply["seconds"]))
        return None if (len(reply["joined"]), len(reply["kept"])) == (joined, kept) else "%s: %s" % (" ".join(words), reply)
    return perform


@cases.long_case
def layouts_without_windows(context):
    order = [("2D", 3), ("DB", 2), ("turns", 2), ("simple", 1), ("DB", 2), ("2D", 3), ("turns", 2), ("simple", 1)]
    return exact_changes(context, ["--config", LAYOUTS, "--all-local", "--display", "none"], [layout("wall", *entry) for entry in order])


@cases.case
def layouts_in_the_programs_window(context):
    order = [("turns", 2), ("2D", 3), ("simple", 1), ("DB", 2)]
    return exact_changes(context, ["--config", LAYOUTS, "--all-local", "--display", "app", "--latency", "2"], [layout("wall", *entry) for entry in order])


@cases.case
def layouts_in_wall_windows(context):
    """The head and the nodes show the wall by turns."""
    order = [("2D", 3), ("simple", 1), ("DB", 2), ("turns", 2)]
    return exact_changes(context, ["--config", LAYOUTS, "--all-local", "--display", "windows"], [layout("wall", *entry) for entry in order])


@cases.case
def one_canvas_of_two(context):
    """The nodes of the other canvas continue."""
    changes = [layout("monitor", "off", 0, 1), layout("monitor", "all", 1, 0), layout("monitor", "off", 0, 1)]
    return exact_changes(context, ["--config", CANVASES, "--all-local", "--display", "none"], changes)


@cases.case
def one_canvas_without_nodes(context):
    """The monitor shows pictures of the wall, so its change needs no node."""
    changes = [layout("monitor", "off", 0, 0), layout("monitor", "all", 0, 0)]
    return exact_changes(context, ["--config", MONITOR, "--all-local", "--display", "none"], changes)


@cases.case
def options_of_the_division(context):
    changes = [options("--tiles", "2x2", joined=4), options("--balance", "auto", "--local-nodes", "3", joined=3), options("--db", "2", joined=2),
               options("--undo", joined=3), options("--undo", joined=4), options("--dplex", "2", joined=2), options("--pixel", "2", joined=2),
               options("--tile-queue", "64x64", "--local-nodes", "2", joined=2), options("--db", "2", "--chunk-queue", "16", joined=2),
               options("--config", LAYOUTS, "--all-local", "--layout", "2D", joined=3), options("--tiles", "2x1", joined=2),
               options("--tiles", "2x1", joined=0, kept=2)]
    return exact_changes(context, ["--tiles", "3x1", "--display", "none"], changes)


def on_hosts(context, *more):
    hosts = ("--nodes", "localhost,localhost")
    changes = [options("--tiles", "3x1", "--nodes", "localhost,localhost,localhost", joined=3), options("--db", "2", *hosts, joined=2),
               options("--balance", "auto", *hosts, joined=2), options("--tiles", "2x1", "--nodes", "localhost", "--local-nodes", "1", joined=2),
               options("--tiles", "2x1", *hosts, joined=1, kept=1)]
    return exact_changes(context, ["--tiles", "2x1", "--display", "none", *hosts, *more], changes)


@cases.case
def delta_coded_streams(context):
    return on_hosts(context, "--stream", "tcp", "--delta", "on")


@cases.case
def multicast_streams(context):
    return on_hosts(context, "--stream", "rsp://239.255.77.9:4297?interface=127.0.0.1", "--delta", "on")


@cases.case
def saved_frames(context):
    """Every frame of a session with changes is saved, in order, and equals that of a session without any."""
    pause_us = PAUSE_US if length.LONG else "60000"  # the comparison takes longer than the frames
    with tempfile.TemporaryDirectory(prefix="mural-plans.") as folder:
        changed, plain = os.path.join(folder, "changed"), os.path.join(folder, "plain")
        with Drawing(context, ["--config", LAYOUTS, "--all-local", "--display", "none", "--out", changed], pause_us=pause_us) as drawing:
            if not drawing.begins():
                return "no frames"
            for entry in (("2D", 3), ("turns", 2), ("DB", 2), ("simple", 1)):
                wrong = layout("wall", *entry)(drawing)
                if wrong is not None:
                    return wrong
            session.end_after(drawing.end_file, 3)
            wrong = cases.check_end(drawing.run, 0)
            if wrong is not None:
                return wrong
        names = sorted(os.listdir(changed))
        command = [context.program("long_scene"), "--frames", str(len(names)), "--size", SIZE]
        environment = {"SCENE_MIB": "4", "SCENE_PAUSE_US": "0"}
        with context.run(command, ["--config", LAYOUTS, "--all-local", "--display", "none", "--out", plain], environment) as run:
            wrong = cases.check_end(run, 0)
        if wrong is not None:
            return wrong
        difference = pictures.Difference()
        for name in names:
            difference.add_pictures(pictures.read_png(os.path.join(changed, name)), pictures.read_png(os.path.join(plain, name)), name)
        print("    %d pictures, %d pixels differ" % (len(names), difference.pixels))
        if sorted(os.listdir(plain)) != names:
            return "the saved pictures are not those of frames 1 to %d" % len(names)
        return None if difference.pixels == 0 and len(names) > 20 else "%d pixels of %d pictures differ" % (difference.pixels, len(names))


@cases.case
def refused_changes(context):
    """A change that is not possible prints one line. The nodes continue."""
    with Drawing(context, ["--config", LAYOUTS, "--all-local", "--display", "none", "--verify"]) as drawing:
        run = drawing.run
        if not drawing.begins():
            return "no frames"
        before = nodes_of(context, run)
        refused = [([], 2, "no option"), (["--undo", "--db", "2"], 2, "--undo"), (["--tiles", "2xx1"], 2, "COLUMNSxROWS"), (["--config", "nope.eqc"], 2, "nope.eqc"), (["--undo"], 1, "no change"),
                   (["--stereo", "anaglyph"], 1, "--verify"), (["--config", CANVASES, "--all-local"], 1, "monitor"),
                   (["--config", LAYOUTS, "--all-local", "--layout", "wall:off"], 2, "draws")]
        for words, wanted, text in refused:
            status, _, errors = change(context, run, *words)
            if status != wanted or text not in errors or errors.count("\n") != 1:
                return "%s: status %d, %s" % (" ".join(words), status, errors)
        for words, text in ((("wall", "nope"), "nope"), (("nope", "2D"), "nope"), (("wall",), "both")):
            status, _, errors = ctl(context, str(run.process.pid), "layout", *words)
            if status != 1 or text not in errors or errors.count("\n") != 1:
                return "layout %s: status %d, %s" % (" ".join(words), status, errors)
        for fields, text in (({"samples": 1000000000}, "256 passes"), ({"columns": 100000, "localNodes": 100000}, "256 tiles"), ({"zoomX": 0}, "zoom"),
                             ({"frames": 5}, "no field"), ({"columns": "2"}, "columns"), ({"localNodes": 2000}, "1024 nodes")):
            status, _, errors = ctl(context, str(run.process.pid), "plan", json.dumps(fields))
            if status != 1 or text not in errors or errors.count("\n") != 1:
                return "plan %s: status %d, %s" % (fields, status, errors)
        # A node starts, the other one does not. Neither counts as lost at the end.
        status, _, errors = change(context, run, "--tiles", "2x1", "--nodes", "localhost,no-host.invalid")
        if status != 1 or "no-host.invalid" not in errors:
            return "a change with an unknown host: status %d, %s" % (status, errors)
        status, reply, errors = change(context, run, "--tiles", "2x1", "--dry-run")
        if status != 0 or len(reply["joined"]) != 2 or len(reply["left"]) != 1:
            return "dry run: %s %s" % (reply, errors)
        if nodes_of(context, run) != before:
            return "nodes %s instead of %s" % (nodes_of(context, run), before)
        wrong = drawing.finish()
        lost = [line for line in run.standard_error + run.standard_output if "did not connect" in line or "was lost" in line]
        return wrong or (None if not lost else "the report calls nodes of a refused change lost: %s" % lost)


@cases.case
def reverting_change(context):
    """A change reverts by itself, stays when it is kept, and blocks others until then."""
    with Drawing(context, ["--tiles", "2x1", "--display", "none", "--verify"]) as drawing:
        run = drawing.run
        if not drawing.begins():
            return "no frames"
        before = nodes_of(context, run)
        status, reply, errors = change(context, run, "--db", "2", "--revert-after", "60")
        if status != 0 or reply["revertsInSeconds"] != 60:
            return "status %d, %s %s" % (status, reply, errors)
        left = result_of(context, run, "status")["revertsInSeconds"]
        if not 0 < left <= 60:
            return "%s s left" % left
        status, _, errors = change(context, run, "--tiles", "1x2")
        if status != 1 or "mural ctl keep" not in errors:
            return "another change: status %d, %s" % (status, errors)
        if "error" in result_of(context, run, "keep") or result_of(context, run, "status")["revertsInSeconds"] is not None:
            return "the change is not kept"
        status, _, errors = ctl(context, str(run.process.pid), "keep")
        if status != 1 or "no change" not in errors:
            return "second keep: status %d, %s" % (status, errors)
        kept = nodes_of(context, run)
        status, _, errors = change(context, run, "--tiles", "1x2", "--revert-after", "1")
        if status != 0:
            return "status %d, %s" % (status, errors)
        deadline = time.monotonic() + PATIENCE_SECONDS
        while time.monotonic() < deadline and "reverted" not in " ".join(run.standard_error):
            time.sleep(0.05)
        options_now = result_of(context, run, "plan")["options"]
        if options_now["ranges"] != 2 or kept == before:
            return "the options are %s" % options_now
        status, _, errors = ctl(context, str(run.process.pid), "layout", "wall", "2D", "0")
        if status != 1 or errors.count("\n") != 1:
            return "without canvases: status %d, %s" % (status, errors)
        status, _, errors = ctl(context, str(run.process.pid), "plan", "{}", "4000")
        if status != 1 or "3600" not in errors:
            return "4000 s: status %d, %s" % (status, errors)
        return drawing.finish()


@cases.case
def failing_nodes(context):
    """A new node that does not start leaves everything as it was. A later change succeeds."""
    launch = os.path.join(TOP, "nowhere")
    with Drawing(context, ["--tiles", "2x1", "--display", "none", "--verify", "--launch", launch]) as drawing:
        run = drawing.run
        if not drawing.begins():
            return "no frames"
        before = nodes_of(context, run)
        status, _, errors = change(context, run, "--tiles", "2x1", "--local-nodes", "1", "--nodes", "wall1")
        if status != 1 or "nothing has changed" not in errors or errors.count("\n") != 1:
            return "status %d, %s" % (status, errors)
        print("    %s" % errors.strip())
        if not draws_further(context, run, 5) or nodes_of(context, run) != before:
            return "nodes %s instead of %s" % (nodes_of(context, run), before)
        return options("--tiles", "1x2", joined=2)(drawing) or drawing.finish()


HOST = """#!/bin/sh
# HOST COMMAND...: runs the command unless the host is off
[ -e "$0.$1.off" ] && exit 255
shift
exec "$@"
"""


def hosts_of(context, run):
    return sorted(node["where"] for node in result_of(context, run, "nodes").get("nodes", []))


def runs_on(context, run, hosts):
    """Returns whether the nodes run on these hosts in time. A node that leaves is listed until it has finished its frames."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline and hosts_of(context, run) != hosts:
        time.sleep(0.05)
    return hosts_of(context, run) == hosts


def moves_to_spare(context, hosts, options, after):
    """The last host fails, and its node moves to the spare host. `after` continues; it returns an error or None."""
    spare = "127.0.0.9"
    with tempfile.TemporaryDirectory(prefix="mural-spares.") as folder:
        launch = os.path.join(folder, "launch")
        with open(launch, "w", encoding="ascii") as file:
            file.write(HOST)
        os.chmod(launch, 0o755)
        command = ["--display", "none", "--nodes", ",".join(hosts), "--spare-nodes", spare, "--stream", "tcp", "--launch", launch]
        with Drawing(context, command + options) as drawing:
            run = drawing.run
            if not drawing.begins():
                return "no frames: %s" % " | ".join(run.standard_error[-3:])
            lost = next(node for node in result_of(context, run, "nodes")["nodes"] if node["where"] == hosts[-1])
            with open("%s.%s.off" % (launch, hosts[-1]), "w", encoding="ascii"):
                os.kill(lost["pid"], signal.SIGKILL)
            if not runs_on(context, run, hosts[:-1] + [spare]):
                return "nodes on %s: %s" % (hosts_of(context, run), " | ".join(run.standard_error[-4:]))
            wrong = after(run)
            if wrong is not None:
                return wrong
            if not draws_further(context, run, 5):
                return "no frames after the move"
            session.end_after(drawing.end_file, 3)
            return cases.check_end(run, 0)


@cases.case
def spare_host(context):
    """Then the nodes of another host move on request."""
    def after(run):
        reply = result_of(context, run, "move-nodes", "127.0.0.2", "127.0.0.5")
        if len(reply.get("joined", [])) != 1 or len(reply.get("kept", [])) != 1 or not runs_on(context, run, ["127.0.0.5", "127.0.0.9"]):
            return "move-nodes: %s, nodes on %s" % (reply, hosts_of(context, run))
        for words, text in ((("nowhere", "127.0.0.6"), "no node"), (("127.0.0.5", "a=b"), "no name")):
            status, _, errors = ctl(context, str(run.process.pid), "move-nodes", *words)
            if status == 0 or text not in errors:
                return "move-nodes %s: %s" % (" ".join(words), errors)
        return None
    return moves_to_spare(context, ["127.0.0.2", "127.0.0.3"], ["--tiles", "2x1"], after)


@cases.long_case
def spare_of_the_only_node(context):
    """The programs wait for the spare host, since no node is left."""
    return moves_to_spare(context, ["127.0.0.3"], [], lambda run: None)


@cases.case
def killed_nodes(context):
    """Nodes are killed at random moments of the changes. The program continues, and later changes succeed."""
    numbers = random.Random(7)
    with tempfile.TemporaryDirectory(prefix="mural-plans.") as out, \
            Drawing(context, ["--tiles", "2x1", "--display", "none", "--restart-nodes", "1000", "--out", out]) as drawing:
        run = drawing.run
        if not drawing.begins():
            return "no frames"
        done = {0: 0, 1: 0}
        for count in range(8 if length.LONG else 4):
            words = numbers.choice([("--tiles", "2x2"), ("--db", "2"), ("--balance", "auto", "--local-nodes", "3"), ("--tiles", "2x1")])
            outcome = []
            changing = threading.Thread(target=lambda: outcome.append(change(context, run, *words)))
            changing.start()
            time.sleep(numbers.uniform(0, 0.6))
            alive = run.processes(cases.NODE)
            if alive:
                try:
                    os.kill(numbers.choice(alive), signal.SIGKILL)
                except ProcessLookupError:
                    pass
            changing.join(PATIENCE_SECONDS)
            if not outcome or outcome[0][0] not in done:
                return "change %d, %s: %s" % (count, " ".join(words), outcome)
            done[outcome[0][0]] += 1
            if not draws_further(context, run, 5):
                return "no frames after change %d, %s: %s" % (count, " ".join(words), " | ".join(run.standard_error[-5:]))
        print("    %d changes succeeded, %d did not" % (done[0], done[1]))
        deadline = time.monotonic() + PATIENCE_SECONDS
        last = change(context, run, "--tiles", "1x2")
        while time.monotonic() < deadline and last[0] != 0:
            time.sleep(0.5)
            last = change(context, run, "--tiles", "1x2")
        if last[0] != 0:
            return "the last change failed: %s" % last[2]
        # Frames without the node that has their picture are not saved (--db). The pictures of the last plan are.
        before = len(os.listdir(out))
        if not draws_further(context, run, 20):
            return "no frames after the last change"
        session.end_after(drawing.end_file, 3)
        wrong = cases.check_end(run, 0)
        saved = len(os.listdir(out)) - before
        print("    %d pictures saved after the last change" % saved)
        return wrong or (None if saved >= 20 else "%d pictures saved of 20 frames after the last change" % saved)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
