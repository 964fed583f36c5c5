"""Other multicast protocols with which RSP is compared. They are built from netlab's harnesses, or are Debian's
programs."""

import os
import re
import shutil
import subprocess

from benchlib.netlab_rig import numbers_of, wait_all
from benchlib.stream_result import StreamFailed, StreamResult

UDP_HEAD_BYTES = 28
WIRE_BYTES = 66 # Ethernet, IPv4 and UDP bytes per payload, including gap and preamble
LIMIT_SECONDS = 12
JOIN_SECONDS = 0.3 # time for receivers to join the group, which they do not report


def finish(name, programs, seconds=LIMIT_SECONDS):
    done = wait_all(programs, seconds)
    for program, finished in zip(programs, done):
        if finished is None:
            for other in programs:
                other.end()
            raise StreamFailed("%s: not done after %d s" % (name, seconds))
        if finished.status != 0:
            raise StreamFailed("%s: status %d: %s" % (name, finished.status, (finished.wrong or finished.output).strip().split("\n")[-1]))
    return done


class Harness:
    """A peer with a C++ program in netlab."""

    def __init__(self, folder, name, source, flags=()):
        """Builds the program. self.missing has the reason if that fails."""
        self.path = os.path.join(folder, name)
        self.missing = ""
        command = ["g++", "-O2", "-std=c++17", "-w", "-o", self.path, source] + list(flags)
        built = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
        if built.returncode != 0:
            errors = [line for line in built.stderr.decode(errors="replace").split("\n") if "error" in line]
            self.missing = errors[0] if errors else "it cannot be built"


class Raw(Harness):
    """Multicast without repairs: the limit of the network and this machine."""

    def __init__(self, netlab_folder, folder):
        super().__init__(folder, "mcraw", os.path.join(netlab_folder, "mcraw.cpp"))

    def stream(self, rig, receivers, seconds, wire_mbit, sending="gso", batch=1, bare_receiver=None):
        """bare_receiver: replaces the receiving program, and only empties its socket from time to time."""
        payload = rig.mtu - UDP_HEAD_BYTES
        rate = wire_mbit * payload / (payload + WIRE_BYTES)
        common = ["239.1.1.1", "6000"]
        hosts = [rig.start(host, [bare_receiver] + common + [rig.address(host)] if bare_receiver else
                           [self.path, "recv"] + common + [rig.address(host), "mode=mmsg", "secs=%g" % seconds])
                 for host in range(1, receivers + 1)]
        wait_all(hosts, JOIN_SECONDS)
        sender = rig.start(0, [self.path, "send"] + common + [rig.address(0), "mode=" + sending, "size=%d" % payload, "batch=%d" % batch,
                                                               "secs=%g" % seconds, "rate=%g" % rate])
        done = finish("raw", [sender] + hosts)
        reported = [numbers_of(d.output) for d in done]
        return StreamResult(min(t["gbit"] for t in reported[1:]) * 1000, reported[0]["cpu_s_per_GB"],
                            sum(t["cpu_s_per_GB"] for t in reported[1:]) / receivers)


class OwnProgram:
    """A peer whose harness takes `bytes=` and reports `gbit=` and `cpu_s_per_GB=` at each end."""

    may_miss_bytes = 0
    joins = True # receivers need time to join the group
    counts_late = False # a receiver's time starts at its first byte, so none is faster than its sender

    def __init__(self, name, harness, package, share=lambda receivers: 1.0):
        """share: fraction of the other protocols' bytes, so that the runs have about the same duration."""
        self.name, self.harness, self.package, self.share = name, harness, package, share

    @property
    def missing(self):
        return self.harness.missing

    def sender_words(self, rig, receivers, size_bytes, wire_mbit):
        raise NotImplementedError

    def receiver_words(self, rig, host, size_bytes):
        raise NotImplementedError

    def stream(self, rig, receivers, size_bytes, wire_mbit):
        size_bytes = int(size_bytes * self.share(receivers))
        hosts = [rig.start(host, [self.harness.path, "recv"] + self.receiver_words(rig, host, size_bytes)) for host in range(1, receivers + 1)]
        if self.joins:
            wait_all(hosts, JOIN_SECONDS)
        sender = rig.start(0, [self.harness.path, "send"] + self.sender_words(rig, receivers, size_bytes, wire_mbit))
        done = finish(self.name, [sender] + hosts)
        reported = [numbers_of(d.output) for d in done]
        for host, t in enumerate(reported):
            if t.get("bytes", 0) < size_bytes - self.may_miss_bytes:
                raise StreamFailed("%s: host %d has %d of %d bytes" % (self.name, host, t.get("bytes", 0), size_bytes))
        mbit = min(t["gbit"] for t in (reported if self.counts_late else reported[1:])) * 1000
        return StreamResult(mbit, reported[0].get("cpu_s_per_GB"), sum(t["cpu_s_per_GB"] for t in reported[1:]) / receivers)


