#!/usr/bin/env python3
"""Programs with the native API: every division of the work shows the picture of a single node, nodes come back, and
faults of programs are reported.

  native_programs.py --build build/release [--cases restarted_nodes,faults] [--list]
"""

import json
import os
import signal
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
from harness import cases, length, pictures  # noqa: E402

FRAMES = 6
SIZE, ROOM_SIZE = "160x120", "320x240"
# Decompositions that show exactly the pixels of one node.
EXACT = ["--tiles 2x2", "--tiles 3x1 --local-nodes 3", "--db 2", "--db 3", "--tiles 2x1 --db 2", "--dplex 2",
         "--tile-queue 64x64 --local-nodes 3", "--db 2 --chunk-queue 8", "--balance auto --tiles 2x1",
         "--tiles 2x1 --delta on", "--db 4 --composition binary-swap", "--db 4 --composition direct-send"]
NODE = r"--mural-node\b"


def program(context):
    return os.path.join(context.build, "tests", "native", "native_scene")


def draw(context, options, frames=FRAMES, fault="", environment=None, wanted=0, during=None, words=(), last=0, out=None, size=SIZE):
    """Returns (error or None, pictures, lines of standard error and output). last: number of pictures to read, from the end;
    0: all. out: an existing folder that keeps the pictures."""
    with tempfile.TemporaryDirectory(prefix="mural-native.") as folder:
        out = out or os.path.join(folder, "out")
        command = [program(context), "--frames", str(frames)] + (["--fault", fault] if fault else []) + list(words)
        path = os.path.dirname(context.mural) + ":" + os.environ.get("PATH", "/usr/bin:/bin")
        more = options.split() + ["--display", "none", "--size", size, "--out", out]
        with context.run(command, more, dict({"PATH": path}, **(environment or {}))) as run:
            wrong = during(run, out) if during else None
            wrong = wrong or cases.check_end(run, wanted)
            shown = [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))[-last:]] if os.path.isdir(out) else []
            return wrong, shown, list(run.standard_error) + list(run.standard_output)


LONGEST = 300  # frames of the run of one node with which cases compare
SINGLE = {}  # folders with the pictures of one node, by number of frames


def single(context, frames=FRAMES, last=0):
    """Returns the pictures of one node; `last` as for draw(). A picture depends on its number only, so one long run serves
    several cases."""
    drawn = frames if frames == FRAMES else max(frames, LONGEST)
    if drawn not in SINGLE:
        SINGLE[drawn] = folder = tempfile.TemporaryDirectory(prefix="mural-native.")
        wrong, _, lines = draw(context, "--tiles 1x1", drawn, last=1, out=folder.name)
        if wrong or len(os.listdir(folder.name)) != drawn:
            raise SystemExit("one node fails: %s, %d pictures; %s" % (wrong, len(os.listdir(folder.name)), " | ".join(lines[-3:])))
    names = sorted(os.listdir(SINGLE[drawn].name))[frames - (last or frames):frames]
    return [pictures.read_png(os.path.join(SINGLE[drawn].name, name)) for name in names]


PASSES = {}  # result of draw() with one node per pass, by options


def undivided(context, passes):
    if passes not in PASSES:
        PASSES[passes] = draw(context, passes)
    return PASSES[passes]


# Pixels of a picture in which triangles have equal depths. Items of a queue have no order, so either may win.
TIES = 3


def differing(wanted, shown, allowed=0):
    """Compares all pictures. `allowed`: pixels per picture that may differ. Returns an error or None."""
    if len(wanted) != len(shown):
        return "%d pictures instead of %d" % (len(shown), len(wanted))
    difference = pictures.Difference()
    for number, (a, b) in enumerate(zip(wanted, shown), 1):
        difference.add_pictures(a, b, "frame %d" % number)
    return None if difference.pixels <= allowed * len(wanted) else "%d pixels differ, %s" % (difference.pixels, difference.place)


@cases.case
def decompositions_are_exact(context):
    wanted = single(context)
    if len({tuple(bytes(row) for row in picture.rows) for picture in wanted}) != FRAMES:
        return "frames of one node repeat"
    for options in length.some(EXACT):
        wrong, shown, lines = draw(context, options)
        wrong = wrong or differing(wanted, shown)
        if wrong:
            return "%s: %s; %s" % (options, wrong, " | ".join(lines[-3:]))
    return None


