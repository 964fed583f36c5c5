"""Compares the receivers of two builds in one group. Both receivers of a pair have the same sender at the same time,
so noise of the machine affects both."""

import statistics

from benchlib.bench_tables import table
from benchlib.netlab_rig import Rig
from benchlib.rsp_runs import check_whole
from benchlib.stream_result import StreamFailed, ratio_text
from benchlib.stream_tables import PACE, mbit_of, size_for

LINK, RECEIVERS = "1gbit", 4


def _run(bench, rig, programs, size_bytes, pace):
    """Returns the CPU seconds per GB of each receiver. The sender is of the measured build."""
    group = bench.rsp.group(rig, RECEIVERS, ["--bytes", str(size_bytes), "--rate", "%dkbit" % round(pace * 1000)], checked=False, receiver_programs=programs)
    sent, received = group.end()
    check_whole(sent, received, size_bytes)
    return [r["cpuSecondsPerGB"] for r in received]


def builds(bench):
    """Prints the table "builds": the receivers' CPU time next to that of --against."""
    new, old = bench.rsp.mural, bench.against
    pace = PACE * mbit_of(LINK)
    size = size_for(bench.seconds, pace)
    pairs = []
    with Rig(bench.netlab, RECEIVERS + 1, 1500, LINK) as rig:
        for index in range(bench.rounds):
            bench.say("receivers of two builds: round %d of %d" % (index + 1, bench.rounds))
            sides = [(index + host) % 2 for host in range(RECEIVERS)] # 0: this build
            try:
                cpu = _run(bench, rig, [(new, old)[side] for side in sides], size, pace)
            except StreamFailed as failure:
                bench.problem("receivers of two builds: %s" % failure)
                continue
            pairs.append([statistics.mean(c for c, s in zip(cpu, sides) if s == side) for side in (0, 1)])
    ratio = statistics.median(a / b for a, b in pairs) if pairs else None
    columns = [statistics.median(column) for column in zip(*pairs)]
    table("CPU of receivers of two builds in one group, s per GB, at 1 Gbit/s", ["receivers", "this build", "--against", "ratio"],
          [[str(RECEIVERS)] + (["%.3f" % value for value in columns] or ["-", "-"]) + [ratio_text(ratio, "%.3f")]])
    return {"pairs": pairs, "ratio": ratio}
