"""Measures RSP, raw multicast and the peers: rates, losses, repairs and CPU time."""

from benchlib.bench_tables import table
from benchlib.multicast_peers import UDP_HEAD_BYTES, WIRE_BYTES
from benchlib.netlab_rig import Rig
from benchlib.stream_result import Cell, ratio_text

PACE = 0.95 # fraction of the link's rate, including all headers down to the wire; equal for RSP and raw multicast
LOSS_GOALS = {"0.1%": 0.97, "1%": 0.93, "5%": 0.80}


def size_for(seconds, wire_mbit, mtu=1500):
    """Returns the bytes of payload that take about that time."""
    payload = mtu - UDP_HEAD_BYTES
    return int(seconds * wire_mbit * 125e3 * payload / (payload + WIRE_BYTES))


def met(value, good):
    return "-" if value is None else "yes" if good else "NO"


def mbit_of(rate):
    """"200mbit" → 200.0"""
    return float(rate[:-4]) * {"m": 1, "g": 1000}[rate[-4]]


def fill(bench, cells, runs, what, rounds=None):
    """Calls cells[name].add(runs[name]) in alternation, for the requested number of rounds. Protocols that always
    fail are skipped, because failures take long."""
    rounds = bench.rounds if rounds is None else rounds
    for index in range(rounds):
        for name, run in runs.items():
            if name != "rsp" and cells[name].hopeless():
                cells[name].give_up()
                continue
            bench.say("%s: round %d of %d: %s" % (what, index + 1, rounds, name))
            cells[name].add(run)


def goodput(bench):
    """Measures rates without loss, relative to raw multicast. Raw multicast does not check received bytes, so RSP
    does not check them in these runs either. Runs with losses check all bytes."""
    rows, numbers = [], []
    for link in bench.links:
        for mtu in bench.mtus:
            pace = PACE * mbit_of(link)
            with Rig(bench.netlab, max(bench.receivers) + 1, mtu, link) as rig:
                for receivers in bench.receivers:
                    cells = {"raw": Cell(), "rsp": Cell()}
                    seconds = bench.seconds
                    fill(bench, cells, {
                        "raw": lambda n=receivers: bench.raw.stream(rig, n, seconds, pace),
                        "rsp": lambda n=receivers: bench.rsp.stream(rig, n, size_for(seconds, pace, mtu), pace, seal=bench.seal, checked=False)},
                        "goodput at %s, MTU %d, %d receivers" % (link, mtu, receivers))
                    ratio = cells["rsp"].ratio_to(cells["raw"])
                    rows.append([link, str(mtu), str(receivers), cells["raw"].text(), cells["rsp"].text(), ratio_text(ratio), "0.94", met(ratio, ratio and ratio >= 0.94)])
                    numbers.append({"link": link, "mtu": mtu, "receivers": receivers, "ratio": ratio, **{k: c.as_json() for k, c in cells.items()}})
                    bench.check("goodput at %s, MTU %d, %d receivers" % (link, mtu, receivers), cells["rsp"])
    table("goodput without loss, Mbit/s at the slowest receiver; both paced at %g of the link" % PACE,
          ["link", "MTU", "receivers", "raw", "rsp", "rsp/raw", "goal", "met"], rows)
    return numbers


def _stream_runs(bench, rig, receivers, size_bytes, pace):
    runs = {"rsp": lambda: bench.rsp.stream(rig, receivers, size_bytes, pace, seal=bench.seal)}
    for peer in bench.peers:
        runs[peer.name] = lambda peer=peer: peer.stream(rig, receivers, int(size_bytes * bench.peer_share), pace)
    return runs


def loss(bench):
    """Measures rates with independent losses, and the repairs that they cause, with parity and with plain
    retransmission."""
    link, receivers, losses = "200mbit", bench.many, bench.losses
    pace = PACE * mbit_of(link)
    size = size_for(bench.loss_seconds, pace)
    names = ["rsp", "plain", "raw"] + [peer.name for peer in bench.peers]
    cells = {share: {name: Cell() for name in names} for share in losses}
    with Rig(bench.netlab, receivers + 1, 1500, link) as rig:
        for share in losses:
            rig.loss(share)
            runs = _stream_runs(bench, rig, receivers, size, pace)
            runs["raw"] = lambda: bench.raw.stream(rig, receivers, bench.seconds, pace)
            if share == "5%":
                runs["plain"] = lambda: bench.rsp.stream(rig, receivers, size, pace, seal=bench.seal, parity=False)
            fill(bench, cells[share], runs, "loss of %s, %d receivers" % (share, receivers))
            bench.check("loss of " + share, cells[share]["rsp"])
        rig.loss("0")
    _show_loss(bench, cells, names, losses)
    return {share: {name: cell.as_json() for name, cell in row.items() if cell.results} for share, row in cells.items()}


