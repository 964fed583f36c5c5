#!/usr/bin/env python3
"""What outputs show, proved by their hashes, and their pictures in a browser.

browser_outputs.py --build build/release [--cases proof] [--list]
"""

import os
import signal
import sys
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "page"))
from page_session import Page, draws, ended, session  # noqa: E402
from harness import cases  # noqa: E402
from harness.control import result_of  # noqa: E402
from page_client import WebSocket  # noqa: E402

LIVE_SECONDS = 1.5
FROZEN_SECONDS = 3.0


def outputs(viewer, accept=lambda data: True, seconds=20):
    """Returns the first message of the topic that `accept` accepts, as {node: entry}."""
    message = viewer.receive(lambda m: isinstance(m, dict) and m.get("topic") == "outputs" and accept({e["node"]: e for e in m["data"]}), seconds)
    return message and {entry["node"]: entry for entry in message["data"]}


def proofs(context, display, options=()):
    """Hashes follow the pictures; a stopped node has none, and a program that rests keeps live outputs."""
    wrong = []
    with session(context, "2x1", display) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run, *options) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            viewer.ask("subscribe", {"topic": "outputs", "interval": 200})
            is_live = lambda data: len(data) == 2 and all(e["ageSeconds"] < LIVE_SECONDS for e in data.values())
            first = outputs(viewer, is_live)
            second = first and outputs(viewer, lambda data: is_live(data) and all(data[n]["frame"] > first[n]["frame"] for n in data))
            if second is None:
                return "no live outputs: %s" % first
            if any(second[n]["hash"] == first[n]["hash"] for n in first):
                wrong.append("the same hash of different frames: %s, %s" % (first, second))
            if any((entry["skewMs"] is None) != (display == "app") for entry in second.values()):
                wrong.append("skew: %s" % second)
            nodes = {node["node"]: node["pid"] for node in result_of(context, run, "status")["nodes"]}
            os.kill(nodes[1], signal.SIGSTOP)
            frozen = outputs(viewer, lambda data: data[1]["ageSeconds"] > FROZEN_SECONDS, 30)
            os.kill(nodes[1], signal.SIGCONT)
            # Nodes with windows wait for each other at each swap.
            if frozen is None or (display == "app" and frozen[0]["ageSeconds"] > LIVE_SECONDS):
                wrong.append("node 1 is stopped, and node 0 is not: %s" % frozen)
            again = outputs(viewer, is_live)
            if again is None:
                wrong.append("no live outputs after the node goes on")
            programs = run.processes(r"long_run")
            for pid in programs:
                os.kill(pid, signal.SIGSTOP)
            time.sleep(1)
            rests = outputs(viewer, is_live)
            later = rests and outputs(viewer, lambda data: is_live(data))
            for pid in programs:
                os.kill(pid, signal.SIGCONT)
            if later is None or any((later[n]["hash"], later[n]["frame"]) != (rests[n]["hash"], rests[n]["frame"]) for n in rests):
                wrong.append("the program rests: %s, %s" % (rests, later))
        return ended(context, run, wrong)


@cases.case
def proof_by_the_head(context):
    """The head has the pictures (--display app)."""
    return proofs(context, "app")


@cases.case
def proof_by_the_nodes(context):
    """The nodes have windows of their own (--display windows)."""
    return proofs(context, "windows")


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
