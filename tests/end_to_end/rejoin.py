#!/usr/bin/env python3
"""Nodes that are killed during a run rejoin; saved pictures are compared with native ones. Frames after the rejoin are
exact, the other nodes' parts always are, and no process waits for long.

  rejoin.py --build build/release [--cases one,several] [--list]
"""

import glob
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

from harness import cases, length, session
from harness.rejoin_watch import (
    BACK, EXACT, MAX_FRAMES, START, TAIL, WIDTH, Watch, columns_that_differ, divided, first_nodes, frame_times,
    judged, kill_and_compare, latest_frame, node_pid, nodes_of, printed, saved_pictures)

case = cases.case


@case
def one_node(context):
    return kill_and_compare(context)


@cases.long_case
def several_one_after_the_other(context):
    return kill_and_compare(context, victims=(1, 0, 1))


@case
def with_delta(context):
    """The dictionary of delta coding starts again with each rejoin."""
    return kill_and_compare(context, options=("--delta", "on"), victims=(1, 0))


@case
def with_culling(context):
    """The returning node knows no contents of buffers yet. The audit ends the run with status 1 for a fault."""
    return kill_and_compare(context, options=("--culling", "audit"), environment={"SCENE_LISTS": "1"}, victims=(1, 0) if length.LONG else (0,))


@cases.long_case
def by_tcp(context):
    """Nodes as on other machines: started again with the same command, connected again by TCP."""
    return kill_and_compare(context, options=("--nodes", "localhost,localhost", "--stream", "tcp"), where="localhost")


@case
def by_multicast(context):
    """The returning node receives the stream over its own connection, the other one continues with the group."""
    return kill_and_compare(context, options=("--nodes", "localhost,localhost", "--stream", "rsp://239.255.77.9:4299?interface=127.0.0.1"), where="localhost")


@case
def waiting_node(context):
    """The head calls `mural node --wait` again; the secret and the port are unchanged."""
    host = "127.0.0.2"  # an address of this machine without a daemon of its user
    with tempfile.TemporaryDirectory(prefix="mural-rejoin-key.") as folder:
        secret = os.path.join(folder, "key")
        with open(secret, "w", encoding="ascii") as file:
            file.write(os.urandom(32).hex())
        os.chmod(secret, 0o600)
        command = [context.mural, "node", "--wait", "--secret", secret, "--listen", host + ":4279", "--discovery", "beacon"]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as waiting:
            try:
                while "waits for heads" not in waiting.stderr.readline():
                    if waiting.poll() is not None:
                        return "the daemon ended"
                watch = Watch(context, options=("--nodes", "%s,%s" % (host, host), "--launch", "%s call --secret %s" % (context.mural, secret)))
                with watch.start() as run:
                    if not run.wait_for_line("frame %d " % START):
                        return "the program did not start: " + " | ".join(run.standard_error[-3:])
                    frame = latest_frame(run)
                    os.kill(children_of(waiting.pid)[1], signal.SIGKILL)
                    if not run.wait_for_line(BACK, 30):
                        return "it did not rejoin: " + " | ".join(run.standard_error[-4:])
                    watch.enough(run)
                    differing = watch.differing(run)
                    return differing if isinstance(differing, str) else judged(differing, [(frame - 3, range(WIDTH))], EXACT)
            finally:
                waiting.terminate()


def children_of(parent):
    found = []
    for path in glob.glob("/proc/%d/task/*/children" % parent):
        try:
            with open(path, encoding="ascii") as file:
                found += map(int, file.read().split())
        except OSError:
            continue  # the thread has ended meanwhile
    return sorted(found)


