#!/usr/bin/env python3
"""Random sequences of changes to a running session. No pixel differs, nothing hangs, and the heads' memory stays stable.

random_changes.py --build build/release [--cases exact,killed] [--list]
RANDOM_CHANGES=200 and RANDOM_SEEDS=1,2,3 in the environment change the number of changes and the seeds. A
slow machine performs fewer changes, unless RANDOM_CHANGES is set. Each seed prints the head's own memory, without rings that
it shares with other processes, after equally many changes, and its slope in the second half.
"""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, length, session  # noqa: E402
from harness.control import PATIENCE_SECONDS, ctl, result_of  # noqa: E402

CHANGES = int(os.environ.get("RANDOM_CHANGES", "40" if length.LONG else "24"))
SEEDS = [int(seed) for seed in os.environ.get("RANDOM_SEEDS", "1").split(",")]
SECONDS = float("inf") if "RANDOM_CHANGES" in os.environ else 100  # limit for the changes of one seed beyond the least number
LEAST_CHANGES = 16
GROWTH_MIB = 64  # allowed growth in the second half
GROWTH_MIB_PER_SECOND = 3  # and of the rejoin log, whose thread shares its core with the nodes
NODES = 3
PAUSE_US = "1000" if length.LONG else "40000"  # per frame; a session without pauses takes the CPU time of other tests
PLANS = [("--balance", "auto", "--local-nodes", "3"), ("--tiles", "2x1"), ("--balance", "load", "--local-nodes", "2"), ("--db", "2"),
         ("--dplex", "2"), ("--tile-queue", "64x64", "--local-nodes", "3"), ("--undo",)]


SAMPLES = 20  # printed values of the memory


def memory_kib(pid, name="VmRSS"):
    with open("/proc/%d/status" % pid, encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(name))


def memory_mib(pid):
    return memory_kib(pid) // 1024


