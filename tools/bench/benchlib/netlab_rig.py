"""A cluster of network namespaces on this machine, created by the program netlab, and programs on its hosts."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from signal import SIGCONT, SIGKILL, SIGTERM

SKIPPED = 77 # exit status: the bench can't run on this machine
INSIDE = "MURAL_BENCH_INSIDE"
SETTLE_SECONDS = 1.2 # time for the bridge to learn the group members
# Disables the packet filter of bridges, which a hardware switch does not have. With br_netfilter in the kernel, Linux'
# bridge calls it for each frame. That takes a third of all CPU time of a multicast. Debian has br_netfilter as a module
# that nothing loads here.
PLAIN_SWITCH = "for f in /proc/sys/net/bridge/bridge-nf-call-*tables; do [ ! -e $f ] || echo 0 > $f || exit 1; done"


class RigFailed(Exception):
    pass


class Finished:
    """An ended program: its output, and the CPU seconds that it used."""

    def __init__(self, status, output, wrong, cpu_seconds):
        self.status, self.output, self.wrong, self.cpu_seconds = status, output, wrong, cpu_seconds


class Program:
    """A running program on a host. Its output goes into files, so it never waits for a reader."""

    def __init__(self, words):
        self.words = words
        self._out, self._err = tempfile.TemporaryFile(), tempfile.TemporaryFile()
        self._process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=self._out, stderr=self._err)
        self.pid = self._process.pid
        self.finished = None

    def output_so_far(self):
        size = os.fstat(self._err.fileno()).st_size
        return os.pread(self._err.fileno(), size, 0).decode(errors="replace")

    def poll(self):
        """Returns Finished, or None while the program runs."""
        if self.finished is None:
            pid, status, usage = os.wait4(self.pid, os.WNOHANG)
            if pid:
                self._process.returncode = os.waitstatus_to_exitcode(status)
                texts = []
                for file in (self._out, self._err):
                    file.seek(0)
                    texts.append(file.read().decode(errors="replace"))
                    file.close()
                self.finished = Finished(self._process.returncode, texts[0], texts[1], usage.ru_utime + usage.ru_stime)
        return self.finished

    def wait(self, seconds):
        """Returns Finished, or None if the program still runs after that time."""
        until = time.monotonic() + seconds
        while self.poll() is None and time.monotonic() < until:
            time.sleep(0.005)
        return self.finished

    def signal(self, number):
        if self.poll() is None:
            os.kill(self.pid, number)

    def end(self):
        """Ends the program, at last with SIGKILL."""
        self.signal(SIGCONT) # a stopped process can't end
        self.signal(SIGTERM)
        if not self.wait(2):
            self.signal(SIGKILL)
            self.wait(5)
        return self.finished


def find_netlab(folder, tool):
    """Returns the absolute path of the program netlab. If netlab is not usable, prints one line and ends the tool as
    skipped."""
    path = os.path.join(folder, "netlab") if folder else ""
    if not os.path.isfile(path):
        _skip(tool, "there is no netlab %s; tell its folder by --netlab DIR or MURAL_NETLAB" % ("at " + path if path else "yet"))
    missing = [(program, package) for program, package in
               (("ip", "iproute2"), ("nft", "nftables"), ("ethtool", "ethtool"), ("unshare", "util-linux")) if not shutil.which(program)]
    if missing:
        _skip(tool, "%s missing; install: %s" % (", ".join(m[0] for m in missing), " ".join(m[1] for m in missing)))
    return os.path.abspath(path)


def _skip(tool, why):
    print("%s: skipped: %s" % (tool, why), file=sys.stderr)
    sys.exit(SKIPPED)


def go_inside(tool):
    """Restarts this program in its own network and mount namespaces. Everything in them is invisible outside and ends
    with the program."""
    if os.environ.get(INSIDE) == "1":
        return
    unshare = ["unshare", "-nm"] if os.geteuid() == 0 else ["unshare", "-Urnm"]
    script = "mount -t tmpfs none /run && exec \"$@\""
    tried = subprocess.run(unshare + ["sh", "-c", script, "sh", "true"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    if tried.returncode != 0:
        output = tried.stderr.decode(errors="replace").strip()
        _skip(tool, "namespaces cannot be made here: %s; run it as root, or allow user namespaces (sysctl kernel.unprivileged_userns_clone)" % output)
    os.environ[INSIDE] = "1"
    words = unshare + ["sh", "-c", script, "sh", sys.executable] + sys.argv
    os.execvp(words[0], words)


class Rig:
    """`with Rig(netlab, hosts, mtu, rate) as rig:` host 0 sends, the others receive."""

    def __init__(self, netlab, hosts, mtu=1500, rate=None):
        self.netlab, self.hosts, self.mtu, self.rate = netlab, hosts, mtu, rate
        self.name = "b%d" % os.getpid()
        self._loss = "0"
        self._programs = []

    def __enter__(self):
        words = ["up", self.name, "-n", str(self.hosts), "-m", str(self.mtu)]
        self._netlab(words + (["-r", self.rate] if self.rate else []))
        plain = subprocess.run(["ip", "netns", "exec", self.name + "-sw", "sh", "-c", PLAIN_SWITCH], stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=60, check=False)
        if plain.returncode != 0:
            print("netlab: the switch asks the packet filter for each frame, which costs CPU: %s" % plain.stderr.decode(errors="replace").strip(), file=sys.stderr)
        time.sleep(SETTLE_SECONDS)
        return self

    def __exit__(self, *_):
        self.end_programs()
        self._netlab(["down", self.name])

    def _netlab(self, words):
        done = subprocess.run([self.netlab] + words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)
        if done.returncode != 0:
            raise RigFailed("netlab %s: %s" % (" ".join(words), done.stderr.decode(errors="replace").strip()))

    def loss(self, share):
        """Sets the share of packets, such as "5%", that each host loses independently."""
        if share != self._loss:
            self._netlab(["loss", self.name, "all", share])
            self._loss = share

    def fault(self, host, *kind):
        self._netlab(["fault", self.name, str(host)] + list(kind))

    @staticmethod
    def address(host):
        return "10.77.0.%d" % (host + 1)

    def start(self, host, words):
        program = Program([self.netlab, "run", self.name, str(host)] + words)
        self._programs.append(program)
        return program

    def end_programs(self):
        for program in self._programs:
            if program.poll() is None:
                program.end()
        self._programs = []


def wait_all(programs, seconds):
    """Returns [Finished], with None for a program that did not end in time."""
    until = time.monotonic() + seconds
    return [program.wait(max(0.0, until - time.monotonic())) for program in programs]


def numbers_of(text):
    """Parses "recv bytes=5 gbit=0.1" into {"bytes": 5.0, "gbit": 0.1}."""
    return {name: float(value) for name, value in re.findall(r"(\w+)=([0-9.eE+-]+)", text)}