@case
def wall_windows(context):
    """Nodes that show their tiles themselves: the returning node opens its window again, and leaves nothing behind."""
    watch = Watch(context, display="windows")
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        os.kill(first_nodes(run)[1], signal.SIGKILL)
        if not run.wait_for_line(BACK, 30):
            return "it did not rejoin: " + " | ".join(run.standard_error[-4:])
        watch.enough(run)
        wrong = watch.end(run)
        return "the wall was lost: " + " | ".join(printed(run, "windows")) if wrong is None and printed(run, "wall windows are lost") else wrong


@case
def in_turns(context):
    """Two nodes that draw alternate frames: while one is lost, its frames have no picture."""
    return kill_and_compare_ends(context, ("--dplex", "2"), "1x1", (1,))


@case
def all_that_take_turns(context):
    """All time-multiplexed nodes are lost: the period starts again."""
    nodes = 3 if length.LONG else 2
    return kill_and_compare_ends(context, ("--dplex", str(nodes)), "1x1", range(nodes))


@case
def turns_over_earlier_frames(context):
    """One node continues to draw all frames; the lost one rejoins as that one, or as another."""
    for victim in (0, 1):
        wrong = kill_and_compare_ends(context, ("--dplex", "2"), "1x1", (victim,), environment={"SCENE_KEEPS": "1"})
        if wrong is not None:
            return "node %d: %s" % (victim, wrong)
    return None


@case
def tiles_of_a_queue(context):
    """The other node takes the tiles at its next full clear, long before the rejoin."""
    return kill_and_compare(context, tiles="queue 32x32", missing_columns=range(WIDTH), victims=(1, 0) if length.LONG else (1,), maximum=24)


@case
def areas_that_are_balanced(context):
    """The other node takes the whole picture at its next full clear."""
    return (kill_and_compare(context, tiles="balance auto", missing_columns=range(WIDTH), victims=(1, 0) if length.LONG else (1,), maximum=24) or
            kill_and_compare(context, tiles="balance load", missing_columns=range(WIDTH), victims=(0, 1) if length.LONG else (0,), maximum=24))


@case
def areas_of_ranges(context):
    """The nodes of an area composite their ranges. All of them leave the area when one is lost."""
    return kill_and_compare(context, tiles="config db-of-areas.eqc", missing_columns=range(WIDTH), victims=(3, 0) if length.LONG else (3,), maximum=24)


@case
def areas_of_moving_ranges(context):
    """Areas and ranges move. The other node of the area takes the range; without the collector the area is left."""
    for victims in (((1,), (0,)) if length.LONG else ((1,),)):
        wrong = kill_and_compare_ends(context, ("--db", "2", "--local-nodes", "4", "--balance", "load"), "2x1", victims)
        if wrong is not None:
            return "nodes %s: %s" % (victims, wrong)
    return None


@cases.long_case
def areas_at_random(context):
    """Areas that change with every frame: a returning node must have the current frame's."""
    return kill_and_compare(context, tiles="queue 16x16", missing_columns=range(WIDTH), victims=(1, 0, 1), environment={"MURAL_PLANT": "areas"})


@cases.long_case
def areas_of_frames_over_earlier_frames(context):
    """Windows that are never cleared keep their areas: the returning node draws everything from the start, and then has
    the same."""
    return kill_and_compare(context, tiles="queue 16x16", missing_columns=range(WIDTH), environment={"MURAL_PLANT": "areas", "SCENE_KEEPS": "1"})


@case
def areas_unknown(context):
    """All nodes are lost at once: areas start again."""
    return kill_and_compare_ends(context, (), "queue 32x32", (0, 1))


@case
def two_eyes(context):
    return kill_and_compare_ends(context, ("--stereo", "side-by-side"), "1x1", (1,), against=("--stereo", "side-by-side", "--restart-nodes", "0"))


STRATEGIES = ("serial", "direct-send", "binary-swap", "2-3-swap", "radix-k", "streaming")
UNDER_WAY = 12  # frames in progress when a node is lost or rejoins, which may contain only the others' parts
LONGEST_MS = 8000  # time of one frame; timeouts are 20 s and more


