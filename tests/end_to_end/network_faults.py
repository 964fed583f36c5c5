#!/usr/bin/env python3
"""Reliable multicast (docs/architecture/transport.md) on a faulty network (own_network.py): one sender and three
receivers with `mural netperf`, which checks each byte. Each surviving receiver has all bytes, once and in order.

  network_faults.py --build build/release [--cases duplicates,bursts] [--long]
Exit status 77, with a reason: this machine permits no namespaces.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

from harness import own_network

HERE = "192.0.2.20"
RECEIVERS = {"wall1": "192.0.2.21", "wall2": "192.0.2.22", "wall3": "192.0.2.23"}
STRANGER = {"stranger": "192.0.2.24"}
GROUP, GROUP_PORT, CONTROL_PORT = "239.255.77.90", 4277, 4278
RATE_BYTES_PER_S = 10_000_000
PATIENT = {"silent-ms": 20000, "stalled": "wait"}
STEP_MS = 20  # step of the timeline
MAX_GAP_S = 1.2
DATAGRAMS = "udp dport %d" % GROUP_PORT
PAYLOAD = {"counter": "@ih,96,16", "symbol": "@ih,800,16"}  # bits after the UDP header: the cipher's counter, the middle
ENDS_WITHIN_S = 40


class End:
    """One process of netperf."""

    def __init__(self, folder, name, command):
        self.name = name
        self.files = [open(os.path.join(folder, "%s.%d.%s" % (name, time.monotonic_ns(), kind)), "w+", encoding="utf-8")
                      for kind in ("out", "err")]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self.files[0], stderr=self.files[1])

    def _text(self, file):
        with open(file.name, encoding="utf-8") as again:
            return again.read()

    def output(self):
        return self._text(self.files[1])

    def wait_for(self, text, seconds=10):
        until = time.monotonic() + seconds
        while text not in self.output():
            if time.monotonic() > until or self.process.poll() is not None:
                raise Wrong("%s did not print \"%s\"; output: %s" % (self.name, text, self.output()))
            time.sleep(0.01)

    def status(self, seconds=ENDS_WITHIN_S):
        try:
            return self.process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise Wrong("%s did not end within %d s; output: %s" % (self.name, seconds, self.output())) from None

    def measured(self):
        self.status()
        lines = self._text(self.files[0]).splitlines()
        return json.loads(lines[0]) if lines else {}

    def signal(self, number):
        self.process.send_signal(number)


class Wrong(Exception):
    """A failed expectation."""


class Lab:
    def __init__(self, mural, network, folder):
        self.mural, self.network, self.folder = mural, network, folder
        self.secret = os.path.join(folder, "secret")
        with open(self.secret, "w", encoding="utf-8") as file:
            file.write("a secret of these tests only\n")
        os.chmod(self.secret, 0o600)
        self.ends = []

    def _start(self, name, command):
        self.ends.append(End(self.folder, name, command))
        return self.ends[-1]

    def _stream(self, **parameters):
        given = {"interface": "eth0", "secret": self.secret, "control": "%s:%d" % (HERE, CONTROL_PORT), **parameters}
        return "rsp://%s:%d?%s" % (GROUP, GROUP_PORT, "&".join("%s=%s" % item for item in given.items()))

    def send(self, total_bytes, members=len(RECEIVERS), within_s=ENDS_WITHIN_S, **parameters):
        sender = self._start("sender", [self.mural, "netperf", "send", "--json", "--members", str(members), "--bytes", str(total_bytes), "--within",
                                        str(within_s), "--stream", self._stream(rate="%dMB" % (RATE_BYTES_PER_S // 1_000_000), **parameters)])
        sender.wait_for("waiting for")
        return sender

    def receive(self, name, *options, within_s=ENDS_WITHIN_S):
        return self._start(name, ["ip", "netns", "exec", name, self.mural, "netperf", "receive", "--json", "--timeline", str(STEP_MS),
                                  "--within", str(within_s), "--stream", self._stream(), *options])

    def begin(self, total_bytes, **parameters):
        """Returns (sender, receivers) in the middle of the stream."""
        sender = self.send(total_bytes, **parameters)
        receivers = [self.receive(name) for name in RECEIVERS]
        self.wait_until_it_flows(sender)
        return sender, receivers

    def wait_until_it_flows(self, sender, seconds=40):
        """Waits until the sender has passed the bytes of a tenth of a second to its card."""
        wanted, until = self._sent_bytes() + RATE_BYTES_PER_S // 10, time.monotonic() + seconds
        while self._sent_bytes() < wanted:
            if time.monotonic() > until or sender.process.poll() is not None:
                raise Wrong("nothing flows; the sender printed: %s" % sender.output())
            time.sleep(0.02)

    @staticmethod
    def _sent_bytes():
        with open("/proc/net/dev", encoding="utf-8") as file:
            return next(int(line.split(":")[1].split()[8]) for line in file if line.strip().startswith("eth0:"))

    def end(self):
        for end in self.ends:
            if end.process.poll() is None:
                end.process.kill()
                end.process.wait()
            for file in end.files:
                file.close()
        self.ends = []


def whole(receivers, total_bytes):
    """Checks that each receiver has the stream from its first to its last byte; netperf itself checks the bytes
    between."""
    reported = [r.measured() for r in receivers]
    for r, m in zip(receivers, reported):
        if r.status() != 0 or m.get("bytes") != total_bytes or m.get("firstByte") != 0:
            raise Wrong("%s: status %d, %s bytes from %s, not %d; output: %s" % (r.name, r.status(), m.get("bytes"), m.get("firstByte"), total_bytes, r.output()))
    return reported


def content(sender, members_lost=0):
    m = sender.measured()
    if sender.status() != 0 or m.get("membersLost") != members_lost:
        raise Wrong("the sender: status %d, %s receivers lost, not %d; output: %s" % (sender.status(), m.get("membersLost"), members_lost, sender.output()))
    return m


def longest_gap_s(measured):
    longest = run = 0
    for came in measured["timeline"]["bytes"]:
        run = run + 1 if came == 0 else 0
        longest = max(longest, run)
    return longest * STEP_MS / 1000


def stream_of(measured):
    return measured["streams"][0]


def counted(lab, name, table="faults"):
    """Returns the number of packets counted by the rules."""
    rules = subprocess.run(["ip", "netns", "exec", name, "nft", "-j", "list", "table", "netdev", table], capture_output=True, text=True,
                           check=True, timeout=20).stdout
    return sum(part["counter"]["packets"] for item in json.loads(rules)["nftables"] for part in item.get("rule", {}).get("expr", [])
               if "counter" in part)


def need(good, what):
    if not good:
        raise Wrong(what)


def others_go_on(lab, seconds, lose):
    """Removes the second of three receivers in mid-stream with lose(receiver); the other two must receive everything."""
    total = seconds * RATE_BYTES_PER_S
    sender, receivers = lab.begin(total)
    time.sleep(0.5)
    lose(receivers[1])
    reported = whole([receivers[0], receivers[2]], total)
    content(sender, members_lost=1)
    gap = max(longest_gap_s(m) for m in reported)
    need(gap <= MAX_GAP_S, "the others stood still for %.2f s" % gap)
    return "longest gap %.2f s" % gap


def receiver_killed(lab):
    return others_go_on(lab, 2, lambda receiver: receiver.signal(signal.SIGKILL))


def receiver_cut_off(lab):
    """A receiver without any contact, not even a connection reset, is evicted for its silence."""
    return others_go_on(lab, 4, lambda receiver: lab.network.cut("wall2"))


def receiver_frozen(lab):
    total = 2 * RATE_BYTES_PER_S
    sender, receivers = lab.begin(total, **PATIENT)
    time.sleep(0.3)
    receivers[1].signal(signal.SIGSTOP)
    time.sleep(5)
    receivers[1].signal(signal.SIGCONT)
    reported = whole(receivers, total)
    content(sender)
    gap = longest_gap_s(reported[1])
    need(gap >= 4, "it was not frozen: its longest gap is %.2f s" % gap)
    return "%d datagrams dropped by its socket" % reported[1]["socketDropped"]


def sender_killed(lab):
    sender, receivers = lab.begin(100 * RATE_BYTES_PER_S)
    time.sleep(0.3)
    sender.signal(signal.SIGKILL)
    began = time.monotonic()
    for r in receivers:
        need(r.status() == 1, "%s: status %d; output: %s" % (r.name, r.status(), r.output()))
        need(len(r.output().splitlines()) == 1 and "the stream was cut off after" in r.output(), "%s printed: %s" % (r.name, r.output()))
        need(r.measured()["bytes"] > 0 and "wrong" not in r.measured(), "%s: %s" % (r.name, r.measured()))
    return "known after %.2f s" % (time.monotonic() - began)


def comes_and_goes(lab):
    total = 3 * RATE_BYTES_PER_S
    # A new member receives the stream from its join on: with a small window that data is sent soon.
    sender, receivers = lab.begin(total, window=512)
    guests = []
    for number in range(15):
        time.sleep(0.1)
        guests.append(lab.receive(list(RECEIVERS)[number % 3], "--leave-after", str(0.2 + 0.1 * (number % 4))))
    killed = [g for number, g in enumerate(guests) if number % 5 == 4]
    for g in killed:
        g.signal(signal.SIGKILL)
    whole(receivers, total)
    content(sender)
    received = 0
    for g in guests:
        if g in killed:
            continue
        need(g.status() == 0, "a guest: status %d; output: %s" % (g.status(), g.output()))
        received += g.measured()["bytes"] > 0
    need(received >= 5, "only %d guests heard anything" % received)
    return "%d guests heard a part" % received


def link_cut_and_healed(lab):
    total = 2 * RATE_BYTES_PER_S
    sender, receivers = lab.begin(total, **PATIENT)
    lab.network.cut("wall2")
    time.sleep(3)
    lab.network.join("wall2")
    reported = whole(receivers, total)
    content(sender)
    gap = longest_gap_s(reported[1])
    need(gap >= 2, "it was not cut off: its longest gap is %.2f s" % gap)
    return "longest gap %.2f s" % gap


def out_of_order(lab):
    """Some datagrams take a longer path: 2 to 3 ms, about 17 datagrams."""
    total = RATE_BYTES_PER_S
    lab.network.detour("%s numgen random mod 100 < 5" % DATAGRAMS)
    try:
        sender, receivers = lab.begin(total)
        reported = whole(receivers, total)
        sent = content(sender)
        late = counted(lab, "switch")
        need(late > 0.02 * sent["datagrams"], "only %d of %d datagrams were late" % (late, sent["datagrams"]))
        repairs = sent["parity"] + sent["resent"]
        return "%d of %d late, %d repairs, %d arrived twice" % (late, sent["datagrams"], repairs, max(stream_of(m)["duplicates"] for m in reported))
    finally:
        lab.network.end_detour()


def duplicates(lab):
    total = RATE_BYTES_PER_S
    lab.network.rules("switch", "port0", *("%s numgen random mod 100 < 20 counter dup to \"port%d\"" % (DATAGRAMS, n) for n in (1, 2, 3)))
    sender, receivers = lab.begin(total)
    reported = whole(receivers, total)
    content(sender)
    refused = min(m["refused"] for m in reported)
    need(refused > 300, "only %d datagrams arrived twice" % refused)
    return "%d to %d refused by their counters" % (refused, max(m["refused"] for m in reported))


def bit_errors(lab):
    """nft corrects the UDP checksum, so only the cipher detects the errors."""
    total = RATE_BYTES_PER_S
    for name in RECEIVERS:
        lab.network.rules(name, "eth0", *("%s numgen random mod 100 < 2 counter %s set 0x5a5a" % (DATAGRAMS, field) for field in PAYLOAD.values()))
    sender, receivers = lab.begin(total)
    reported = whole(receivers, total)
    content(sender)
    refused = min(m["refused"] for m in reported)
    need(refused > 100, "only %d datagrams were refused" % refused)
    return "%d to %d refused by their seals" % (refused, max(m["refused"] for m in reported))


def stranger(lab):
    total = 2 * RATE_BYTES_PER_S
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "harness", "stranger.py")
    forger = subprocess.Popen(["ip", "netns", "exec", "stranger", sys.executable, script, GROUP, str(GROUP_PORT), STRANGER["stranger"], "4"],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    try:
        sender, receivers = lab.begin(total)
        reported = whole(receivers, total)
        content(sender)
        output = forger.communicate(timeout=20)[0].split()
    finally:
        forger.kill()
        forger.wait()
    sent = dict(zip(output[::2], map(int, output[1::2])))
    # The stranger's rate depends on the load of the machine. A small number is sufficient, because a missing check
    # rejects none.
    need(sent.get("replayed", 0) > 100 and sent.get("changed", 0) > 100, "the stranger sent: %s" % sent)
    # Counted by kind: other rejections must not hide that one of the two checks is missing.
    refused = {kind: min(m[kind] for m in reported) for kind in ("replayed", "forged")}
    need(min(refused.values()) > 20, "refused were only %s" % refused)
    return "%s; refused %s" % (sent, refused)


def bursts(lab):
    """Two receivers lose everything for 0.2 s, four times, not at the same time."""
    total = 2 * RATE_BYTES_PER_S
    sender, receivers = lab.begin(total)
    make = "nft add table netdev bursts; nft add chain netdev bursts in { type filter hook ingress device eth0 priority 0\\; }; sleep %s; "
    losing = [lab.network.start(name, make % first_s + "for i in 1 2 3 4; do nft add rule netdev bursts in meta l4proto udp drop; sleep 0.2; "
                                "nft flush chain netdev bursts in; sleep 0.3; done") for name, first_s in (("wall1", 0), ("wall3", 0.1))]
    try:
        reported = whole(receivers, total)
        content(sender)
        for one in losing:
            need(one.wait(timeout=20) == 0, "the rules of the bursts could not be made")
    finally:
        for one in losing:
            one.kill()
            one.wait()
    lost = [stream_of(reported[i])["lost"] for i in (0, 2)]
    need(min(lost) > 500, "only %s datagrams were lost" % lost)
    return "%s lost, longest gap %.2f s" % (lost, max(longest_gap_s(m) for m in reported))


def billion(lab):
    """Sends 10^9 bytes with 5 % loss, independent at each receiver."""
    total = 1_000_000_000
    for name in (*RECEIVERS,):
        lab.network.rules(name, "eth0", "%s numgen random mod 100 < 5 counter drop" % DATAGRAMS)
    began = time.monotonic()
    sender = lab.send(total, within_s=1000)
    receivers = [lab.receive(name, within_s=1000) for name in RECEIVERS]
    sender.status(1000)
    reported = whole(receivers, total)
    sent = content(sender)
    lost = [counted(lab, name) for name in RECEIVERS]
    need(min(lost) > 10_000, "only %s datagrams were lost" % lost)
    return "%.0f s, %.1f Mbit/s, %s of %d datagrams lost, %d repairs, longest gap %.2f s" % (
        time.monotonic() - began, sent["mbit"], lost, sent["datagrams"], sent["parity"] + sent["resent"], max(longest_gap_s(m) for m in reported))


CASES = {f.__name__: f for f in (receiver_killed, receiver_cut_off, receiver_frozen, sender_killed, comes_and_goes, link_cut_and_healed,
                                 out_of_order, duplicates, bit_errors, stranger, bursts)}
LONG_CASES = {f.__name__: f for f in (billion,)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True)
    parser.add_argument("--cases", help="of: " + ",".join((*CASES, *LONG_CASES)))
    parser.add_argument("--long", action="store_true", help="also what takes minutes: " + ",".join(LONG_CASES))
    arguments = parser.parse_args()
    own_network.enter(own_processes=True)
    network = own_network.OwnNetwork(HERE, {**RECEIVERS, **STRANGER}, single_packets=True)
    names = arguments.cases.split(",") if arguments.cases else [*CASES, *(LONG_CASES if arguments.long else ())]
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        lab = Lab(os.path.join(os.path.abspath(arguments.build), "bin", "mural"), network, folder)
        for name in names:
            began = time.monotonic()
            try:
                outcome = "ok: %s" % {**CASES, **LONG_CASES}[name](lab)
            except Wrong as wrong:
                outcome = "FAILED: %s" % wrong
                failed += 1
            lab.end()
            network.mend()
            print("%s (%.1f s): %s" % (name, time.monotonic() - began, outcome), flush=True)
    sys.exit(1 if failed else 0)


main()
