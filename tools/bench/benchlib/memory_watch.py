"""Memory of the processes of a `mural run`, at selected frames of its program."""

import glob
import json
import os
import re
import signal
import socket
import subprocess
import time

from benchlib.cpu_times import descendants
from benchlib.mural_runs import RunFailed, role_of

KINDS = ("Rss", "Pss", "Private")
LOOK_SECONDS = 0.01


def memory_of(pid):
    """Returns {"Rss", "Pss", "Private"} in MiB; private memory is shared with no other process. None: the process has
    ended."""
    sums = {}
    try:
        with open("/proc/%d/smaps_rollup" % pid, encoding="ascii") as file:
            for line in file:
                name, _, value = line.partition(":")
                if value.strip().endswith("kB"):
                    sums[name] = int(value.split()[0]) / 1024.0
    except (OSError, ValueError):
        return None
    if "Rss" not in sums:
        return None
    return {"Rss": sums["Rss"], "Pss": sums["Pss"], "Private": sums["Private_Clean"] + sums["Private_Dirty"]}


def _session_state(run_pid):
    """Returns the status of this `mural run` from its control socket (docs/reference/control.md); None: no reply yet."""
    with open("/proc/net/unix", encoding="ascii", errors="replace") as file:
        paths = set(re.findall(r" (/.*/mural-%d-[0-9a-f]+/control)$" % run_pid, file.read(), re.MULTILINE))
    for path in paths:
        try:
            with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
                connection.settimeout(5)
                connection.connect(path)
                connection.sendall(b'{"id":1,"op":"status"}\n')
                with connection.makefile("rb") as lines:
                    lines.readline()  # hello
                    return json.loads(lines.readline())["result"]
        except (OSError, ValueError, KeyError):
            continue
    return None


def _native_frames(run_pid):
    """Returns the frame count that `mural run --native` reads as well."""
    for link in glob.glob("/proc/%d/fd/*" % run_pid):
        try:
            if "mural-native-report" in os.readlink(link):
                with open(link, encoding="ascii") as file:
                    lines = file.read().split("\n")
                return int(lines[-2].split()[0]) if len(lines) > 1 else 0
        except (OSError, ValueError, IndexError):
            continue
    return 0


class MemoryWatch:
    """`run(…)` returns {mark: {role: [memory of each process]}}; roles: app, head, node."""

    def __init__(self, mural, environment, limit_seconds=900):
        self.mural = mural
        self.environment = environment
        self.limit_seconds = limit_seconds

    def run(self, options, program, marks):
        command = [self.mural, "run", "--quiet", "--frames", str(max(marks) + 200), *options, "--", *program]
        process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        native = "--native" in options
        try:
            seen = self._watch(process, native, sorted(marks))
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
            process.wait(60)
        missing = [mark for mark in marks if mark not in seen]
        if missing:
            raise RunFailed("frame %d was not seen: %s" % (missing[0], " ".join(command)))
        return seen

    def _watch(self, process, native, marks):
        seen, ahead = {}, list(marks)
        deadline = time.monotonic() + self.limit_seconds
        while ahead and process.poll() is None and time.monotonic() < deadline:
            frames, drawing = self._frames(process.pid, native)
            while ahead and frames >= ahead[0]:
                seen[ahead.pop(0)] = self._look(process.pid, drawing)
            time.sleep(LOOK_SECONDS)
        return seen

    @staticmethod
    def _frames(run_pid, native):
        """Returns the number of frames, and the pids of the programs that draw (None: unknown)."""
        if native:
            return _native_frames(run_pid), None
        state = _session_state(run_pid)
        programs = (state or {}).get("programs", [])
        return max([p["frames"] for p in programs], default=0), {p["pid"] for p in programs}

    @staticmethod
    def _look(run_pid, drawing):
        found = {}
        for pid in descendants(run_pid):
            try:
                with open("/proc/%d/cmdline" % pid, "rb") as file:
                    words = [w.decode(errors="replace") for w in file.read().split(b"\0")[:-1]]
            except OSError:
                continue
            role = role_of(words) if words else None
            if role == "app" and drawing is not None and pid not in drawing:
                continue
            memory = memory_of(pid) if role else None
            if memory:
                found.setdefault(role, []).append(memory)
        return found