def ranges_come_back(context, rounds, nodes, options, tiles="1x1", environment=None, where="local", frames=MAX_FRAMES, beside=False):
    """Nodes that divide draws. rounds: the nodes that are killed at once, each round after the rejoin of the previous
    round's nodes. Each frame that all of them divide is exact, from a few frames after each rejoin on. No process
    waits for a timeout. Frames have no picture while the collector is lost."""
    watch = Watch(context, frames, options, dict(environment or {}, SCENE_SHARES="1"), tiles, beside=beside)
    whole = []  # spans of frames that must be exact: first, end
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        run.first_nodes = nodes_of(run, nodes)
        begin = 0
        for done, victims in enumerate(rounds):
            pids = [node_pid(run, number, where) for number in victims]
            whole.append((begin, latest_frame(run) - UNDER_WAY))
            for pid in pids:
                os.kill(pid, signal.SIGKILL)
            for _ in pids:
                if not run.wait_for_line(BACK, 40):
                    return "%s did not rejoin: %s" % (victims, " | ".join(run.standard_error[-8:]))
            begin = latest_frame(run) + UNDER_WAY
            while done + 1 < len(rounds) and latest_frame(run) < begin + 2 * UNDER_WAY and run.process.poll() is None:
                time.sleep(0.01)
        watch.enough(run)
        wrong = watch.end(run)
        if wrong is not None:
            return wrong
        frames = watch.drawn
        whole.append((begin, frames))
        longest = max(frame_times(run)[START:])
        report = watch.report()["nodes"]
        saved = saved_pictures(watch.out)
        native = {tuple(picture.rows): frame for frame, picture in enumerate(watch.native())}
        if len(native) != frames:
            return "%d different native pictures of %d" % (len(native), frames)
        shown = [native.get(tuple(picture.rows)) for picture in saved]
        exact = {frame for frame in shown if frame is not None}
        print("    %s, %s: back after %s s; longest frame %.0f ms; of %d frames %d have pictures, %d differ" % (
            " ".join(options), rounds, ", ".join("%.2f" % node["secondsToRejoin"] for node in report if node["joins"]), longest, frames, len(saved), shown.count(None)))
        missing = [frame for first, end in whole for frame in range(first, end) if frame not in exact]
        if missing:
            return "frames %s are not exact; they should be from %s" % (missing[:8], whole)
        if longest > LONGEST_MS:
            return "a frame took %.1f s" % (longest / 1000)
        # The returns prove that processes were killed. Pictures need not lack anything: other nodes take the chunks of a
        # node that is killed between two frames.
        joins, wanted = sum(node["joins"] for node in report), sum(map(len, rounds))
        if joins != wanted:
            return "%d returns instead of %d: %s" % (joins, wanted, " | ".join(run.standard_error[-6:]))
        return not_shared(report, "serial" in options, rounds[-1])


def not_shared(report, serial, last):
    """Checks that after the last rejoin all nodes send parts. The collector also sends its messages about each picture,
    except with `serial`."""
    for node in report:
        if node["node"] in last and node["exchangeBytes"] == 0 and not (serial and node["node"] == 0):
            return "node %d shared nothing when it was back" % node["node"]
    return None


def by_ranges(strategy, ranks):
    return ("--db", str(ranks), "--composition", strategy)


def ranges_case(strategy, other):
    rounds = ((2,), (1,), (0,)) if length.LONG else ((other,), (0,))  # 0: the collector

    def check(context):
        return ranges_come_back(context, rounds, 3, by_ranges(strategy, 3))
    check.__name__ = "ranges_" + strategy.replace("-", "_")
    check.__doc__ = "Sort-last nodes rejoin, the collector and others, with " + strategy
    return case(check)


for index, name in enumerate(STRATEGIES):
    ranges_case(name, 2 - index % 2)


