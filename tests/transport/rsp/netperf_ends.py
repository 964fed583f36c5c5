#!/usr/bin/env python3
"""Exit statuses of `mural netperf receive`: success if the sender completes; failure if the sender is killed, sends other
bytes, or continues without the receiver.

  netperf_ends.py MURAL
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time

WAIT_SECONDS = 30
REMOVED_SECONDS = 1.8 # a silence that leads to eviction


def start(words):
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def start_pair(mural, secret, size, sender_options=(), receiver_options=(), rate="80mbit"):
    """Returns (sender, receiver) of a stream over the loopback."""
    common = ["--interface", "lo", "--group", "239.255.77.87:%d" % (20000 + os.getpid() % 20000), "--secret-file", secret,
              "--within", str(WAIT_SECONDS)]
    sender = start([mural, "netperf", "send", "--members", "1", "--bytes", size, "--rate", rate, "--control", "127.0.0.1:0"] + common + list(sender_options))
    output = sender.stderr.readline()
    found = re.search(r"listens on (\S+)", output)
    if not found:
        sys.exit("netperf_ends: the sender does not print its address: %r" % output)
    return sender, start([mural, "netperf", "receive", "--json", "--control", found.group(1)] + common + list(receiver_options))


def go_on(receiver):
    """Waits until the receiver is in the middle of the stream."""
    try:
        receiver.wait(timeout=1.5)
    except subprocess.TimeoutExpired:
        pass


def expect(what, good, reported):
    if not good:
        sys.exit("netperf_ends: %s: %r" % (what, reported))


def main():
    mural = sys.argv[1]
    with tempfile.NamedTemporaryFile("w") as secret:
        secret.write("a secret of these two tests\n")
        secret.flush()

        sender, receiver = start_pair(mural, secret.name, "2M")
        reported = receiver.communicate(timeout=WAIT_SECONDS)
        expect("a sender that is done is no success", receiver.returncode == 0 and '"bytes":2097152' in reported[0], reported)
        sender.communicate(timeout=WAIT_SECONDS)

        unchecked = ["--unchecked"]
        sender, receiver = start_pair(mural, secret.name, "2M", unchecked, unchecked)
        reported = receiver.communicate(timeout=WAIT_SECONDS)
        expect("unchecked data fails", receiver.returncode == 0 and '"bytes":2097152' in reported[0], reported)
        sender.communicate(timeout=WAIT_SECONDS)

        # A checking receiver detects that these bytes are not the pattern.
        sender, receiver = start_pair(mural, secret.name, "2M", unchecked)
        reported = receiver.communicate(timeout=WAIT_SECONDS)
        expect("changed bytes pass", receiver.returncode == 1 and "received data differs from sent data" in reported[1], reported)
        sender.communicate(timeout=WAIT_SECONDS)

        # The receiver is stopped until it is evicted: the end of its data is not the end of the stream. Its socket
        # holds enough data.
        sender, receiver = start_pair(mural, secret.name, "1G", rate="300mbit")
        go_on(receiver)
        receiver.send_signal(signal.SIGSTOP)
        time.sleep(REMOVED_SECONDS)
        receiver.send_signal(signal.SIGCONT)
        reported = receiver.communicate(timeout=WAIT_SECONDS)
        sender.kill()
        sender.communicate()
        expect("to be removed is no failure", receiver.returncode == 1 and "has evicted this member" in reported[1], reported)

        sender, receiver = start_pair(mural, secret.name, "1G")
        go_on(receiver)
        sender.send_signal(signal.SIGKILL)
        reported = receiver.communicate(timeout=WAIT_SECONDS)
        sender.communicate()
        expect("a killed sender is no failure", receiver.returncode == 1, reported)
        expect("a killed sender is not reported in one line", re.fullmatch(r"mural netperf: the stream was cut off after \d+ bytes.*connection to the group's host was lost.*\n", reported[1]), reported)
        expect("earlier measurements are missing", '"cut":' in reported[0], reported)


if __name__ == "__main__":
    main()
