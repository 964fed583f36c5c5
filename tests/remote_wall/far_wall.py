#!/usr/bin/env python3
"""A remote wall on another machine, behind a link of 1 Gbit/s and a round trip of 20 ms, with pictures of 1920x1080
pixels.

  far_wall.py --build build/release [--cases lossless,jpeg,cut,second_session] [--list]
"""

import filecmp
import os
import re
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(TOP, "tests", "end_to_end"), os.path.join(TOP, "tests", "remote_wall")]
from harness import cases, own_network, pictures, processes  # noqa: E402
from harness.slow_link import SlowLink  # noqa: E402
from shown_wall import Wall, secret  # noqa: E402

HERE, MUSEUM = "192.0.2.1", "192.0.2.2"
PORT = 4281
RELAY_PORT = 4282  # of this machine; leads to the museum
ONE_WAY_SECONDS = 0.01
SIZE = "1920x1080"
FRAMES = 12
MIN_DB = 45  # of jpeg-100
CUT_SECONDS = 4
network = None


def museum(context, folder, key, name="museum"):
    return Wall(context, folder, name, key, PORT, address=MUSEUM, at=("ip", "netns", "exec", "museum"))


def sending(context, folder, key, codec, frames=FRAMES, size=SIZE):
    """A session that also saves its pictures, into the folder `here`."""
    options = ["--tiles", "2x1", "--display", "none", "--secret", key, "--out", os.path.join(folder, "here"),
               "--send", "museum=%s:%d,codec=%s" % (HERE, RELAY_PORT, codec)]
    return context.run([context.program("long_scene"), "--frames", str(frames), "--size", size], options, {"MURAL_LOG": "output:trace"})


def own_picture(folder, number):
    return os.path.join(folder, "here", "frame-%06d.png" % number)


def report(run, wall, seconds):
    sent = [re.search(r"\b(\d+) tiles, (\d+) bytes", line) for line in list(run.standard_error)]
    sizes = [int(found.group(2)) for found in sent if found]
    print("  %d of %d frames shown, %.1f MB per frame, %.1f s in all" % (len(wall.numbers()), FRAMES, sum(sizes) / max(len(sizes), 1) / 1e6, seconds))


def shown(context, folder, codec):
    """Returns the wall after a whole session, or an error."""
    key = secret(folder, "key")
    with museum(context, folder, key) as wall:
        began = time.monotonic()
        with sending(context, folder, key, codec) as run:
            wrong = cases.check_end(run, 0, FRAMES)
        report(run, wall, time.monotonic() - began)
        if wrong is None and wall.numbers()[-1:] != [FRAMES]:
            wrong = "the wall shows frame %s" % wall.numbers()[-1:]
        return wall, wrong


@cases.case
def lossless(context):
    """Each shown frame is the session's picture, byte for byte."""
    with tempfile.TemporaryDirectory(prefix="mural-far.") as folder:
        wall, wrong = shown(context, folder, "auto")
        differ = [n for n in wall.numbers() if not filecmp.cmp(own_picture(folder, n), wall.path(n), shallow=False)]
        return wrong or ("frames differ: %s" % differ if differ else None)


@cases.case
def jpeg(context):
    """The last frame is at least 45 dB from the session's picture."""
    with tempfile.TemporaryDirectory(prefix="mural-far.") as folder:
        wall, wrong = shown(context, folder, "jpeg-100")
        if wrong:
            return wrong
        near = pictures.decibels(pictures.read_png(own_picture(folder, FRAMES)), wall.picture(FRAMES))
        print("  %.1f dB" % near)
        return None if near >= MIN_DB else "%.1f dB" % near


@cases.case
def cut(context):
    """The link is cut. The session goes on, and the wall shows exact pictures after the link is back."""
    with tempfile.TemporaryDirectory(prefix="mural-far.") as folder:
        key = secret(folder, "key")
        with museum(context, folder, key) as wall, sending(context, folder, key, "auto", 100000, "640x480") as run:
            if not wall.saves_after(2):
                return "no frame: " + " | ".join(run.standard_error[-3:])
            network.cut("museum")
            time.sleep(0.5)  # frames that are under way
            last = wall.numbers()[-1]
            time.sleep(CUT_SECONDS)
            saved = len(os.listdir(os.path.join(folder, "here")))
            network.join("museum")
            if saved <= last + 5:
                return "the session waits for the wall: %d frames, the wall has %d" % (saved, last)
            if not wall.saves_after(last, 60):
                return "nothing after the cut: " + " | ".join(run.standard_error[-3:] + wall.lines)
            after = wall.numbers()[-2]  # the last one may be incomplete
            return None if filecmp.cmp(own_picture(folder, after), wall.path(after), shallow=False) else "frame %d differs" % after


@cases.long_case
def second_session(context):
    """A second session is told who shows pictures there, and follows when the first one ends."""
    with tempfile.TemporaryDirectory(prefix="mural-far.") as folder, tempfile.TemporaryDirectory(prefix="mural-far.") as other:
        key = secret(folder, "key")
        with museum(context, folder, key) as wall:
            with sending(context, folder, key, "auto", 100000, "320x200") as first:
                if not wall.saves_after(1):
                    return "no frame: " + " | ".join(first.standard_error[-3:])
                with sending(context, other, key, "auto", 100000, "160x100") as second:
                    if not processes.until(lambda: any("it shows the pictures of" in line for line in list(second.standard_error)), 20):
                        return "no line: " + " | ".join(second.standard_error[-3:])
                    cases.kill_all(first.processes("."))
                    # The last file may be incomplete.
                    follows = processes.until(lambda: wall.picture(wall.numbers()[-2]).width == 160, 45)
                    return None if follows else "the second session does not follow: " + " | ".join(second.standard_error[-3:] + wall.lines)


def main():
    global network
    own_network.enter()
    network = own_network.OwnNetwork(HERE, {"museum": MUSEUM})
    for at in ("tc", "tc -n museum"):
        own_network.sh("%s qdisc add dev eth0 root tbf rate 1gbit burst 256kb limit 8mb" % at)
    with SlowLink((HERE, RELAY_PORT), (MUSEUM, PORT), ONE_WAY_SECONDS):
        return cases.main(__doc__)


if __name__ == "__main__":
    sys.exit(main())
