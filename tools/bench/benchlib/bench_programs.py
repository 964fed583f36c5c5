"""The programs that benches run, and the `mural` binary that they measure."""

import os
import re
import shlex
import shutil
import subprocess
import sys


def find_mural(wish, top, tool):
    """Returns the absolute path of the `mural` to measure. Ends the tool with one line if there is none."""
    path = wish or os.path.join(top, "build", "release", "bin", "mural")
    if not os.path.isfile(path):
        path = shutil.which(wish or "mural")
    if not path:
        sys.exit("%s: no mural at %s; build it with tools/try, or give --mural PATH" % (tool, wish or "build/release/bin"))
    return os.path.abspath(path)


def split_command(command):
    """"A=1 prog -x" → ({"A": "1"}, ["prog", "-x"])"""
    words = shlex.split(command)
    environment = {}
    while words and re.match(r"[A-Za-z_][A-Za-z0-9_]*=", words[0]):
        name, _, value = words.pop(0).partition("=")
        environment[name] = value
    return environment, words


def installed(command):
    program = split_command(command)[1]
    return bool(program) and shutil.which(program[0]) is not None


def read_list(path):
    """Returns the commands of a file, one per line; "#" begins a comment."""
    with open(path, encoding="utf-8") as file:
        lines = [line.strip() for line in file]
    return [line for line in lines if line and not line.startswith("#")]


def glmark_scenes():
    """Returns the names of glmark2's scenes that draw; empty if glmark2 is not installed."""
    if not shutil.which("glmark2"):
        return []
    output = subprocess.run(["glmark2", "--list-scenes"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=60, check=False)
    names = re.findall(r"^\[Scene\] (\S+)", output.stdout.decode(), re.MULTILINE)
    return [name for name in names if name != "default"]
