"""CPU time of every process of a run, sampled from /proc during the run."""

import os
import threading
import time

TICK_SECONDS = 1.0 / os.sysconf("SC_CLK_TCK")


def _read(path):
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return b""


def _fields(stat):
    """Returns the fields of a stat file after the process's name, which may contain any character."""
    return stat[stat.rfind(b")") + 2:].split()


def descendants(root):
    """Returns pid → fields of the stat file, for the descendants of root."""
    children, stats = {}, {}
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        fields = _fields(_read("/proc/%s/stat" % entry))
        if len(fields) > 12:
            stats[int(entry)] = fields
            children.setdefault(int(fields[1]), []).append(int(entry))
    found, ahead = {}, list(children.get(root, []))
    while ahead:
        pid = ahead.pop()
        found[pid] = stats[pid]
        ahead += children.get(pid, [])
    return found


class CpuTimes:
    """`with CpuTimes(pid, role_of):` samples the descendants of pid. role_of(command line words) returns the role of
    one."""

    INTERVAL_SECONDS = 0.05

    def __init__(self, root, role_of):
        self.root = root
        self.role_of = role_of
        self.roles = {}    # pid → role
        self.samples = {}  # pid → [(moment, process seconds, first thread's seconds)]
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._sample_until_stopped, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()

    def _sample_until_stopped(self):
        while not self._stop.is_set():
            self._sample()
            self._stop.wait(self.INTERVAL_SECONDS)

    def _sample(self):
        moment = time.monotonic()
        for pid, fields in descendants(self.root).items():
            if fields[0] == b"Z":
                continue
            words = _read("/proc/%d/cmdline" % pid).split(b"\0")[:-1]
            if words:  # a process may become another program by exec
                self.roles[pid] = self.role_of([word.decode(errors="replace") for word in words])
            thread = _fields(_read("/proc/%d/task/%d/stat" % (pid, pid)))
            seconds = (int(fields[11]) + int(fields[12])) * TICK_SECONDS
            first = (int(thread[11]) + int(thread[12])) * TICK_SECONDS if len(thread) > 12 else 0.0
            self.samples.setdefault(pid, []).append((moment, seconds, first))

    def of_last(self, window_seconds, frame_role):
        """Returns role → (seconds, first threads' seconds) in the window that ends with frame_role's last sample.

        Programs end with their last frame, so this window is the time from the first frame to the last.
        """
        ends = [rows[-1][0] for pid, rows in self.samples.items() if self.roles.get(pid) == frame_role]
        if not ends:
            return {}
        end = max(ends)
        totals = {}
        for pid, rows in self.samples.items():
            role = self.roles.get(pid)
            if role is None:
                continue
            parts = [max(0.0, _at(rows, end, column) - _at(rows, end - window_seconds, column)) for column in (1, 2)]
            before = totals.get(role, (0.0, 0.0))
            totals[role] = (before[0] + parts[0], before[1] + parts[1])
        return totals


def _at(rows, moment, column):
    """Returns the value at a moment, interpolated between two samples."""
    if moment <= rows[0][0]:
        return rows[0][column]
    for (t0, *a), (t1, *b) in zip(rows, rows[1:]):
        if moment <= t1:
            share = (moment - t0) / (t1 - t0) if t1 > t0 else 1.0
            return a[column - 1] + share * (b[column - 1] - a[column - 1])
    return rows[-1][column]
