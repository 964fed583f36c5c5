#!/usr/bin/env python3
"""A bench that is stopped while its programs run: it ends soon, says so, and leaves neither processes nor folders."""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
STOPPED = 130
START_SECONDS, END_SECONDS = 60, 60


def processes_with(word):
    """Names of processes in whose environment the word stands."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/environ" % pid, "rb") as environment, open("/proc/%s/comm" % pid, encoding="utf-8") as name:
                if word.encode() in environment.read():
                    found.append(name.read().strip())
        except OSError:
            pass  # ended meanwhile, or another user's
    return found


def until(condition, seconds):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.05)
    return True


def fault_of(a, number):
    """Empty: all is as it should be."""
    with tempfile.TemporaryDirectory(prefix="mural-stopped.") as folder:
        inside = os.path.join(folder, "temporary")
        os.mkdir(inside)
        process = subprocess.Popen([sys.executable, os.path.join(TOP, "tools", "bench", "economy"), "--program", "glxgears", "--frames", "1000000",
                                    "--mural", a.mural, "--stream-sizes", a.stream_sizes],
                                   env=dict(os.environ, TMPDIR=inside), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        if not until(lambda: "glxgears" in processes_with(inside), START_SECONDS):
            process.kill()
            return "the program that it measures did not start within %d s" % START_SECONDS
        process.send_signal(number)
        try:
            said = process.communicate(timeout=END_SECONDS)[1].decode()
        except subprocess.TimeoutExpired:
            process.kill()
            return "it went on for %d s" % END_SECONDS
        if process.returncode != STOPPED:
            return "its status is %d, not %d; it said: %s" % (process.returncode, STOPPED, said)
        if "stopped" not in said:
            return "it does not say that it was stopped: " + said
        # What Mural has started ends by itself, soon.
        if not until(lambda: not processes_with(inside), END_SECONDS):
            return "these go on: " + ", ".join(processes_with(inside))
        left = os.listdir(inside)
        return "these are left: " + ", ".join(left) if left else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mural", required=True)
    parser.add_argument("--stream-sizes", required=True)
    a = parser.parse_args()
    faults = 0
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        fault = fault_of(a, number)
        print("%s: %s" % (number.name, fault or "it ends, and leaves nothing"))
        faults += bool(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