@cases.case
def passes_show_something_else(context):
    """Two samples, two eyes and a kernel show something else than one node; otherwise a pass would be ignored."""
    wanted = single(context)
    for options in ("--subpixel 2", "--stereo anaglyph", "--pixel 2x1"):
        wrong, shown, _ = undivided(context, options)
        if wrong:
            return "%s: %s" % (options, wrong)
        quality = min(pictures.decibels(a, b) for a, b in zip(wanted, shown)) if len(shown) == FRAMES else 0
        if differing(wanted, shown) is None or quality < 8:
            return "%s: %d pictures, %.1f dB" % (options, len(shown), quality)
    return None


@cases.case
def passes_are_exact(context):
    """Stereo, samples and kernels show the same pixels however their nodes divide the work."""
    for passes, options in length.pairs(("--stereo anaglyph", "--subpixel 2", "--pixel 2x1"), ("--tiles 2x1", "--db 2")):
        wrong, wanted, lines = undivided(context, passes)
        if not wrong:
            wrong, shown, lines = draw(context, passes + " " + options)
            wrong = wrong or differing(wanted, shown)
        if wrong:
            return "%s %s: %s; %s" % (passes, options, wrong, " | ".join(lines[-3:]))
    return None


# Two nodes share the scene on the front wall of the room of configs/cave.eqc.
SHARED_WALL = """        compound { channel ( segment 0 ) }
        compound
        {
            channel ( segment 1 )
            buffer [ COLOR DEPTH ]
            compound { range [ 0 .5 ] }
            compound { channel "helper" range [ .5 1 ] outputframe { } }
            inputframe { name "frame.helper" }
        }
        compound { channel ( segment 2 ) }
"""
HELPER = """        node { host "cave4" pipe { window { viewport [ 0 0 320 240 ] attributes { hint_drawable FBO } channel { name "helper" } } } }
"""


@cases.case
def rooms_are_exact(context):
    """A CAVE file: each wall shows the scene behind it, and nodes that share a wall show the same pixels."""
    path = os.path.join(TOP, "configs", "cave.eqc")
    with open(path, encoding="ascii") as file:
        text = file.read()
    with tempfile.TemporaryDirectory(prefix="mural-native.") as folder:
        shared = os.path.join(folder, "shared.eqc")
        end = text.rindex("    }\n}")
        with open(shared, "w", encoding="ascii") as file:
            file.write(text[:end].replace("        observer { }", HELPER + "        observer { }") + SHARED_WALL + text[end:])
        shown = []
        for name in (path, shared):
            wrong, found, lines = draw(context, "--config %s --all-local" % name, words=["--work", "room"], size=ROOM_SIZE)
            if wrong or len(found) != FRAMES:
                return "%s: %s, %d pictures; %s" % (name, wrong, len(found), " | ".join(lines[-3:]))
            shown.append(found)
    wrong = differing(*shown)
    if wrong:
        return wrong
    rows = [bytes(row) for row in shown[0][0].rows]
    wall = len(rows[0]) // 3
    drawn = [sum(row[first * wall + k] != 0 for row in rows for k in range(0, wall, 4)) for first in range(3)]
    return None if min(drawn) > 1000 else "the walls show %s pixels" % drawn


@cases.case
def ignored_ranges_are_found(context):
    """The planted fault of this test: a renderer that draws everything has the right picture, and one that draws the
    wrong range has not."""
    wanted = single(context)
    wrong, shown, _ = draw(context, "--db 2", fault="range")
    return wrong or differing(wanted, shown)


@cases.case
def restarted_nodes_are_exact(context):
    # A node with a tile also restarts in processes_of_a_machine_share_blobs.
    for options in length.some(("--db 2", "--tiles 2x1")):
        # On a busy machine the node may return after the last frames of a short run.
        wrong = pictures_after_the_return(context, options, 200) and pictures_after_the_return(context, options, 1000)
        if wrong:
            return "%s: %s" % (options, wrong)
    return None


