"""Prints the numbers of benches as tables."""

import statistics


def median_of(reports, value):
    return statistics.median(value(report) for report in reports)


def _per_frame_ms(report, seconds):
    return 1000.0 * seconds / report["frames"] if report["frames"] else 0.0


def _cpu_ms(report, role, column=0):
    return _per_frame_ms(report, report["cpu"].get(role, (0.0, 0.0))[column])


def _slowest_node_ms(report, field):
    """Returns the time per frame of the slowest node; None if the head does not report it."""
    values = [node[field] for node in report.get("nodes", []) if field in node]
    return _per_frame_ms(report, max(values)) if values else None


def table(title, heads, rows):
    print("\n" + title)
    widths = [max(len(row[i]) for row in [heads] + rows) for i in range(len(heads))]
    for row in [heads] + rows:
        cells = [row[0].ljust(widths[0]), row[1].ljust(widths[1])] + [cell.rjust(width) for cell, width in zip(row[2:], widths[2:])]
        print("  ".join(cells).rstrip())


def _rate_rows(results):
    rows = []
    for measured in results:
        native = measured["walls"]["native"]
        for wall, reports in measured["walls"].items():
            rates = [report["framesPerSecond"] for report in reports]
            ratios = [mine["framesPerSecond"] / others["framesPerSecond"] for mine, others in zip(reports, native) if others["framesPerSecond"] > 0]
            size = "" if wall == "native" else "%.0f" % median_of(reports, lambda r: r["bytesPerFrame"])
            rows.append([measured["program"], wall, "%.1f" % statistics.median(rates), "%.1f to %.1f" % (min(rates), max(rates)),
                         "" if wall == "native" or not ratios else "%.2f" % statistics.median(ratios), size])
    return rows


def _time_rows(results):
    rows = []
    for measured in results:
        for wall, reports in measured["walls"].items():
            def cell(value):
                known = [v for v in map(value, reports) if v is not None]
                return "%.2f" % statistics.median(known) if known else ""
            row = [measured["program"], wall, cell(lambda r: _per_frame_ms(r, r["seconds"])),
                   cell(lambda r: _cpu_ms(r, "app", 1)), cell(lambda r: _cpu_ms(r, "app"))]
            if wall == "native":
                row += [""] * 5
            else:
                row += [cell(lambda r: _per_frame_ms(r, r["waitSeconds"])), cell(lambda r: _cpu_ms(r, "head")),
                        cell(lambda r: _cpu_ms(r, "node")), cell(lambda r: _slowest_node_ms(r, "replaySeconds")),
                        cell(lambda r: _slowest_node_ms(r, "readbackSeconds"))]
            rows.append(row)
    return rows


def _pixel_line(measured):
    verify = measured["verify"]
    return [measured["program"], "2x2", "%d" % verify.get("verifiedFrames", 0), "%d" % verify.get("verifiedPixels", 0),
            "%d" % verify.get("differingPixels", 0)]


def show(results, calls, cores):
    print("%d cores; medians; walls: tiles drawn by as many nodes (at most 4), all on this machine" % cores)
    if results:
        table("frames per second; bytes to each node, what the program sends at its start shared out over the frames", ["program", "wall", "frames/s", "range", "of native", "bytes/frame"], _rate_rows(results))
        table("ms per frame (CPU: app and head whole processes, nodes their sum; replay and readback: the replay thread's CPU in the node that needs most)",
                     ["program", "wall", "elapsed", "app main thread CPU", "app CPU", "app blocked", "head CPU", "nodes CPU", "replay", "readback"],
                     _time_rows(results))
        table("pixels against native", ["program", "wall", "frames", "compared", "differ"], [_pixel_line(m) for m in results])
    if calls:
        show_calls(calls)


def show_calls(calls):
    rows = [[c["name"], "%.0f B" % c["bytes"], "%.1f" % c["nativeNs"], "%.1f" % c["muralNs"], "%+.1f" % c["overNs"], "%.1f" % c["copyNs"],
             "%.1f" % (c["overNs"] / c["copyNs"]) if c["copyNs"] > 0 else ""] for c in calls]
    table("ns of the app's thread per call (CPU time)", ["call", "size", "direct", "mural", "over a direct call", "copy of as many bytes", "over / copy"], rows)


def show_sweep(sweep):
    """Prints a sweep: [(steps per frame, rows of measure_calls)]."""
    rows = []
    for index, call in enumerate(sweep[0][1]):
        rows.append([call["name"], "%.0f B" % call["bytes"]] + ["%+.1f" % calls[index]["overNs"] for _, calls in sweep])
    table("ns over a direct call, by how often the call is made in a frame", ["call", "size"] + ["%d" % steps for steps, _ in sweep], rows)
