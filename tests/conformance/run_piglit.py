#!/usr/bin/env python3
"""Runs tests of piglit (Debian package `piglit`), each natively and through Mural on the same nodes. The results must
be equal. The tests check their own pictures with glReadPixels, so no stored results are needed.

  run_piglit.py --build build/release [--list piglit.txt] [--filter glsl] [--part 1/3] [--tiles 2x2]

Prints one line per test that differs; the status is 1 if one does, 77 if piglit is not installed.
"""

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "end_to_end"))

from harness import display  # noqa: E402  (found by the path above)
from harness import programs  # noqa: E402
from harness import shared_nodes  # noqa: E402

ROOT = "/usr/lib/x86_64-linux-gnu/piglit"
NOT_INSTALLED = 77


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--mural", help="the launcher; default BUILD/bin/mural")
    parser.add_argument("--list", default=os.path.join(HERE, "piglit.txt"), help="one command per line")
    parser.add_argument("--filter", default="", help="only commands that fit this pattern")
    parser.add_argument("--part", default="1/1", help="K/N: each Nth command from the Kth on")
    parser.add_argument("--tiles", default="2x2")
    parser.add_argument("--seconds", type=int, default=60)
    return parser.parse_args()


def commands(arguments):
    part, parts = (int(word) for word in arguments.part.split("/"))
    with open(arguments.list, encoding="utf-8") as file:
        lines = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    chosen = [line for line in lines if re.search(arguments.filter, line)]
    return chosen[part - 1::parts]


def results(output):
    """Returns the total result and the results of sub-tests, as piglit's tests print them."""
    found = []
    for line in output.splitlines():
        if line.startswith("PIGLIT: "):
            found.append(json.dumps(json.loads(line[len("PIGLIT: "):]), sort_keys=True))
    return found


def words_of(command):
    words = command.split()
    return [os.path.join(ROOT, "bin", words[0])] + words[1:] + ["-auto"]


def run_natively(command, display_name, seconds):
    environment = programs.clean_environment(display_name)
    environment["PIGLIT_SOURCE_DIR"] = ROOT
    process = subprocess.Popen(words_of(command), cwd=ROOT, env=environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        output = process.communicate(timeout=seconds)[0].decode(errors="replace")
        return process.returncode, results(output)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return None, []


class Wall:
    """Nodes that draw one test after another; new ones after a test that did not end, or that ended them."""

    def __init__(self, arguments, display_name, folder):
        self.arguments, self.display_name, self.folder = arguments, display_name, folder
        self.nodes, self.started = None, 0

    def run(self, command):
        if self.nodes is None:
            self.started += 1
            mural = self.arguments.mural or os.path.join(os.path.abspath(self.arguments.build), "bin", "mural")
            launcher = [mural, "run", "--tiles", self.arguments.tiles, "--display", "none", "--quiet", "--"]
            self.nodes = shared_nodes.SharedNodes(launcher, self.display_name, os.path.join(self.folder, "nodes%d" % self.started))
        status, output = self.nodes.run("cd %s && PIGLIT_SOURCE_DIR=%s" % (ROOT, ROOT), words_of(command), os.path.join(self.folder, "log"), self.arguments.seconds)
        if status is None:
            self.end()
        return status, results(output), output

    def end(self):
        """Returns the status of `mural run`."""
        nodes, self.nodes = self.nodes, None
        return nodes.end(self.arguments.seconds) if nodes else 0


def known_differences():
    """Returns command -> reason, from known_differences.txt."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "known_differences.txt")
    known = {}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            if line.strip() and not line.startswith("#"):
                command, _, reason = line.partition(" # ")
                known[command.strip()] = reason.strip()
    return known


def main():
    arguments = parse_arguments()
    if not os.path.isdir(ROOT):
        print("piglit is not installed: apt-get install piglit")
        return NOT_INSTALLED
    wrong = expected = 0
    known = known_differences()
    chosen = commands(arguments)
    with tempfile.TemporaryDirectory(prefix="mural-piglit.") as folder, display.PrivateDisplay() as display_name:
        wall = Wall(arguments, display_name, folder)
        for command in chosen:
            native_status, native = run_natively(command, display_name, arguments.seconds)
            status, through, output = wall.run(command)
            if not native:
                wrong += 1
                print("%s: no result natively; take it out of the list" % command, flush=True)
            elif native != through or not programs.same_status(native_status, status):
                if command in known:
                    expected += 1
                    print("%s: known to differ: %s" % (command, known[command]), flush=True)
                    continue
                wrong += 1
                printed = [line for line in output.splitlines() if line.strip() and "PIGLIT" not in line]
                print("%s: status %s, %s instead of status %s, %s; output: %s" % (
                    command, status, " ".join(through) or "no result", native_status, " ".join(native),
                    " | ".join(printed[-3:])), flush=True)
        end = wall.end()
        if end != 0:
            wrong += 1
            print("status %s of the run for all tests" % end)
    print("%d piglit tests, %d differ from the native run, %d known to differ" % (len(chosen), wrong, expected))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