def pictures_after_the_return(context, options, frames):
    """Kills a node, and compares the last 20 pictures."""
    wanted = single(context, frames, last=20)
    wrong, shown, lines = draw(context, options, frames, during=kill_one(2), last=20)
    if wrong:
        return wrong
    if not any("is back" in line or "rejoin" in line for line in lines):
        return "no line about the node: " + " | ".join(lines[-4:])
    wrong = differing(wanted, shown)
    return wrong and "after the return, " + wrong


@cases.case
def queues_give_each_item_to_one_node(context):
    """Nodes draw what they take from a queue; together it is the whole scene, once."""
    wanted = single(context)
    for options in length.some(("--db 3", "--tiles 1x1", "--db 2 --delta on", "--db 2")):
        wrong, shown, lines = draw(context, options, words=["--work", "queue"])
        wrong = wrong or differing(wanted, shown, TIES)
        if wrong or any("thrown" in line for line in lines):
            return "%s: %s; %s" % (options, wrong, " | ".join(lines[-3:]))
    return None


def kill_one(count):
    """Returns a function that kills the last of `count` nodes after some pictures."""
    def during(run, out):
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline and (not os.path.isdir(out) or len(os.listdir(out)) < 10):
            time.sleep(0.01)
        nodes = run.processes(NODE)
        if len(nodes) != count:
            return "%d nodes" % len(nodes)
        os.kill(nodes[-1], signal.SIGKILL)
        return None
    return during


@cases.case
def queues_pass_on_the_items_of_lost_nodes(context):
    frames = 150
    wanted = single(context, frames)
    wrong, shown, lines = draw(context, "--db 3", frames, during=kill_one(3), words=["--work", "queue"])
    wrong = wrong or differing(wanted[-20:], shown[-20:], TIES)
    if wrong or any("within the deadline" in line for line in lines):
        return "%s; %s" % (wrong, " | ".join(lines[-4:]))
    # Without the lost node, too, the others draw everything.
    missing = [n for n, (a, b) in enumerate(zip(wanted, shown)) if differing([a], [b], TIES)]
    return None if len(missing) <= 6 else "%d pictures lack items: %s" % (len(missing), missing)


@cases.case
def barriers_release_nodes_and_application_together(context):
    frames = LONGEST  # time for the return of the node, also on a busy machine
    wrong, shown, lines = draw(context, "--db 3", frames, during=kill_one(3), words=["--work", "barrier"], last=20)
    entered = [int(line.split()[-1]) for line in lines if line.startswith("entered ")]
    wrong = wrong or differing(single(context, frames, last=20), shown)
    if wrong or any("within the deadline" in line for line in lines):
        return "%s; %s" % (wrong, " | ".join(lines[-4:]))
    if len(entered) != frames or entered[:5] != [4] * 5 or entered[-1] != 4 or min(entered) != 3:
        return "%d rounds with %s members" % (len(entered), sorted(set(entered)))
    return None


@cases.case
def nodes_receive_the_objects_that_they_ask_for(context):
    """Each of several nodes draws an equal part of 24 objects of 300 KB, and receives that part of the bytes; also beside a
    stream by multicast, and between batches of delta coding."""
    whole = 24 * 300000
    far = " --nodes localhost,localhost --stream "
    for options, nodes in (("--db 4", 4), ("--db 2 --delta on", 2), ("--db 2" + far + "tcp", 2),
                           ("--db 2" + far + "rsp://239.255.77.13:4379?interface=127.0.0.1", 2)):
        with tempfile.TemporaryDirectory(prefix="mural-native.") as folder:
            report = os.path.join(folder, "report.json")
            wrong, shown, lines = draw(context, options + " --report " + report, words=["--chunk-bytes", "300000"],
                                       environment={"MURAL_PLANT": "places"})
            wrong = wrong or differing(single(context), shown)
            if wrong:
                return "%s: %s; %s" % (options, wrong, " | ".join(lines[-3:]))
            with open(report, encoding="utf-8") as file:
                received = [node["receivedBytes"] for node in json.load(file)["nodes"]]
        print("%s: bytes received per node %s of %d" % (options, received, whole))
        if len(received) != nodes or not all(.7 * whole < count * nodes < 1.1 * whole for count in received):
            return "%s: the nodes receive %s bytes of %d" % (options, received, whole)
    return None