@case
def ranges_several_at_once(context):
    """Two of four including the collector, then all but the collector, then all: nodes that rejoin later connect to
    earlier ones."""
    return (ranges_come_back(context, ((0, 2), (1, 2, 3)), 4, by_ranges("direct-send", 4)) or
            ranges_come_back(context, ((1, 2), (0, 1, 2)) if length.LONG else ((0, 1, 2),), 3, by_ranges("serial", 3)))


@case
def ranges_of_tiles(context):
    """Two pictures of two nodes each: a loss in one does not affect the other."""
    return ranges_come_back(context, ((3,), (2,), (1, 2)) if length.LONG else ((3,), (1, 2)), 4, by_ranges("binary-swap", 2) + ("--local-nodes", "4"), tiles="2x1")


@cases.long_case
def ranges_in_turns(context):
    """Two time-multiplexed pictures, of two nodes each."""
    return ranges_come_back(context, ((1,), (2,), (0,)), 4, by_ranges("streaming", 2) + ("--dplex", "2"))


@cases.long_case
def ranges_with_delta(context):
    return ranges_come_back(context, ((1,), (0,)), 2, by_ranges("direct-send", 2) + ("--delta", "on"))


@cases.long_case
def ranges_by_tcp(context):
    return ranges_come_back(context, ((1,), (0,)), 3, by_ranges("radix-k", 3) + ("--nodes", "localhost,localhost,localhost", "--stream", "tcp"), where="localhost")


@cases.long_case
def ranges_by_multicast(context):
    return ranges_come_back(context, ((2,), (0,)), 3, by_ranges("streaming", 3) + (
        "--nodes", "localhost,localhost,localhost", "--stream", "rsp://239.255.77.9:4299?interface=127.0.0.1"), where="localhost")


@case
def ranges_of_two_programs(context):
    """Pictures of two programs' windows are combined one after the other, in the order in which their packets arrive."""
    return ranges_come_back(context, ((1,), (0,)) if length.LONG else ((0,),), 3, by_ranges("2-3-swap", 3), beside=True)


@case
def ranges_that_are_busy(context):
    """Without pauses: all processes wait for the nodes."""
    return ranges_come_back(context, ((1,), (0,)) if length.LONG else ((0,),), 2, by_ranges("streaming", 2), environment={"SCENE_PAUSE_US": "0"}, frames=5 * MAX_FRAMES)


@case
def chunks_come_back(context):
    """Nodes that take draws from a queue, and nodes that receive random ones, which change with each frame."""
    options = by_ranges("direct-send", 3) + ("--chunk-queue", "60")
    return (ranges_come_back(context, ((1,), (0,)), 3, options) or
            ranges_come_back(context, ((2,), (1, 2)) if length.LONG else ((1, 2),), 3, options, environment={"MURAL_PLANT": "shares"}))


@case
def chunks_that_are_balanced(context):
    """Ranges that equalizers move."""
    return ranges_come_back(context, ((1,), (0, 2)) if length.LONG else ((0, 2),), 3, by_ranges("direct-send", 3) + ("--balance", "auto"))


@case
def chunks_of_a_lost_node(context):
    """A node that does not rejoin: the others take its chunks, and from then on nothing is missing."""
    watch = Watch(context, MAX_FRAMES, by_ranges("binary-swap", 3) + ("--chunk-queue", "60", "--restart-nodes", "0"), {"SCENE_SHARES": "1"}, tiles="1x1")
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        os.kill(node_pid(run, 1), signal.SIGKILL)
        if not run.wait_for_line("other nodes take its draws", 20):
            return "no message about its chunks: " + " | ".join(run.standard_error[-4:])
        begin = latest_frame(run) + UNDER_WAY
        watch.enough(run, UNDER_WAY + TAIL)
        wrong = watch.end(run)
        if wrong is not None:
            return wrong
        behind = [columns_that_differ(a, b) for a, b in zip(watch.native(), saved_pictures(watch.out))][begin:]
        if len(behind) < TAIL:
            return "only %d frames were left" % len(behind)
        return "%d of %d pictures after its loss differ" % (sum(map(bool, behind)), len(behind)) if any(behind) else None


