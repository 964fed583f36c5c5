"""Measures delays: acknowledged messages, frames during a background stream, joins, and the effect of a frozen,
killed or disconnected receiver on the others."""

import signal
import statistics
import time

from benchlib.bench_tables import table
from benchlib.netlab_rig import Rig
from benchlib.stream_result import StreamFailed
from benchlib.stream_tables import PACE, met, size_for

LINK, LINK_MBIT = "200mbit", 200.0
FAULT_AT_SECONDS = 1.0 # after the start of the stream
FROZEN_SECONDS = 1.0
AVERAGED_SECONDS = 0.05 # averaging time of a rate
FULL_RATE = 0.9 # fraction of the previous rate
BEGINS_SECONDS = 0.4 # a later pause has other causes: the window is used up within this time


def _median(values):
    known = [v for v in values if v is not None]
    return statistics.median(known) if known else None


def _cell(values, form="%.0f"):
    failed = values.count(None)
    middle = _median(values)
    return ("-" if middle is None else form % middle) + (" (fail %d/%d)" % (failed, len(values)) if failed else "")


def _attempt(bench, what, run, essential=True):
    """Returns the result of run(). After a failure reports it and returns None."""
    try:
        return run()
    except StreamFailed as failure:
        if essential:
            bench.problem("%s: %s" % (what, failure))
        else:
            bench.say("%s: %s" % (what, failure))
        return None


def latency(bench):
    """Measures the time until the sender knows that all receivers have 64 bytes."""
    receivers, rows, numbers = bench.many, [], {}
    timed = [peer for peer in bench.peers if hasattr(peer, "messages")]
    with Rig(bench.netlab, receivers + 1, 1500, LINK) as rig:
        for share in ("0", "1%"):
            rig.loss(share)
            got = {name: [] for name in ["rsp"] + [peer.name for peer in timed]}
            for index in range(bench.rounds):
                bench.say("acknowledged flush, loss of %s: round %d of %d" % (share, index + 1, bench.rounds))
                got["rsp"].append(_attempt(bench, "acknowledged flush", lambda: bench.rsp.messages(rig, receivers, 64, bench.messages, PACE * LINK_MBIT)))
                for peer in timed:
                    if got[peer.name].count(None) == len(got[peer.name]) >= 2:
                        got[peer.name].append(None) # skips a peer that always fails, because each attempt takes long
                        continue
                    count = bench.messages if peer.name == "TCP" and share == "0" else min(bench.messages, 100 if peer.name == "TCP" else 40)
                    got[peer.name].append(_attempt(bench, "acknowledged flush", lambda: peer.messages(rig, receivers, 64, count), essential=False))
            rig.loss("0")
            tcp = got.get("TCP", [])
            for name, reported in got.items():
                p50, p99 = ([None if t is None else t[key] for t in reported] for key in ("p50", "p99"))
                pairs = [a / b["p50"] for a, b in zip(p50, tcp) if a is not None and b]
                ratio = _median(pairs)
                goal, good = "", ""
                if name == "rsp" and share == "0":
                    goal, good = "p50 1.20 x TCP", met(ratio, ratio and ratio <= 1.2)
                elif name == "rsp":
                    worst = _median(p99)
                    goal, good = "p99 7000", met(worst, worst and worst <= 7000)
                rows.append([name, share, str(receivers), _cell(p50), _cell(p99), "-" if ratio is None else "%.2f" % ratio, goal, good])
            numbers[share] = got
    table("64 bytes until the sender knows that all have them, us", ["", "loss", "receivers", "p50", "p99", "p50/TCP's", "goal", "met"], rows)
    return numbers


def frame(bench):
    """Measures frames of 10 kB, alone and while another group uses half of the link."""
    receivers, rows, numbers = 4, [], {}
    with Rig(bench.netlab, receivers + 1, 1500, LINK) as rig:
        for background in ("none", "100 Mbit/s"):
            reported = []
            for index in range(bench.rounds):
                bench.say("frames, background %s: round %d of %d" % (background, index + 1, bench.rounds))
                reported.append(_attempt(bench, "frames", lambda: _frames(bench, rig, receivers, background != "none")))
            cells = [_cell([None if t is None else t[key] for t in reported]) for key in ("p50", "p90", "p99", "max")]
            rows.append([background, str(receivers)] + cells)
            numbers[background] = reported
    table("a frame of 10 kB until all have it, us, 200 Mbit/s (on the wire alone it takes 430)", ["background", "receivers", "p50", "p90", "p99", "longest"], rows)
    return numbers


