#!/usr/bin/env python3
"""`mural ctl` and the control socket of a running session: operations, subscriptions, bad input, the end.

mural_ctl.py --build build/release [--cases operations,restart,stop] [--list]
"""

import json
import os
import socket
import stat
import subprocess
import sys
import time

try:
    import jsonschema
except ImportError:  # Debian's package serves Debian's Python only
    jsonschema = None

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases  # noqa: E402
from harness.control import PATIENCE_SECONDS, Connection, ctl, result_of, socket_of  # noqa: E402

SCHEMA = os.path.join(TOP, "docs", "reference", "control.schema.json")


def drawing(context, *options):
    return context.run([context.program("long_run"), "--frames", "1000000", "--size", "250x190"], ["--tiles", "2x1", "--display", "none", *options])


@cases.case
def operations(context):
    """Texts, JSON and exit statuses of the common operations."""
    with drawing(context) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        pid = str(run.process.pid)
        wrong = []
        for words, wanted_status, wanted in (
                ((pid, "help"), 0, "restart-node NODE"), ((pid, "status"), 0, "session %s " % pid), ((pid, "nodes"), 0, "node 1  local"),
                ((pid, "report"), 0, "roundTrips"), ((pid, "log-level", "rsp:debug"), 0, "rsp"), ((pid, "--json", "nodes"), 0, '"state":"alive"'),
                ((pid, "statsu"), 2, "similar names: status"), ((pid, "log-level", "loud"), 1, "loud"), ((pid, "restart-node"), 2, "usage: mural ctl"),
                ((pid, "restart-node", "one"), 2, "whole number"), ((pid, "restart-node", "7"), 1, "no node 7"), ((pid,), 2, "command"),
                ((pid, "remove-node", "1"), 1, "force"), (("1", "status"), 1, "no session has the name 1"), (("/none", "status"), 1, "/none")):
            status, output, errors = ctl(context, *words)
            if status != wanted_status or wanted not in output + errors or (status != 0 and errors.count("\n") != 1):
                wrong.append("%s: status %d, output %s, errors %s" % (" ".join(words), status, output, errors))
        session = result_of(context, run, "status")
        wrong += ["frames"] if session.get("frames", 0) < 50 else []
        mode = stat.S_IMODE(os.stat(socket_of(run)).st_mode)
        wrong += ["mode %o" % mode] if mode != 0o600 else []
        return "; ".join(wrong) or None


@cases.case
def restart_node(context):
    """A restarted node becomes a member again, and the program continues."""
    with drawing(context) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        before = result_of(context, run, "nodes")["nodes"][1]
        status, _, errors = ctl(context, str(run.process.pid), "restart-node", "1")
        if status != 0:
            return "restart-node: %s" % errors
        deadline = time.monotonic() + PATIENCE_SECONDS
        while time.monotonic() < deadline:
            node = result_of(context, run, "nodes")["nodes"][1]
            if node["joins"] == 1 and node["state"] == "alive":
                break
            time.sleep(0.1)
        if node["joins"] != 1 or node["pid"] == before["pid"]:
            return "node 1 did not join again: %s; output: %s" % (node, run.standard_error[-3:])
        frames = result_of(context, run, "status")["frames"]
        time.sleep(1)
        return None if result_of(context, run, "status")["frames"] > frames else "no frames after the restart"


@cases.case
def subscriptions(context):
    """Messages of all topics arrive; they and the replies fit the schema."""
    with drawing(context) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        connection = Connection(socket_of(run))
        lines = [connection.line(), connection.request('{"id":1,"op":"help"}'), connection.request('{"id":2,"op":"status"}'),
                 connection.request('{"id":3,"op":"none"}')]
        for number, topic in enumerate(("events", "status", "log")):
            connection.socket.sendall(b'{"id":%d,"op":"subscribe","args":{"topic":"%s","interval":50}}\n' % (10 + number, topic.encode()))
        connection.socket.sendall(b'{"id":20,"op":"stop"}\n')
        topics = {}
        while (line := connection.line()) is not None:
            lines.append(line)
            if "topic" in line:
                topics.setdefault(line["topic"], []).append(line["data"])
        connection.close()
        wrong = [topic for topic in ("events", "status", "log") if topic not in topics]
        events = [entry["event"] for data in topics.get("events", []) for entry in data]
        wrong += ["no stop-requested in %s" % events] if "stop-requested" not in events else []
        wrong += [] if "mural ctl stop" in json.dumps(topics.get("log")) else ["no line in %s" % topics.get("log")]
        if jsonschema is None:
            print("    no comparison with the schema: this Python has no module jsonschema")
        else:
            with open(SCHEMA, encoding="utf-8") as file:
                validator = jsonschema.Draft7Validator(json.load(file))
            wrong += ["%s in %s" % (error.message[:200], json.dumps(line)[:200]) for line in lines for error in validator.iter_errors(line)]
        return "wrong are %s" % "; ".join(wrong) if wrong else None


@cases.case
def printed_messages(context):
    """`mural ctl subscribe` prints log lines until the session ends."""
    with drawing(context) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        pid = str(run.process.pid)
        with subprocess.Popen([context.mural, "ctl", pid, "subscribe", "log"], stdout=subprocess.PIPE) as reader:
            time.sleep(1)
            ctl(context, pid, "stop")
            output = reader.communicate(timeout=PATIENCE_SECONDS)[0].decode()
        return None if reader.returncode == 0 and "session info: " in output else "status %d, output: %s" % (reader.returncode, output)


@cases.case
def stop(context):
    """The session ends in order."""
    with drawing(context) as run:
        if not run.wait_for_line("frame 50"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        folder = os.path.dirname(socket_of(run))
        status, _, errors = ctl(context, str(run.process.pid), "stop")
        if status != 0:
            return "stop: %s" % errors
        wrong = cases.check_end(run, 0)
        return wrong or ("%s is left over" % folder if os.path.exists(folder) else None)


@cases.case
def bad_input(context):
    """Half messages, long lines, floods and silent readers lose their connection at most; the program continues."""
    with drawing(context) as run:
        if not run.wait_for_line("frame 20"):
            return "no frames: %s" % " | ".join(run.standard_error[-3:])
        path = socket_of(run)
        for bytes_sent in (b"", b"\0" * 1000, b"{", b'{"id":1,"op":', b"[" * 60000 + b"\n", b"x" * 200000):
            connection = Connection(path)
            try:
                connection.socket.sendall(bytes_sent)
            except (BrokenPipeError, ConnectionResetError):
                pass
            connection.close()
        silent = Connection(path)
        silent.socket.setblocking(False)
        requests = b'{"id":1,"op":"status"}\n' * 1000
        for _ in range(1000):  # 10^6 requests; the socket accepts them until its buffers are full
            try:
                silent.socket.send(requests)
            except (BlockingIOError, ConnectionError):
                time.sleep(0.005)
        frames = result_of(context, run, "status").get("frames", 0)
        time.sleep(1)
        later = result_of(context, run, "status").get("frames", 0)
        silent.close()
        if later <= frames:
            return "no frames during the flood: %d, then %d" % (frames, later)
        ctl(context, str(run.process.pid), "stop")
        return cases.check_end(run, 0)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