@case
def ranges_over_earlier_frames(context):
    """Without clears nothing is divided: the collector has everything, and receives everything again."""
    watch = Watch(context, MAX_FRAMES, by_ranges("serial", 2), {"SCENE_SHARES": "1", "SCENE_KEEPS": "1"}, tiles="1x1")
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        os.kill(first_nodes(run)[0], signal.SIGKILL)
        if not run.wait_for_line(BACK, 30):
            return "it did not rejoin: " + " | ".join(run.standard_error[-6:])
        watch.enough(run, UNDER_WAY + TAIL)
        wrong = watch.end(run)
        if wrong is not None:
            return wrong
        behind = [columns_that_differ(a, b) for a, b in zip(watch.native()[-TAIL:], saved_pictures(watch.out, TAIL))]
        return "%d of the last pictures differ" % sum(map(bool, behind)) if any(behind) else None


@case
def frames_over_earlier_frames(context):
    """Without clears, skipped draws would be missing. The node detects it before a picture is shown, and draws
    everything."""
    return kill_and_compare(context, environment={"SCENE_KEEPS": "1"})


@case
def nodes_that_are_busy(context):
    """Without pauses: all processes wait for the nodes, and the returning node is no faster."""
    return kill_and_compare(context, frames=5 * MAX_FRAMES, environment={"SCENE_PAUSE_US": "0"}, at=60, every=25)


@case
def killed_while_it_catches_up(context):
    """Killed twice during its resync: tried again, and finally back."""
    watch = Watch(context)
    half = WIDTH // 2
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        known = set(first_nodes(run))
        frame = latest_frame(run)
        os.kill(first_nodes(run)[1], signal.SIGKILL)
        for delay in (0.0, 0.05):
            fresh = fresh_node(run, known)
            if not fresh:
                return "it was not started again"
            known.add(fresh)
            time.sleep(delay)
            os.kill(fresh, signal.SIGKILL)
        if not rejoins_after(run, losses=3):
            return "it did not rejoin: " + " | ".join(run.standard_error[-4:])
        watch.enough(run)
        differing = watch.differing(run)
        if isinstance(differing, str):
            return differing
        tried = len(printed(run, "did not rejoin:")) + len(printed(run, "was lost:")) - 1
        if tried != 2:
            return "%d failed attempts were reported instead of 2: %s" % (tried, " | ".join(run.standard_error[-6:]))
        return judged(differing, [(frame - 3, range(half, WIDTH))], EXACT)


def rejoins_after(run, losses, seconds=30):
    """Waits for a rejoin after this many reported losses. On a fast machine the node may also be back before a kill."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        changes = [line for line in run.standard_error if any(text in line for text in (BACK, "did not rejoin:", "was lost:"))]
        if sum(BACK not in line for line in changes) >= losses and BACK in changes[-1]:
            return True
        time.sleep(0.02)
    return False


def fresh_node(run, known, seconds=15):
    """Returns the pid of a new node. It reads only the run's own processes, because a search of all takes the CPU time of
    the session."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        waiting = [run.process.pid]
        while waiting:
            pid = waiting.pop()
            if re.search(cases.NODE, command_of(pid)):
                return pid
            waiting += [child for child in children_of(pid) if child not in known]
        time.sleep(0.005)
    return None


def command_of(pid):
    try:
        with open("/proc/%d/cmdline" % pid, "rb") as file:
            return file.read().replace(b"\0", b" ").decode(errors="replace")
    except OSError:
        return ""  # has ended meanwhile


