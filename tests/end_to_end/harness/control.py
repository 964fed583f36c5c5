"""Requests of `mural ctl` to a session under test."""

import glob
import json
import os
import socket
import subprocess

PATIENCE_SECONDS = 60


def ctl(context, *words):
    """Returns (exit status, output, errors)."""
    done = subprocess.run([context.mural, "ctl", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=PATIENCE_SECONDS, check=False)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def socket_of(run):
    """Returns the path of the control socket; None if the session has none yet."""
    folders = {os.environ.get("XDG_RUNTIME_DIR", "/tmp"), "/tmp"}
    found = [path for folder in folders for path in glob.glob("%s/mural-%d-*/control" % (folder, run.process.pid))]
    return found[0] if found else None


class Connection:
    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.settimeout(PATIENCE_SECONDS)
        self.socket.connect(path)
        self.lines = self.socket.makefile("rb")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def line(self):
        text = self.lines.readline()
        return json.loads(text) if text else None

    def request(self, text):
        self.socket.sendall(text.encode() + b"\n")
        return self.line()

    def close(self):
        self.lines.close()
        self.socket.close()


def _requested(run, operation):
    path = socket_of(run)
    if path is None:
        return {"error": "the session has no control socket"}
    try:
        with Connection(path) as connection:
            connection.line()  # hello
            reply = connection.request(json.dumps({"id": 1, "op": operation}))
    except OSError as e:
        return {"error": str(e)}
    if reply is None:
        return {"error": "the session closed the connection"}
    return reply["result"] if reply["ok"] else {"error": reply["error"]}


def result_of(context, run, *words):
    """Returns the result of an operation of this run; after a failure the member "error" has its text.

    Operations without arguments use the socket, because tests repeat them until something happens, and the start of a
    process costs more CPU time than a frame."""
    if len(words) == 1:
        return _requested(run, words[0])
    status, output, errors = ctl(context, "--json", str(run.process.pid), *words)
    return json.loads(output)["result"] if status == 0 else {"error": errors}