def _show_loss(bench, cells, names, losses):
    shown = [name for name in names if name != "plain"]
    rows = []
    for share in losses:
        own = [cells[share][name].ratio_to(cells["0"][name]) for name in shown]
        goal = LOSS_GOALS.get(share)
        rows.append([share, str(bench.many)] + [cells[share][name].text() for name in shown] + [ratio_text(o) for o in own] +
                    ([ "%.2f" % goal, met(own[0], own[0] and own[0] >= goal)] if goal else ["", ""]))
    table("goodput at independent losses, 200 Mbit/s, and its share of the same protocol's without loss",
          ["loss", "receivers"] + shown + [name + "/0" for name in shown] + ["goal", "met"], rows)
    with_parity, plain = cells["5%"]["rsp"], cells["5%"]["plain"]
    share = with_parity.ratio_to(plain, "repairs")
    table("repairs at 5 % loss, datagrams", ["", "receivers", "data", "parity and again", "plain, again", "ratio", "goal", "met"],
          [["rsp", str(bench.many), with_parity.text("datagrams"), with_parity.text("repairs"), plain.text("repairs"), ratio_text(share), "0.50",
            met(share, share is not None and share <= 0.5)]])


def unshaped(bench):
    """Measures the maximum rate of this machine, without a limit of the links."""
    rows, numbers = [], []
    for receivers in (1, 4):
        cells = {name: Cell() for name in ["raw", "rsp"] + [peer.name for peer in bench.peers]}
        with Rig(bench.netlab, receivers + 1) as rig:
            runs = _stream_runs(bench, rig, receivers, bench.unshaped_bytes, 0)
            runs = {"raw": lambda n=receivers: bench.raw.stream(rig, n, bench.seconds, 0), **runs}
            fill(bench, cells, runs, "unshaped, %d receivers" % receivers)
        bench.check("unshaped, %d receivers" % receivers, cells["rsp"])
        multicast = [(cells[p.name].median(), p.name) for p in bench.peers if p.name != "TCP" and cells[p.name].median() is not None]
        best = max(multicast) if multicast else None
        own = cells["rsp"].median()
        rows.append(["no limit", str(receivers)] + [cell.text() for cell in cells.values()] +
                    ["ahead of " + best[1] if best else "-", met(best, best and own is not None and own > best[0])])
        numbers.append({"receivers": receivers, **{name: cell.as_json() for name, cell in cells.items()}})
    names = ["raw", "rsp"] + [peer.name for peer in bench.peers]
    table("goodput without a limit, MTU 1500, Mbit/s at the slowest receiver", ["link", "receivers"] + names + ["goal", "met"], rows)
    return numbers


def cpu(bench):
    """Measures the CPU time per GB at 1 Gbit/s. The sender's includes the switch and the receivers' network input, so
    only ratios are meaningful."""
    link, receivers = "1gbit", bench.cpu_receivers
    pace = PACE * mbit_of(link)
    size = size_for(bench.cpu_seconds, pace)
    cells = {"raw, sendto": Cell(), "raw, UDP_SEGMENT": Cell()}
    runs = {}
    if bench.bare_receiver:
        cells["recvmmsg alone, each 4 ms"] = Cell()
    with Rig(bench.netlab, receivers + 1, 1500, link) as rig:
        if bench.bare_receiver:
            runs["recvmmsg alone, each 4 ms"] = lambda: bench.raw.stream(rig, receivers, bench.cpu_seconds, pace, bare_receiver=bench.bare_receiver)
        runs["raw, sendto"] = lambda: bench.raw.stream(rig, receivers, bench.cpu_seconds, pace, "plain", 8)
        runs["raw, UDP_SEGMENT"] = lambda: bench.raw.stream(rig, receivers, bench.cpu_seconds, pace)
        for seal in ("none", "siphash", "aes-256-gcm", "chacha20-poly1305"):
            cells["rsp, " + seal] = Cell()
            runs["rsp, " + seal] = lambda seal=seal: bench.rsp.stream(rig, receivers, size, pace, seal=seal, checked=False)
        cells["rsp, none, each byte compared"] = Cell()
        runs["rsp, none, each byte compared"] = lambda: bench.rsp.stream(rig, receivers, size, pace)
        for peer in bench.peers:
            cells[peer.name] = Cell()
            runs[peer.name] = lambda peer=peer: peer.stream(rig, receivers, size, pace)
        fill(bench, cells, runs, "CPU at 1 Gbit/s, %d receivers" % receivers)
        # These numbers vary most between runs, so the two with a goal are measured more often.
        judged = {name: runs[name] for name in ("raw, UDP_SEGMENT", "rsp, none")}
        fill(bench, cells, judged, "CPU at 1 Gbit/s, %d receivers, those that are judged" % receivers, (bench.judged_times - 1) * bench.rounds)
    raw = cells["raw, UDP_SEGMENT"] # sends in batches as RSP does
    rows = []
    for name, cell in cells.items():
        sender, receiver = cell.ratio_to(raw, "sender_cpu"), cell.ratio_to(raw, "receiver_cpu")
        judged = name == "rsp, none"
        good = judged and sender is not None and sender <= 1.0 and receiver <= 0.8
        rows.append([name, str(receivers), cell.text(), cell.text("sender_cpu", "%.2f"), ratio_text(sender), cell.text("receiver_cpu", "%.2f"),
                     ratio_text(receiver), "1.00, 0.80" if judged else "", met(sender, good) if judged else ""])
        if name.startswith("rsp"):
            bench.check("CPU at 1 Gbit/s, " + name, cell)
    table("CPU, s per GB, at 1 Gbit/s; what is judged by %d rounds" % len(raw.results), ["", "receivers", "Mbit/s", "sender", "of raw, UDP_SEGMENT", "receiver", "of raw, UDP_SEGMENT", "goal", "met"], rows)
    return {name: cell.as_json() for name, cell in cells.items()}
