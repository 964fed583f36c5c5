#!/usr/bin/env python3
"""Nodes that `mural ctl stop-node` ends and `start-node` brings back while programs draw. All saved pictures are compared
with native ones.

node_maintenance.py --build build/release [--cases balanced,fixed] [--list]
"""

import json
import os
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, pictures, programs, session  # noqa: E402
from harness.control import PATIENCE_SECONDS, ctl, result_of  # noqa: E402

SIZE = "252x190"
SCENE = {"SCENE_MIB": "4"}


def wait_for(context, run, reached):
    """Waits until the status of the session satisfies the condition; returns the status, or None."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline and run.process.poll() is None:
        status = result_of(context, run, "status")
        if "nodes" in status and reached(status):
            return status
        time.sleep(0.02)
    return None


def wait_for_node_processes(run, count):
    """Waits until that number of node processes is left; returns their pids. The head itself waits only a second for an end."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    pids = run.processes(cases.NODE)
    while len(pids) != count and time.monotonic() < deadline:
        time.sleep(0.02)
        pids = run.processes(cases.NODE)
    return pids


def more_frames(context, run, count=10):
    wanted = result_of(context, run, "status")["frames"] + count
    return wait_for(context, run, lambda status: status["frames"] >= wanted)


class Maintained:
    """One run with saved pictures, and the numbers of pixels that differ from native ones by frame and half."""

    def __init__(self, context, options, environment=None):
        self.context, self.options = context, list(options)
        self.environment = dict(SCENE, **(environment or {}))
        self.folder = tempfile.TemporaryDirectory(prefix="mural-maintenance.")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run(self, node, force=(), rounds=1):
        """Stops and starts the node; returns an error, or None."""
        context = self.context
        command = [context.program("long_scene"), "--frames", "100000", "--size", SIZE]
        options = self.options + ["--display", "none", "--out", self.path("live"), "--report", self.path("report")]
        with context.run(command, options, dict(self.environment, END_FILE=self.path("end"))) as run:
            if not wait_for(context, run, lambda status: status["frames"] >= 10):
                return "no frames: %s" % " | ".join(run.standard_error[-3:])
            for turn in range(rounds):
                began = time.monotonic()
                status, _, message = ctl(context, str(run.process.pid), "stop-node", str(node), *force)
                print("    stop-node took %.2f s" % (time.monotonic() - began))
                if status != 0:
                    return "stop-node: %s" % message
                stopped, left = result_of(context, run, "nodes")["nodes"][node], wait_for_node_processes(run, self.nodes() - 1)
                if stopped["state"] != "stopped" or len(left) != self.nodes() - 1:
                    return "after stop-node: %s, %s" % (stopped, left)
                if not more_frames(context, run):
                    return "no frames without the node"
                status, _, message = ctl(context, str(run.process.pid), "start-node", str(node))
                if status != 0:
                    return "start-node: %s" % message
                if not wait_for(context, run, lambda now, joins=turn + 1: now["nodes"][node]["joins"] == joins and now["nodes"][node]["state"] == "alive"):
                    return "the node does not join: %s" % " | ".join(run.standard_error[-3:])
                if not more_frames(context, run):
                    return "no frames with the node"
            session.end_after(self.path("end"), 5)
            wrong = cases.check_end(run, 0)
            lost = [line for line in run.standard_error if "was lost" in line]
            return wrong or ("; ".join(lost) if lost else None)

    def nodes(self):
        return int(self.options[self.options.index("--local-nodes") + 1]) if "--local-nodes" in self.options else 2

    def differing(self):
        """Returns the pixels that differ in the left and in the right half, by frame."""
        live = [pictures.read_png(os.path.join(self.path("live"), name)) for name in sorted(os.listdir(self.path("live")))]
        native = programs.run_program(self.context.build, "long_scene", self.path("native"), self.context.display, SIZE, len(live),
                                      more_environment=dict(self.environment, SCENE_PAUSE_US="0"))
        alone = [pictures.read_ppm(path) for _, path in sorted(native.frames().items())]
        if len(alone) != len(live):
            raise SystemExit("%d native pictures, %d live" % (len(alone), len(live)))
        counts = []
        for first, second in zip(alone, live):
            half = 3 * (first.width // 2)
            counts.append([sum(a[at:at + 3] != b[at:at + 3] for a, b in zip(first.rows, second.rows) if a != b for at in side)
                           for side in (range(0, half, 3), range(half, 3 * first.width, 3))])
        print("    %d frames, %d pixels differ in the left half, %d in the right one" % (
            len(live), sum(left for left, _ in counts), sum(right for _, right in counts)))
        return counts


def handed_over(context, options, node, **more):
    run = Maintained(context, options, **more)
    wrong = run.run(node, rounds=2)
    if wrong is not None:
        return wrong
    with open(run.path("report"), encoding="utf-8") as file:
        if json.load(file)["nodes"][node]["lost"]:
            return "the report calls the node lost"
    return "pixels differ" if any(map(sum, run.differing())) else None


@cases.case
def balanced(context):
    """Other nodes take the area: no pixel of any frame differs, while the node is stopped and started twice."""
    return handed_over(context, ("--balance", "auto", "--local-nodes", "3"), 1)


@cases.case
def queued_tiles(context):
    """The same with a tile queue, and the first node."""
    return handed_over(context, ("--tile-queue", "32x32", "--local-nodes", "2"), 0)


@cases.case
def fixed_tiles(context):
    """With force: frames before the stop and after the return are exact, and the other node's half always."""
    run = Maintained(context, ("--tiles", "2x1"))
    wrong = run.run(1, force=("force",))
    if wrong is not None:
        return wrong
    counts = run.differing()
    frames = [number for number, (_, right) in enumerate(counts) if right]
    if any(left for left, _ in counts):
        return "the half of the other node differs"
    print("    frames %d to %d of %d lack the node" % (frames[0] + 1, frames[-1] + 1, len(counts)))
    return None if frames == list(range(frames[0], frames[-1] + 1)) and frames[-1] + 5 < len(counts) else "frames %s differ" % frames


@cases.case
def kept_pictures_refuse(context):
    """A window that is never cleared does not move its areas: the node stays, and no pixel differs."""
    run = Maintained(context, ("--balance", "auto", "--local-nodes", "2"), {"SCENE_KEEPS": "1"})
    wrong = run.run(1)
    if wrong is None or "clear no window" not in wrong:
        return "stop-node succeeds or fails otherwise: %s" % wrong
    return None


@cases.case
def errors(context):
    """Each error is one line with the next step, and changes nothing."""
    wrong = []
    command = [context.program("long_run"), "--frames", "100000", "--size", SIZE]
    for options, requests in ((("--tiles", "2x1"), ((("stop-node", "1"), "add force"), (("stop-node", "2"), "no node 2"), (("start-node", "1"), "a member already"))),
                              (("--tiles", "1x1"), ((("stop-node", "0"), "the only node that draws"),)),
                              (("--db", "2", "--local-nodes", "2"), ((("stop-node", "1"), "share the draws"),))):
        with context.run(command, list(options) + ["--display", "none"]) as run:
            if not wait_for(context, run, lambda status: status["frames"] >= 5):
                return "no frames"
            for words, text in requests:
                status, _, message = ctl(context, str(run.process.pid), *words)
                if status != 1 or text not in message or message.count("\n") != 1:
                    wrong.append("%s: status %d, %s" % (" ".join(words), status, message))
                wrong += [] if more_frames(context, run) else ["no frames after %s" % " ".join(words)]
                states = {node["state"] for node in result_of(context, run, "nodes")["nodes"]}
                wrong += [] if states == {"alive"} else ["states %s" % states]
    return "; ".join(wrong) or None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
