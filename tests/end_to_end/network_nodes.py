#!/usr/bin/env python3
"""Render nodes on other machines (own_network.py). The stream reaches them by multicast, or over their own connections
where multicast fails. Every pixel equals a native run's, with any losses.

  network_nodes.py --build build/release [--cases good,loss]
Exit status 77, with a reason: this machine permits no namespaces.
"""

import argparse
import os
import subprocess
import sys
import tempfile

from harness import display, own_network, session

HERE = "10.79.0.1"
NODES = {"wall1": "10.79.0.2", "wall2": "10.79.0.3"}
MULTICAST = "with reliable multicast"
UNREACHED = "no reply to multicast"
REACHED_AGAIN = "multicast works again"
MAX_FRAMES = 20000  # limit for runs that end after a few hundred frames, when enough was seen
NO_MULTICAST = "ip daddr 239.0.0.0/8"


class Lab:
    def __init__(self, mural, program, network, folder, display_name):
        self.mural, self.program, self.network, self.display = mural, program, network, display_name
        self.launch = network.launch_script(os.path.join(folder, "launch"))
        self.end_file = os.path.join(folder, "end")

    def run(self, frames, *options, layout=("--tiles", "2x1")):
        command = [self.mural, "run", *layout, "--nodes", ",".join(NODES.values()), "--launch", self.launch,
                   "--display", "none", "--explain", "--verify", *options, "--", self.program, "--frames", str(frames), "--size", "250x190"]
        return session.Session(command, self.display, {"END_FILE": self.end_file})

    def end_after(self, frames):
        session.end_after(self.end_file, frames)

    def mend(self):
        for machine in NODES:
            self.network.at(machine, "nft flush ruleset")
        if os.path.exists(self.end_file):
            os.remove(self.end_file)


def drawn_by(run):
    return sum(line.startswith("frame ") for line in run.standard_output)


def too_many(frames):
    """Returns an error if a run reached the frame limit instead of ending when enough was seen."""
    return None if frames < MAX_FRAMES else "it did not end before frame %d" % frames


def finished(run, wants=(), wants_not=("was lost",)):
    """Returns None, or the error of a run that should now end well."""
    status = run.status()
    output = "\n".join(run.standard_error)
    if status != 0:
        return "status %s; output:\n%s" % (status, output)
    missing = [text for text in (*wants, " 0 differ") if text not in output]
    extra = [text for text in wants_not if text in output]
    if missing or extra:
        return "missing: %s, too much: %s; output:\n%s" % (missing, extra, output)
    left = run.left_behind()
    return "left over: %s" % left if left else None


def good(lab):
    with lab.run(60) as run:
        return finished(run, [MULTICAST, "datagrams of 8972 bytes"], ["was lost", "TCP"])


def loss(lab):
    for name in NODES:
        lab.network.drop(name, "meta l4proto udp numgen random mod 100 < 3")
    with lab.run(60) as run:
        return finished(run, [MULTICAST], ["was lost", "TCP"])


def short_packets(lab):
    """One node's card accepts only packets of 1500 bytes: all datagrams are limited to it."""
    lab.network.at("wall2", "ip link set eth0 mtu 1500")
    with lab.run(30) as run:
        wrong = finished(run, [MULTICAST, "datagrams of 1472 bytes"], ["was lost", "TCP"])
    lab.network.at("wall2", "ip link set eth0 mtu 9000")
    return wrong


def tcp(lab):
    with lab.run(30, "--stream", "tcp") as run:
        return finished(run, ["its own connection: --stream tcp"], ["was lost", MULTICAST])


def not_reached(lab):
    lab.network.drop("wall2", NO_MULTICAST)
    with lab.run(60) as run:
        return finished(run, [MULTICAST, "node 1 (10.79.0.3", UNREACHED])


def no_group(lab):
    with lab.run(30, "--stream", "rsp://239.255.77.3:4277?interface=nowhere0") as run:
        return finished(run, ["its own connection: no multicast", "nowhere0"], ["was lost", MULTICAST])


def ceases_and_returns(lab):
    with lab.run(MAX_FRAMES) as run:
        if not run.wait_for_line("frame 30"):
            return "it did not begin: %s" % run.standard_error
        lab.network.drop("wall1", NO_MULTICAST)
        if not run.wait_for_line(UNREACHED):
            return "no message that multicast failed"
        lab.network.heal("wall1")
        if not run.wait_for_line(REACHED_AGAIN):
            return "no message that multicast works again"
        lab.end_after(100)
        return finished(run) or too_many(drawn_by(run))


def killed(lab, *options):
    """A killed node rejoins, first over its own connection, then in the group, and draws half of all frames there."""
    with lab.run(MAX_FRAMES, *options) as run:
        if not run.wait_for_line("frame 30"):
            return "it did not begin: %s" % run.standard_error
        victim = run.wait_for_processes(r"^\S*mural node", 2)[0]
        os.kill(victim, 9)
        if not run.wait_for_line(REACHED_AGAIN):
            return "it did not rejoin the group; output:\n%s" % "\n".join(run.standard_error)
        drawn_before = drawn_by(run)
        lab.end_after(drawn_before + 100)
        wanted = [MULTICAST, " rejoined ", " 0 differ"]
        status = run.status()
        output = "\n".join(run.standard_error)
        drawn = drawn_by(run)
        # Exactly once: a stream that continues at a wrong position ends the node again.
        good = status == 0 and all(text in output for text in wanted) and output.count("was lost: ") == 1 and drawn_before < drawn / 2
        return too_many(drawn) if good else "status %s, %d frames, %d before it rejoined; output:\n%s" % (status, drawn, drawn_before, output)


def killed_without_delta(lab):
    return killed(lab, "--delta", "off")


def stopped(lab):
    """A node that an operator stops hands its area over and leaves the group; started again, it returns to both."""
    with lab.run(MAX_FRAMES, layout=("--balance", "auto")) as run:
        if not run.wait_for_line("frame 30"):
            return "it did not begin: %s" % run.standard_error
        ctl = [lab.mural, "ctl", str(run.process.pid)]
        for words, awaited in ((("stop-node", "1"), "has stopped"), (("start-node", "1"), REACHED_AGAIN)):
            done = subprocess.run(ctl + list(words), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
            if done.returncode != 0 or not run.wait_for_line(awaited):
                return "%s: status %d, %s; output:\n%s" % (" ".join(words), done.returncode, done.stderr, "\n".join(run.standard_error))
            before = drawn_by(run)
            if not run.wait_for_line("frame %d" % (before + 20)):
                return "no frames after %s" % " ".join(words)
        lab.end_after(20)
        return finished(run, [MULTICAST, " rejoined "]) or too_many(drawn_by(run))


CASES = {f.__name__: f for f in (good, loss, short_packets, tcp, not_reached, no_group, ceases_and_returns, killed, killed_without_delta, stopped)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True)
    parser.add_argument("--cases", default=",".join(CASES))
    arguments = parser.parse_args()
    own_network.enter()
    network = own_network.OwnNetwork(HERE, NODES, mtu=9000)
    build = os.path.abspath(arguments.build)
    failed = 0
    with tempfile.TemporaryDirectory() as folder, display.PrivateDisplay() as display_name:
        lab = Lab(os.path.join(build, "bin", "mural"), os.path.join(build, "tests", "programs", "long_run"), network, folder, display_name)
        for name in arguments.cases.split(","):
            wrong = CASES[name](lab)
            lab.mend()
            print("%s: %s" % (name, "ok" if wrong is None else "FAILED: " + wrong), flush=True)
            failed += wrong is not None
    sys.exit(1 if failed else 0)


main()