def kill_and_compare_ends(context, options, tiles, victims, against=None, environment=None):
    """Compares the first and the last frames. Frames that no node lived to show have no picture, and only frames of the
    time without the nodes may be missing."""
    watch = Watch(context, MAX_FRAMES, options, environment, tiles)
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        frame = latest_frame(run)
        pids = first_nodes(run)
        for number in victims:
            os.kill(pids[number], signal.SIGKILL)
        for _ in victims:
            if not run.wait_for_line(BACK, 30):
                return "they did not rejoin: " + " | ".join(run.standard_error[-6:])
        back = latest_frame(run)
        watch.enough(run, 2 * UNDER_WAY + TAIL)
        wrong = watch.end(run)
        if wrong is not None:
            return wrong
        saved = saved_pictures(watch.out)
        native = watch.native() if against is None else undisturbed(context, watch, against)
        if len(native) != watch.drawn:
            return "%d pictures of %d frames of an undisturbed run" % (len(native), watch.drawn)
        away = back - frame + 2 * UNDER_WAY
        if len(saved) < watch.drawn - away or len(saved) > watch.drawn:
            return "%d pictures of %d frames, of which %d can lack one" % (len(saved), watch.drawn, away)
        before = [columns_that_differ(a, b) for a, b in zip(native[:frame - 3], saved)]
        behind = [columns_that_differ(a, b) for a, b in zip(native[-TAIL:], saved[-TAIL:])]
        if any(before) or any(behind):
            return "pictures differ: %d before, %d after" % (sum(map(bool, before)), sum(map(bool, behind)))
        return None


def undisturbed(context, watch, options):
    """Returns the pictures of a run of the same kind without losses."""
    other = Watch(context, watch.drawn, options, {"SCENE_PAUSE_US": "0"}, watch.tiles)
    with other.start() as run:
        run.status()
        return saved_pictures(other.out)


@case
def all_nodes_at_once(context):
    """The program waits for the nodes; the frames after their rejoin are exact."""
    return kill_and_compare_ends(context, (), "2x1", (0, 1))


@case
def dies_again_and_again(context):
    """Rejoins are tried as often as configured, then one line reports that the node stays lost."""
    watch = Watch(context, options=("--restart-nodes", "2"))
    half = WIDTH // 2
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        known = set(first_nodes(run))
        frame = latest_frame(run)
        os.kill(first_nodes(run)[1], signal.SIGKILL)
        for _ in range(2):
            fresh = fresh_node(run, known)
            if not fresh:
                return "it was not started again"
            known.add(fresh)
            os.kill(fresh, signal.SIGKILL)
        if fresh_node(run, known, 4):
            return "it was started a third time"
        watch.enough(run)
        differing = watch.differing(run)
        if isinstance(differing, str):
            return differing
        if len(printed(run, "its tiles keep their last picture")) != 2:  # until the rejoin, after 2 tries
            return "no message that it stays lost: " + " | ".join(run.standard_error[-6:])
        return judged(differing, [(frame - 3, range(half, WIDTH))], -1)


def lost_for_good(context, options, words):
    """Checks that the node stays lost; one line about the loss contains the words."""
    watch = Watch(context, options=options)
    half = WIDTH // 2
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        known = set(first_nodes(run))
        frame = latest_frame(run)
        os.kill(first_nodes(run)[1], signal.SIGKILL)
        if fresh_node(run, known, 1):
            return "it was started again"
        watch.enough(run)
        differing = watch.differing(run)
        if isinstance(differing, str):
            return differing
        if len(printed(run, words)) != 1:
            return "no message: " + " | ".join(run.standard_error[-3:])
        return judged(differing, [(frame - 3, range(half, WIDTH))], -1)


@case
def never(context):
    """--restart-nodes 0."""
    return lost_for_good(context, ("--restart-nodes", "0"), "was lost: ")


@case
def more_than_the_limit(context):
    """A program that has sent more than --cache-size: the line about the loss says so, and no rejoin is tried."""
    return lost_for_good(context, ("--cache-size", "4MiB"), "a larger --cache-size")


