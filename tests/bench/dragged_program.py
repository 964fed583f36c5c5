#!/usr/bin/env python3
"""tools/bench/dragged moves the mouse over the program's window with the button pressed, returns the program's status,
and passes signals on.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
DRAGGED = os.path.join(TOP, "tools", "bench", "dragged")
LIMIT_SECONDS, SKIPPED = 60, 77
MIN_POSITIONS = 10
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))

from harness.display import PrivateDisplay
from harness.processes import until


def moves_fault(folder, environment):
    """Returns an error unless xev reports the mouse position and the button."""
    seen = os.path.join(folder, "seen")
    with open(seen, "wb") as file:
        process = subprocess.Popen([DRAGGED, "xev", "-geometry", "300x200+450+350", "-event", "mouse", "-event", "button"], env=environment, stdin=subprocess.DEVNULL, stdout=file)

    def events():
        with open(seen, encoding="utf-8", errors="replace") as file:
            return file.read()

    def dragged():
        found = re.findall(r"MotionNotify.*\n.*root:\((\d+),(\d+)\).*\n +state 0x100,", events())
        return len(set(found)) >= MIN_POSITIONS and "ButtonRelease" in events() and all(450 <= int(x) < 750 and 350 <= int(y) < 550 for x, y in found)
    was_dragged = until(dragged, LIMIT_SECONDS)
    process.send_signal(signal.SIGTERM)
    try:
        status = process.wait(LIMIT_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        return "it continued after SIGTERM"
    if not was_dragged:
        return "the window saw no drag; it saw: " + events()[-2000:]
    return "" if status == 128 + signal.SIGTERM else "the program that a signal has ended has status %d" % status


def status_fault(environment):
    for command, status in ((["sh", "-c", "exit 7"], 7), (["true"], 0)):
        done = subprocess.run([DRAGGED, *command], env=environment, stdin=subprocess.DEVNULL, timeout=LIMIT_SECONDS, check=False)
        if done.returncode != status:
            return "%s: status %d" % (command, done.returncode)
    done = subprocess.run([DRAGGED, "no-such-program"], env=environment, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=LIMIT_SECONDS, check=False)
    return "" if done.returncode == 1 and b"no-such-program" in done.stderr else "a program that is not there: status %d, %s" % (done.returncode, done.stderr)


def main():
    missing = [tool for tool in ("xdotool", "xev", "xprop") if not shutil.which(tool)]
    if missing:
        print("skipped: %s not installed: apt-get install xdotool x11-utils" % " and ".join(missing))
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="mural-dragged.") as folder, PrivateDisplay("800x600x24") as display:
        environment = dict(os.environ, DISPLAY=display)
        subprocess.run(["xprop", "-root", "-f", "WM_NAME", "8s", "-set", "WM_NAME", "root"], env=environment, timeout=LIMIT_SECONDS, check=True) # as Qt does
        faults = [("the mouse", moves_fault(folder, environment)), ("the program's end", status_fault(environment))]
    for what, fault in faults:
        print("%s: %s" % (what, fault or "as it should be"))
    return 1 if any(fault for _, fault in faults) else 0


if __name__ == "__main__":
    sys.exit(main())