class Norm(OwnProgram):
    counts_late = True
    may_miss_bytes = 64 * 1400 # a receiver may miss the start of the stream: one block at most

    def sender_words(self, rig, receivers, size_bytes, wire_mbit):
        # Without congestion control, at the rate of the payload. Parity costs more than it gains here.
        return ["n=%d" % receivers, "bytes=%d" % size_bytes, "rate=%g" % (wire_mbit or 4000), "par=0", "if=eth0"]

    def receiver_words(self, rig, host, size_bytes):
        return ["id=%d" % host, "bytes=%d" % size_bytes, "if=eth0"]

    def messages(self, rig, receivers, message_bytes, count):
        hosts = [rig.start(host, [self.harness.path, "recv", "id=%d" % host, "bytes=1", "if=eth0"]) for host in range(1, receivers + 1)]
        wait_all(hosts, JOIN_SECONDS)
        sender = rig.start(0, [self.harness.path, "send", "n=%d" % receivers, "msg=%d" % message_bytes, "count=%d" % count, "rate=180", "par=0", "if=eth0"])
        try:
            reported = numbers_of(finish(self.name, [sender], 8)[0].output)
        finally:
            rig.end_programs()
        return {"p50": reported["p50us"], "p99": reported["p99us"]}


class Program:
    """An existing program, in place of a built Harness."""

    def __init__(self, path):
        self.path = os.path.abspath(path)
        self.missing = "" if os.access(self.path, os.X_OK) else "%s is no program" % self.path


class OtherProgram(OwnProgram):
    """A peer that the user provides. Its program receives all parameters in the syntax of netlab's harnesses."""

    def __init__(self, name, path):
        super().__init__(name, Program(path), "it where --peer says")

    def sender_words(self, rig, receivers, size_bytes, wire_mbit):
        return ["n=%d" % receivers, "bytes=%d" % size_bytes, "rate=%g" % (wire_mbit or 4000), "ip=" + rig.address(0), "if=eth0"]

    def receiver_words(self, rig, host, size_bytes):
        return ["id=%d" % host, "bytes=%d" % size_bytes, "ip=" + rig.address(host), "server=" + rig.address(0), "if=eth0"]


class Pgm(OwnProgram):
    def sender_words(self, rig, receivers, size_bytes, wire_mbit):
        return ["bytes=%d" % size_bytes, "rate=%g" % (wire_mbit or 4000), "ip=" + rig.address(0)]

    def receiver_words(self, rig, host, size_bytes):
        return ["bytes=%d" % size_bytes, "ip=" + rig.address(host)]


class Tcp(OwnProgram):
    joins = False

    def sender_words(self, rig, receivers, size_bytes, wire_mbit):
        return ["n=%d" % receivers, "bytes=%d" % size_bytes]

    def receiver_words(self, rig, host, size_bytes):
        return ["bytes=%d" % size_bytes, "server=" + rig.address(0)]

    def messages(self, rig, receivers, message_bytes, count):
        sender = rig.start(0, [self.harness.path, "send", "n=%d" % receivers, "msg=%d" % message_bytes, "count=%d" % count])
        hosts = [rig.start(host, [self.harness.path, "recv", "msg=%d" % message_bytes, "server=" + rig.address(0)]) for host in range(1, receivers + 1)]
        reported = numbers_of(finish(self.name, [sender] + hosts, 40)[0].output)
        return {"p50": reported["p50us"], "p99": reported["p99us"]}


class Files:
    """Common parts of the file senders: a file of the requested size, and a folder for copies."""

    def __init__(self, folder, name, program, package):
        self.name, self.package = name, package
        self.folder = os.path.join(folder, program)
        os.makedirs(self.folder, exist_ok=True)
        self.missing = "" if shutil.which(program) else "not installed"
        self.share = lambda receivers: 1.0

    def file_of(self, size_bytes):
        path = os.path.join(self.folder, "sent-%d" % size_bytes)
        if not os.path.exists(path):
            with open(path, "wb") as file:
                file.truncate(size_bytes)
        return path