LATE_HOST = "#!/bin/sh\n# HOST COMMAND...\nhost=$1; shift\n%s\nexec \"$@\"\n"


def late_node(context, how, words):
    """The second node is not present at the start of the session, but joins later; the first starts without it."""
    with tempfile.TemporaryDirectory(prefix="mural-rejoin-late.") as folder:
        script, tried = os.path.join(folder, "launch"), os.path.join(folder, "tried")
        with open(script, "w", encoding="ascii") as file:
            file.write(LATE_HOST % ("if [ $host = 127.0.0.3 ] && ! [ -e %s ]; then : >%s; %s; fi" % (tried, tried, how)))
        os.chmod(script, 0o755)
        watch = Watch(context, options=("--nodes", "127.0.0.2,127.0.0.3", "--launch", script, "--stream", "tcp", "--min-nodes", "1"))
        with watch.start() as run:
            if not run.wait_for_line("frame 5 "):
                return "the program did not start: " + " | ".join(run.standard_error[-3:])
            if len(printed(run, words)) != 1:
                return "no message about the missing node: " + " | ".join(run.standard_error[-4:])
            if not run.wait_for_line(" joined ", 30):
                return "it did not join: " + " | ".join(run.standard_error[-4:])
            print("    " + printed(run, " joined ")[0])
            watch.enough(run)
            differing = watch.differing(run)
            if isinstance(differing, str):
                return differing
            if not differing[0]:
                return "the first picture was complete although a node was missing"
            return judged(differing, [(0, range(WIDTH // 2, WIDTH))], EXACT)


@case
def late_node_that_failed(context):
    return late_node(context, "exit 3", "is not connected yet: it did not start: exit status 3")


@case
def late_node_that_is_slow(context):
    return late_node(context, "sleep 600", "is not connected yet: it did not connect within 5 s after the others")


@case
def late_nodes_too_many(context):
    """Fewer nodes came than are required: one line, and no program."""
    watch = Watch(context, 10, ("--nodes", "127.0.0.2,127.0.0.3", "--launch", "false", "--min-nodes", "1"))
    with watch.start() as run:
        return cases.check_end(run, 2) or (None if len(printed(run, "fewer than --min-nodes 1 are left")) == 1 else "no message: " + " | ".join(run.standard_error[-3:]))


@case
def planted_fault_is_seen(context):
    """One packet of a node's snapshot is lost: the pictures must reveal it."""
    wrong = kill_and_compare(context, environment={"MURAL_PLANT": "rejoin"})
    return None if wrong is not None and "still differs" in wrong else "it was not detected: %s" % wrong


@case
def large_textures(context):
    """Large textures: the duration of the rejoin, and the time of the other node's frames meanwhile."""
    watch = Watch(context, environment={"SCENE_MIB": "256" if length.LONG else "96"})
    half = WIDTH // 2
    with watch.start() as run:
        if not run.wait_for_line("frame %d " % START, 120):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        frame = latest_frame(run)
        os.kill(first_nodes(run)[1], signal.SIGKILL)
        if not run.wait_for_line(BACK, 60):
            return "it did not rejoin: " + " | ".join(run.standard_error[-4:])
        back = latest_frame(run)
        line = printed(run, BACK)[0]
        print("    " + line)
        watch.enough(run)
        differing = watch.differing(run)
        if isinstance(differing, str):
            return differing
        times = frame_times(run)
        for name, part in (("before", times[START // 2:frame - 3]), ("meanwhile", times[frame - 3:back + 3]), ("behind", times[back + 3:])):
            part = sorted(part)
            print("    frames %s: %d, median %.1f ms, 95 %% %.1f ms, longest %.1f ms" % (name, len(part), part[len(part) // 2], part[len(part) * 95 // 100], part[-1]))
        return judged(differing, [(frame - 3, range(half, WIDTH))], EXACT)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
