"""Processes of a run under test, identified by a word in their environment."""

import os
import time


def processes_with(word):
    """Returns {pid: command line} of the live processes with the word in their environment."""
    found = {}
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/environ" % pid, "rb") as environment, open("/proc/%s/cmdline" % pid, "rb") as command:
                if word.encode() not in environment.read():
                    continue
                words = command.read().split(b"\0")
        except OSError:
            continue  # has ended meanwhile, or belongs to another user
        if words != [b""]:  # a process that has ended has no command line
            found[int(pid)] = b" ".join(words).decode(errors="replace").strip()
    return found


def until(condition, seconds):
    """Waits for a condition. Returns False after the timeout."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True
