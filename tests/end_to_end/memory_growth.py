#!/usr/bin/env python3
"""No process grows while a program creates and deletes objects of every kind in each frame: neither the program, nor
the head, nor a render node, beyond the program's native growth. A planted leak of textures in a node
(MURAL_PLANT=leak) must be detected. Large objects use the same memory natively and on a node, apart from the node's
own memory. In the program they use no more than natively. tools/bench/memory shows the same over more frames.

  memory_growth.py --build build/release
"""

import argparse
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(os.path.dirname(HERE)), "tools", "bench"))

from harness import display  # noqa: E402
from harness import length  # noqa: E402
from harness import programs  # noqa: E402
from benchlib import memory_watch  # noqa: E402
from benchlib.memory_watch import MemoryWatch  # noqa: E402

MARKS = (150, 1650) if length.LONG else (150, 1250)
LEAK_MARKS = (150, 550) if length.LONG else (150, 350)  # frames between which a leak becomes visible: 64 KiB each
MAX_GROWTH_MIB = 4.0  # heaps settle; in 1100 frames textures that leak make 70, a context in every fourth 5.5
LOOK_SECONDS = 0.05  # a look costs the head and this script more than a frame of so small a window costs a node
WEIGHT_MARKS = (4, 12)
MIN_WEIGHT_MIB = 200.0  # for large_objects natively; otherwise the comparison means nothing
MAX_NODE_SHARE = 1.3  # relative to the native run


def growth(seen, role, marks=MARKS):
    private = [max(memory["Private"] for memory in seen[mark][role]) for mark in marks]
    return private[1] - private[0]


def weight(seen, role):
    return max(memory["Private"] for memory in seen[WEIGHT_MARKS[-1]][role])


def heavy_objects(mural, environment, program, wall):
    """Returns the number of failed comparisons. The ring is shared memory and not included."""
    native = weight(MemoryWatch(mural, environment).run(["--native"], program, WEIGHT_MARKS), "app")
    seen = MemoryWatch(mural, environment).run(wall, program, WEIGHT_MARKS)
    app, node = weight(seen, "app"), weight(seen, "node")
    results = (("large objects natively: %.0f MiB" % native, native >= MIN_WEIGHT_MIB),
               ("the program: %.0f MiB, %.2f x" % (app, app / native), app <= native + MAX_GROWTH_MIB),
               ("a node: %.0f MiB, %.2f x" % (node, node / native), node <= MAX_NODE_SHARE * native))
    for text, right in results:
        print("%s: %s" % (text, "right" if right else "WRONG"))
    return sum(not right for _, right in results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--mural")
    arguments = parser.parse_args()
    build = os.path.abspath(arguments.build)
    mural = arguments.mural or os.path.join(build, "bin", "mural")
    program = [os.path.join(build, "tests", "programs", "object_churn"), "--frames", "100000", "--size", "96x96"]
    # Without the rejoin log, which grows with lists that call lists, up to --cache-size, and is not tested here.
    wall = ["--tiles", "2x1", "--display", "none", "--restart-nodes", "0"]
    one_node = wall if length.LONG else ["--tiles", "1x1"] + wall[2:]
    wrong = 0
    with display.PrivateDisplay() as name:
        environment = programs.clean_environment(name)
        often, memory_watch.LOOK_SECONDS = memory_watch.LOOK_SECONDS, LOOK_SECONDS
        native = max(0.0, growth(MemoryWatch(mural, environment).run(["--native"], program, MARKS), "app"))
        print("native: the program grows by %.1f MiB from frame %d to %d" % (native, *MARKS))
        sound = MemoryWatch(mural, environment).run(wall, program, MARKS)
        for role in ("app", "head", "node"):
            grown = growth(sound, role)
            right = grown <= native + MAX_GROWTH_MIB
            wrong += not right
            print("%-5s grows by %.1f MiB: %s" % (role, grown, "right" if right else "WRONG"))
        leaky = growth(MemoryWatch(mural, {**environment, "MURAL_PLANT": "leak"}).run(one_node, program, LEAK_MARKS), "node", LEAK_MARKS)
        right = leaky > growth(sound, "node") + MAX_GROWTH_MIB
        wrong += not right
        print("node that forgets textures grows by %.1f MiB: %s" % (leaky, "found" if right else "MISSED"))
        memory_watch.LOOK_SECONDS = often
        heavy = [os.path.join(build, "tests", "programs", "large_objects"), "--frames", "100000", "--size", "96x96"]
        wrong += heavy_objects(mural, environment, heavy, one_node)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