def _frames(bench, rig, receivers, busy):
    count = max(50, bench.messages // 2)
    if not busy:
        return bench.rsp.messages(rig, receivers, 10_000, count, PACE * LINK_MBIT)
    other = bench.rsp.group(rig, receivers, ["--bytes", str(10 * 1000 ** 3), "--rate", "100mbit"], place=1)
    try:
        wait_until_all_flow(other)
        reported = bench.rsp.messages(rig, receivers, 10_000, count, PACE * LINK_MBIT - 100)
        if any(program.poll() is not None for program in [other.sender] + other.receivers):
            raise StreamFailed("rsp: the background stream ended too soon")
        return reported
    finally:
        rig.end_programs()


def wait_until_all_flow(group):
    """Waits one second; joining takes a fraction of that. Raises an error if a process ends meanwhile."""
    until = time.monotonic() + FAULT_AT_SECONDS
    while time.monotonic() < until:
        for program in [group.sender] + group.receivers:
            if program.poll() is not None:
                raise StreamFailed("rsp: %s" % program.poll().wrong.strip().split("\n")[-1])
        time.sleep(0.01)


def join(bench):
    """Measures 16 receivers that join at once."""
    receivers, times = 16, []
    with Rig(bench.netlab, receivers + 1, 1500, LINK) as rig:
        rig.loss("5%")
        for index in range(bench.joins):
            bench.say("joins: try %d of %d" % (index + 1, bench.joins))
            reported = _attempt(bench, "16 joins at 5 % loss", lambda: bench.rsp.group(rig, receivers, ["--bytes", "64k", "--rate", "190mbit"]).end())
            times.append(max(r["join"]["seconds"] for r in reported[1]) if reported else None)
        rig.loss("0")
    known = [t for t in times if t is not None]
    within = sum(t <= 2.0 for t in known)
    table("16 receivers join at once, 5 % loss: seconds until the last is in",
          ["tries", "receivers", "median", "longest", "within 2 s", "goal", "met"],
          [[str(len(times)), str(receivers), _cell(times, "%.2f"), "%.2f" % max(known) if known else "-", "%d of %d" % (within, len(times)), "all",
            met(known, within == len(times))]])
    return times


class Flow:
    """The bytes of a receiver over time, from its report."""

    def __init__(self, reported):
        line = reported["timeline"]
        self.began, self.step, self.bytes = line["beganAt"], line["stepSeconds"], line["bytes"]

    def rate(self, begin, end):
        """Returns bytes per second between two moments."""
        first, last = (round((moment - self.began) / self.step) for moment in (begin, end))
        first, last = max(0, first), min(last, len(self.bytes))
        return sum(self.bytes[first:last]) / ((last - first) * self.step) if last > first else 0.0

    def resumed_after(self, moment):
        """Returns the seconds from a moment until bytes arrive again after the longest pause that begins soon after
        it; 0: no pause."""
        first = max(0, int((moment - self.began) / self.step))
        last = first + int(BEGINS_SECONDS / self.step)
        longest, resumed, began = 1, 0.0, None
        for index in range(first, len(self.bytes)):
            if not self.bytes[index]:
                began = index if began is None else began
            elif began is not None:
                if index - began > longest and began <= last:
                    longest, resumed = index - began, self.began + index * self.step - moment
                began = None
        return resumed

    def full_after(self, moment, wanted, within=2.0):
        """Returns the seconds from a moment until the following rate reaches `wanted`; None: never."""
        at = moment
        while at < moment + within:
            if self.rate(at, at + AVERAGED_SECONDS) >= wanted:
                return at - moment
            at += self.step
        return None


def _faulty_run(bench, rig, receivers, kind):
    """Returns the measured seconds of the slowest healthy receiver. For kind "frozen" this is the time until the full
    rate, otherwise until bytes arrive again."""
    faulty = receivers
    group = bench.rsp.group(rig, receivers, ["--bytes", str(size_for(bench.fault_seconds, PACE * LINK_MBIT)), "--rate", "%dkbit" % (PACE * LINK_MBIT * 1000)])
    wait_until_all_flow(group)
    moment = time.monotonic()
    if kind == "frozen":
        group.receivers[faulty - 1].signal(signal.SIGSTOP)
        time.sleep(FROZEN_SECONDS)
        moment = time.monotonic()
        group.receivers[faulty - 1].signal(signal.SIGCONT)
        sent, received = group.end()
    else:
        if kind == "killed":
            group.receivers[faulty - 1].signal(signal.SIGKILL)
        else:
            rig.fault(faulty, "cut")
        sent, received = _end_without(group, faulty)
        if kind == "cut":
            rig.fault(faulty, "heal")
    flows = [Flow(r) for r in received if r is not None]
    lost = 0 if kind == "frozen" else 1
    if sent["membersLost"] != lost:
        raise StreamFailed("rsp: %d members lost instead of %d" % (sent["membersLost"], lost))
    if kind == "frozen":
        frozen = received[faulty - 1]
        if frozen["socketDropped"]:
            raise StreamFailed("rsp: the frozen receiver's socket dropped %d datagrams" % frozen["socketDropped"])
        wanted = [FULL_RATE * flow.rate(moment - FROZEN_SECONDS - 0.3, moment - FROZEN_SECONDS - 0.05) for flow in flows]
        times = [flow.full_after(moment, rate) for flow, rate in zip(flows, wanted)]
        if None in times:
            raise StreamFailed("rsp: the rate was never full again within 2 s")
        return max(times)
    return max(flow.resumed_after(moment) for flow in flows)


def _end_without(group, faulty):
    try:
        return group.end(without=(faulty,))
    finally:
        group.receivers[faulty - 1].end()


FAULTS = {"frozen": ("frozen 1 s, full rate after it wakes", 0.100), "killed": ("killed, others resume", 0.050), "cut": ("cut off, others resume", 1.2)}


def faults(bench):
    """Measures one faulty receiver of four."""
    receivers, rows, numbers = 4, [], {}
    for kind, (what, goal) in FAULTS.items():
        times = []
        for index in range(bench.rounds):
            bench.say("%s: round %d of %d" % (what, index + 1, bench.rounds))
            with Rig(bench.netlab, receivers + 1, 1500, LINK) as rig:
                times.append(_attempt(bench, what, lambda: _faulty_run(bench, rig, receivers, kind)))
        known = [1000 * t for t in times if t is not None]
        rows.append([what, str(receivers), _cell([None if t is None else 1000 * t for t in times]), "%.0f" % max(known) if known else "-",
                     "%.0f" % (1000 * goal), met(known, known and _median(known) <= 1000 * goal)])
        numbers[kind] = times
    table("one receiver of four, ms (no byte lost, no socket's overflow: else it is a failure)", ["receiver", "receivers", "median", "longest", "goal", "met"], rows)
    return numbers
