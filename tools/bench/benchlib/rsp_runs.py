"""Runs of `mural netperf` on a rig of network namespaces."""

import json
import os
import re
import time

from benchlib.netlab_rig import wait_all
from benchlib.stream_result import StreamFailed, StreamResult

START_SECONDS = 10
MAX_SECONDS = 40 # longest duration of a run


class RspGroup:
    """A sender on host 0 and receivers on the other hosts."""

    def __init__(self, rig, mural, secret, receivers, options, seal="none", place=0, checked=True, receiver_programs=()):
        """place: groups of different numbers run at the same time. checked: every byte is compared, which adds CPU
        time that the transport does not use. receiver_programs: another `mural` for each receiver."""
        self.rig = rig
        ends = [] if checked else ["--unchecked"]
        network = ["--json", "--interface", "eth0", "--secret-file", secret, "--within", str(MAX_SECONDS),
                   "--group", "239.255.77.%d:4277" % (85 + place)]
        self.control = "%s:%d" % (rig.address(0), 4278 + place)
        receive = ["netperf", "receive", "--control", self.control, "--timeline", "5"] + ends + network
        self.sender = rig.start(0, [mural, "netperf", "send", "--members", str(receivers), "--control", self.control, "--seal", seal] + options + ends + network)
        self._wait_until_it_listens()
        programs = receiver_programs or [mural] * receivers
        self.receivers = [rig.start(host + 1, [program] + receive) for host, program in enumerate(programs)]

    def _wait_until_it_listens(self):
        until = time.monotonic() + START_SECONDS
        while not re.search(r"listens on", self.sender.output_so_far() if self.sender.poll() is None else "listens on"):
            if time.monotonic() > until:
                raise StreamFailed("rsp: the sender does not listen")
            time.sleep(0.005)

    def end(self, without=()):
        """Returns (sender's report, [receivers' reports]) after all have ended without error. `without`: hosts that
        need not end; None in the list."""
        reported = []
        hosts = [host for host in range(len(self.receivers) + 1) if host not in without]
        all_of_it = [self.sender] + self.receivers
        ended = dict(zip(hosts, wait_all([all_of_it[host] for host in hosts], MAX_SECONDS)))
        for host in range(len(all_of_it)):
            if host in without:
                reported.append(None)
                continue
            finished = ended[host]
            if finished is None or finished.status != 0:
                why = "still runs after %d s" % MAX_SECONDS if finished is None else finished.wrong.strip().split("\n")[-1]
                self.rig.end_programs()
                raise StreamFailed("rsp: host %d: %s" % (host, why))
            reported.append(json.loads(finished.output.strip().split("\n")[-1]))
        return reported[0], reported[1:]


class Rsp:
    """The protocol under test."""

    def __init__(self, mural, folder):
        self.mural = mural
        self.secret = os.path.join(folder, "secret")
        with open(self.secret, "w", encoding="utf-8") as file:
            file.write("a secret of the bench's own\n")
        os.chmod(self.secret, 0o600)

    def group(self, rig, receivers, options, **more):
        return RspGroup(rig, self.mural, self.secret, receivers, options, **more)

    def stream(self, rig, receivers, size_bytes, wire_mbit, seal="none", parity=True, checked=True):
        options = ["--bytes", str(size_bytes), "--rate", "%dkbit" % round(wire_mbit * 1000)] + ([] if parity else ["--no-parity"])
        sent, received = self.group(rig, receivers, options, seal=seal, checked=checked).end()
        check_whole(sent, received, size_bytes)
        cpu = sum(r["cpuSecondsPerGB"] for r in received) / receivers
        return StreamResult(min(r["mbit"] for r in received), sent["cpuSecondsPerGB"], cpu, sent["parity"] + sent["resent"], sent["datagrams"])

    def messages(self, rig, receivers, message_bytes, count, wire_mbit, place=0):
        """Returns the latencies in us until all receivers have a message: {"p50", "p99", ...}."""
        options = ["--message", str(message_bytes), "--count", str(count), "--rate", "%dkbit" % round(wire_mbit * 1000)]
        sent, received = self.group(rig, receivers, options, place=place).end()
        check_whole(sent, received, sent["bytes"])
        return sent["latencyUs"]


def check_whole(sent, received, size_bytes):
    for reported in [sent] + [r for r in received if r is not None]:
        if reported["bytes"] != size_bytes:
            raise StreamFailed("rsp: %s has %d of %d bytes" % (reported["role"], reported["bytes"], size_bytes))
        if reported.get("cut"):
            raise StreamFailed("rsp: %s was cut off: %s" % (reported["role"], reported["cut"]))