def blobs_of(pid):
    """Returns {inode: size in bytes} of the blobs that a process maps."""
    found = {}
    with open("/proc/%d/maps" % pid, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if len(words) > 5 and words[5].startswith("/memfd:mural-blob"):
                first, end = (int(word, 16) for word in words[0].split("-"))
                found[int(words[4])] = end - first
    return found


@cases.case
def processes_of_a_machine_share_blobs(context):
    """All nodes of this machine map the memory of the application's blobs, also a restarted one."""
    def during(run, out):
        wrong = kill_one(2)(run, out)
        deadline = time.monotonic() + 30
        while not wrong and time.monotonic() < deadline:
            mapped = [blobs_of(pid) for pid in run.processes(NODE)]
            if len(mapped) == 2 and len(mapped[0]) >= 24 and mapped[0] == mapped[1]:
                return None
            time.sleep(0.02)
        return wrong or "the nodes map %s blobs" % [len(blobs) for blobs in mapped]
    wrong, shown, lines = draw(context, "--tiles 2x1", 300, during=during, words=["--chunk-bytes", "300000"], last=20)
    return wrong or differing(single(context, 300, last=20), shown)


@cases.case
def sessions_end_while_nodes_wait_for_objects(context):
    """--frames ends the program, whose objects the nodes then no longer receive."""
    for frames in length.some(range(1, 6)):
        began = time.monotonic()
        wrong, _, lines = draw(context, "--db 2 --frames %d" % frames, frames=0)
        if wrong or any("lost" in line or "thrown" in line for line in lines) or time.monotonic() - began > 8:
            return "%s after %.1f s; %s" % (wrong, time.monotonic() - began, " | ".join(lines))
    return None


@cases.case
def faults_of_programs_are_reported(context):
    for fault, words in (("throw", "Renderer::draw has thrown: thrown on purpose"), ("gl", "Renderer::draw leaves the GL error 0x0500"),
                         ("layout", "Scene")):
        wrong, shown, lines = draw(context, "--tiles 2x1", fault=fault)
        if wrong:
            return "%s: %s" % (fault, wrong)
        if len(shown) != FRAMES or not any(words in line for line in lines):
            return "%s: %d pictures, %s" % (fault, len(shown), " | ".join(lines))
    wrong, _, lines = draw(context, "--tiles 2x1", environment={"NATIVE_SCENE_START": "1"}, wanted=2)
    if wrong or not any("the renderer fails on purpose" in line for line in lines):
        return "start: %s; %s" % (wrong, " | ".join(lines))
    return None


@cases.case
def excluded_options_are_refused(context):
    for options, words in (("--verify", "--verify"), ("--record f.mural", "--record"), ("--gl osmesa", "osmesa"),
                           ("--nodes @wall --secret key", "waiting nodes")):
        with context.run([program(context)], options.split()) as run:
            status = run.status()
            if status != 2 or not any(words in line for line in run.standard_error):
                return "%s: status %s, %s" % (options, status, " | ".join(run.standard_error))
    with context.run([context.program("immediate"), "--frames", "2"], ["--node-program", program(context), "--display", "none"]) as run:
        if run.status() is None or not any("used no native API" in line for line in run.standard_error + run.standard_output):
            return "a captured program in a session of native nodes: %s" % " | ".join(run.standard_error)
    return None


@cases.case
def scripts_start_native_programs(context):
    wanted = single(context)
    with tempfile.TemporaryDirectory(prefix="mural-native.") as folder:
        script = os.path.join(folder, "start.sh")
        with open(script, "w", encoding="ascii") as file:
            file.write("#!/bin/sh\nexec \"$@\"\n")
        os.chmod(script, 0o755)
        out = os.path.join(folder, "out")
        options = ["--node-program", program(context), "--tiles", "2x1", "--display", "none", "--size", SIZE, "--out", out]
        with context.run([script, program(context), "--frames", str(FRAMES)], options) as run:
            wrong = cases.check_end(run, 0)
            if wrong:
                return wrong
        return differing(wanted, [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))])


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