def print_memory(seed, kib):
    """kib: the head's own memory after each change."""
    shown = ["%.1f" % (kib[i] / 1024) for i in range(0, len(kib), max(1, len(kib) // SAMPLES))]
    late = kib[len(kib) // 2:]
    middle = (len(late) - 1) / 2
    spread = sum((i - middle) ** 2 for i in range(len(late)))
    slope = sum((i - middle) * value for i, value in enumerate(late)) / spread if spread else 0
    print("    seed %d: own MiB of the head: %s; %.0f KiB per change in the second half" % (seed, " ".join(shown), slope))


def end_recording(context, run):
    """Ends the recording, if any, because its queue occupies up to 64 MiB while the disk is slow."""
    ctl(context, str(run.process.pid), "record", "stop")


def memory_below(pid, limit_mib):
    """Waits until the memory is below the limit, because a joining node needs queues for a while; returns the memory."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while memory_mib(pid) >= limit_mib and time.monotonic() < deadline:
        time.sleep(0.1)
    return memory_mib(pid)


def frames_go_on(context, run):
    """Returns whether the wall shows further frames in time."""
    before, deadline = None, time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline and run.process.poll() is None:
        frames = result_of(context, run, "status").get("frames")  # none after a failure
        before = frames if before is None else before
        if frames is not None and frames > before + 1:
            return True
        time.sleep(0.01)
    return False


def change_plan(context, run, words):
    """Returns (exit status, errors) of `mural change`."""
    done = subprocess.run([context.mural, "change", str(run.process.pid), *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=PATIENCE_SECONDS, check=False)
    return done.returncode, done.stderr.decode()


def change(context, run, numbers, folder, kills):
    """Performs one change; returns its words, and whether it succeeded. A refused change is right as well."""
    number = numbers.randrange(1000)
    present = [entry["node"] for entry in result_of(context, run, "nodes").get("nodes", [])]
    node = numbers.choice(present or range(NODES))
    changes = [("latency", str(numbers.randrange(5))), ("record", "start", os.path.join(folder, "%d.mural" % number)), ("record", "stop"),
               ("stop-node", str(node)), ("start-node", str(node)), ("stop-node", str(node)), ("start-node", str(node)), ("frames",),
               ("overlay", numbers.choice(("off", "stats", "names", "grid")))]
    if kills and numbers.random() < 0.15:
        alive = run.processes(cases.NODE)
        if len(alive) < 2:
            return ("kill",), False
        try:
            os.kill(numbers.choice(alive), signal.SIGKILL)
        except ProcessLookupError:  # the node has just ended
            return ("kill",), False
        return ("kill",), True
    if numbers.random() < 0.3:
        words = ("change",) + numbers.choice(PLANS)
        status, message = change_plan(context, run, words[1:])
    else:
        words = numbers.choice(changes)
        status, _, message = ctl(context, str(run.process.pid), *words)
    if status != 0 and (status != 1 or message.count("\n") != 1):
        raise SystemExit("%s: status %d, %s" % (" ".join(words), status, message))
    return words, status == 0


def perform(context, seed, kills):
    numbers = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="mural-changes.") as folder:
        report, end_file = os.path.join(folder, "report.json"), os.path.join(folder, "end")
        command = [context.program("long_scene"), "--frames", "1000000", "--size", "200x150"]
        options = ["--balance", "auto", "--local-nodes", str(NODES), "--display", "none", "--restart-nodes", "1000", "--report", report]
        with context.run(command, options + ([] if kills else ["--verify"]), {"SCENE_MIB": "4", "SCENE_PAUSE_US": PAUSE_US, "END_FILE": end_file}) as run:
            if not frames_go_on(context, run):
                return "no frames: %s" % " | ".join(run.standard_error[-3:])
            head = run.wait_for_processes(cases.HEAD)[0]
            done, count, early, memory = {}, 0, None, []
            began = time.monotonic()
            while count < CHANGES and (count < LEAST_CHANGES or time.monotonic() < began + SECONDS or (kills and not done.get("kill"))):
                words, succeeded = change(context, run, numbers, folder, kills)
                done[words[0]] = done.get(words[0], 0) + succeeded
                if not frames_go_on(context, run):
                    return "no frames after %s, change %d of seed %d: %s" % (" ".join(words), count, seed, " | ".join(run.standard_error[-5:]))
                count += 1
                memory.append(memory_kib(head, "RssAnon"))
                is_half = count > CHANGES // 2 or (2 * count >= LEAST_CHANGES and time.monotonic() > began + SECONDS / 2)
                if early is None and is_half:
                    end_recording(context, run)
                    early, early_time = memory_mib(head), time.monotonic()
            end_recording(context, run)
            limit = early + GROWTH_MIB + GROWTH_MIB_PER_SECOND * (time.monotonic() - early_time)
            late = memory_mib(head) if kills else memory_below(head, limit)
            session.end_after(end_file, 3)
            wrong = cases.check_end(run, 0)
        if wrong is not None:
            return "seed %d: %s" % (seed, wrong)
        with open(report, encoding="utf-8") as file:
            numbers_at_end = json.load(file)
    print_memory(seed, memory)
    print("    seed %d: %d changes, %s; head %d MiB, then %d; %d frames compared, %d pixels differ" % (
        seed, count, ", ".join("%s %d" % item for item in sorted(done.items())), early, late, numbers_at_end["verifiedFrames"], numbers_at_end["differingPixels"]))
    # Without --verify the program draws so many frames that the rejoin log alone grows by 2 MiB per second.
    grows = not kills and late >= limit
    return None if numbers_at_end["differingPixels"] == 0 and not grows else "seed %d: pixels differ, or the memory grows" % seed


def all_seeds(context, kills):
    wrong = [perform(context, seed, kills) for seed in SEEDS]
    return "; ".join(text for text in wrong if text) or None


@cases.case
def exact(context):
    """Every frame is compared with the program's own GL."""
    return all_seeds(context, False)


@cases.case
def killed_nodes(context):
    """Nodes are killed between the changes. The program continues to the end."""
    return all_seeds(context, True)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