class Uftp(Files):
    def __init__(self, folder):
        super().__init__(folder, "UFTP", "uftp", "uftp")

    def stream(self, rig, receivers, size_bytes, wire_mbit):
        path = self.file_of(size_bytes)
        hosts, ids = [], []
        for host in range(1, receivers + 1):
            into = os.path.join(self.folder, "host-%d" % host)
            shutil.rmtree(into, ignore_errors=True) # removes the files of an earlier run
            os.makedirs(into)
            hosts.append(rig.start(host, ["uftpd", "-d", "-I", "eth0", "-D", into, "-B", "4194304"]))
            ids.append("0x" + "".join("%02X" % int(part) for part in rig.address(host).split(".")))
        wait_all(hosts, 0.4)
        rate = str(round(wire_mbit * 1000)) if wire_mbit else "-1"
        try:
            done = finish(self.name, [rig.start(0, ["uftp", "-R", rate, "-I", "eth0", "-B", "4194304", "-b", "1400", "-H", ",".join(ids), path])])[0]
        finally:
            ended = [host.end() for host in hosts]
        kept = re.search(r"Total elapsed time: ([0-9.]+) s", done.output + done.wrong)
        whole = [os.path.getsize(os.path.join(self.folder, "host-%d" % h, os.path.basename(path))) for h in range(1, receivers + 1)
                 if os.path.exists(os.path.join(self.folder, "host-%d" % h, os.path.basename(path)))]
        if not kept or whole != [size_bytes] * receivers:
            raise StreamFailed("UFTP: not all receivers have the file")
        gigabytes = size_bytes * 1e-9
        return StreamResult(size_bytes * 8e-6 / max(0.001, float(kept.group(1))), done.cpu_seconds / gigabytes,
                            sum(e.cpu_seconds for e in ended) / receivers / gigabytes)


class Udpcast(Files):
    def __init__(self, folder):
        super().__init__(folder, "udpcast", "udp-sender", "udpcast")

    def stream(self, rig, receivers, size_bytes, wire_mbit):
        path = self.file_of(size_bytes)
        common = ["--nokbd", "--interface", "eth0", "--mcast-rdv-address", "239.1.1.3"]
        hosts = [rig.start(host, ["udp-receiver", "--file", "/dev/null"] + common) for host in range(1, receivers + 1)]
        wait_all(hosts, JOIN_SECONDS)
        pace = ["--max-bitrate", "%dk" % round(wire_mbit * 1000)] if wire_mbit else []
        sender = rig.start(0, ["udp-sender", "--file", path, "--min-receivers", str(receivers), "--full-duplex"] + pace + common)
        done = finish(self.name, [sender] + hosts, 15)
        rates = []
        for finished in done[1:]:
            found = re.findall(r"\(\s*([0-9.]+) ([KMG]?)bps\)", finished.output + finished.wrong)
            if not found:
                raise StreamFailed("udpcast: a receiver tells no rate")
            rates.append(float(found[-1][0]) * {"": 1e-6, "K": 1e-3, "M": 1.0, "G": 1e3}[found[-1][1]])
        gigabytes = size_bytes * 1e-9
        return StreamResult(min(rates), done[0].cpu_seconds / gigabytes, sum(d.cpu_seconds for d in done[1:]) / receivers / gigabytes)


def all_peers(netlab_folder, folder, others=()):
    """Returns all peers; those with an empty `missing` can run. others: (name, path) of existing programs."""
    sources = os.path.join(netlab_folder, "peers")

    def harness(name, *flags):
        return Harness(folder, name, os.path.join(sources, name + ".cpp"), flags)
    return [Norm("NORM", harness("normpeer", "-lnorm"), "libnorm-dev"),
            Pgm("OpenPGM", harness("pgmpeer", "-I/usr/include/pgm-5.3", "-lpgm"), "libpgm-dev"),
            Tcp("TCP", harness("tcpfan"), "g++", lambda receivers: 1.0 / receivers),
            Uftp(folder), Udpcast(folder)] + [OtherProgram(name, path) for name, path in others]
