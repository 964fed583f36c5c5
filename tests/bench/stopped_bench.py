#!/usr/bin/env python3
"""A bench that is stopped while its programs run ends soon, reports it, and leaves neither processes nor folders."""

import argparse
import os
import signal
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
STOPPED = 130
START_SECONDS, END_SECONDS = 60, 60
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))

from harness.processes import processes_with, until


def fault_of(a, number):
    """Returns an error, or an empty text."""
    with tempfile.TemporaryDirectory(prefix="mural-stopped.") as folder:
        inside = os.path.join(folder, "temporary")
        os.mkdir(inside)
        process = subprocess.Popen([sys.executable, os.path.join(TOP, "tools", "bench", "delta"), "--program", "glxgears", "--frames", "1000000",
                                    "--mural", a.mural, "--stream-sizes", a.stream_sizes],
                                   env=dict(os.environ, TMPDIR=inside), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        if not until(lambda: any(line.split()[0].endswith("glxgears") for line in processes_with(inside).values()), START_SECONDS):
            process.kill()
            return "the program that it measures did not start within %d s" % START_SECONDS
        process.send_signal(number)
        try:
            output = process.communicate(timeout=END_SECONDS)[1].decode()
        except subprocess.TimeoutExpired:
            process.kill()
            return "it continued for %d s" % END_SECONDS
        if process.returncode != STOPPED:
            return "its status is %d, not %d; output: %s" % (process.returncode, STOPPED, output)
        if "stopped" not in output:
            return "it does not report the stop: " + output
        # Processes that Mural started end without help, soon.
        if not until(lambda: not processes_with(inside), END_SECONDS):
            return "these go on: " + ", ".join(processes_with(inside).values())
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
