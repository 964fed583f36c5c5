"""Timelines of `mural stat --trace`: their threads and spans, checks, and the critical path of each frame."""

import bisect
import collections
import json

SLACK_US = 0.002  # rounding of the trace's times

Span = collections.namedtuple("Span", "begin end name is_wait frame")


class Thread:
    """The spans of one thread, in order."""

    def __init__(self, process, name):
        self.process, self.name, self.spans, self.begins = process, name, [], []

    def sort(self):
        self.spans.sort()
        self.begins = [span.begin for span in self.spans]

    def before(self, time, works=False):
        """Returns the last span that begins before this time; with `works` the last one that is no wait."""
        index = bisect.bisect_left(self.begins, time) - 1
        while works and index >= 0 and self.spans[index].is_wait:
            index -= 1
        return self.spans[index] if index >= 0 else None

    def of_frame(self, frame):
        return [span for span in self.spans if span.frame == frame]


class Trace:
    """The trace of a session with one program. Times in us."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            self.json = json.load(file)
        processes, threads = {}, {}
        for event in self.json["traceEvents"]:
            if event["ph"] == "M" and event["name"] == "process_name":
                processes[event["pid"]] = event["args"]["name"]
            if event["ph"] == "M" and event["name"] == "thread_name":
                threads[event["pid"], event["tid"]] = event["args"]["name"]
        self.threads = {}
        self.done = {}  # frame: time
        for event in self.json["traceEvents"]:
            if event["ph"] == "X":
                key = processes[event["pid"]], threads[event["pid"], event["tid"]]
                thread = self.threads.setdefault(key, Thread(*key))
                thread.spans.append(Span(event["ts"], event["ts"] + event["dur"], event["name"], event["cat"] == "wait", event["args"]["frame"]))
            elif event["ph"] == "i" and event["name"] == "frame done":
                self.done[event["args"]["frame"]] = event["ts"]
        for thread in self.threads.values():
            thread.sort()

    def thread(self, process, name):
        return self.threads.get((process, name))

    def nodes(self):
        return sorted(int(process.split()[1]) for process, name in self.threads if name == "replay")

    def named(self, beginning):
        """Returns the threads of the head whose names begin with this text."""
        return [thread for (process, name), thread in self.threads.items() if process == "head" and name.startswith(beginning)]

    def clock_error(self):
        """Returns the largest error of a node's clock, in us."""
        return max((clock["errorNs"] / 1000 for clock in self.json["otherData"]["clocks"]), default=0.0)

    def program(self):
        return next((thread for (process, _), thread in self.threads.items() if process.startswith("program")), None)


def faults(trace, wanted_nodes):
    """Returns the faults of a trace: frames without a node's spans, spans that overlap, spans outside of their frame."""
    found = []
    if trace.nodes() != list(range(wanted_nodes)):
        found.append("spans of nodes %s" % trace.nodes())
    for (process, name), thread in sorted(trace.threads.items()):
        for first, second in zip(thread.spans, thread.spans[1:]):
            if second.begin < first.end - SLACK_US:
                found.append("%s, %s: \"%s\" of frame %d overlaps \"%s\"" % (process, name, first.name, first.frame, second.name))
            if second.frame < first.frame:
                found.append("%s, %s: frame %d follows frame %d" % (process, name, second.frame, first.frame))
    for node in trace.nodes():
        for name in ("replay", "pictures"):
            thread = trace.thread("node %d" % node, name)
            if thread is None and name == "pictures":
                continue
            ends, works = {}, set()
            for span in thread.spans:
                ends[span.frame] = span.end
                works.update([] if span.is_wait else [span.frame])
            for frame, done in sorted(trace.done.items()):
                if frame not in works:
                    found.append("node %d, %s: no work for frame %d" % (node, name, frame))
                elif ends[frame] > done + SLACK_US + trace.clock_error():
                    found.append("node %d, %s: ends frame %d %.0f us after the frame" % (node, name, frame, ends[frame] - done))
                elif frame - 1 in ends and ends[frame] < ends[frame - 1]:
                    found.append("node %d, %s: ends frame %d before frame %d" % (node, name, frame, frame - 1))
    return found + late_nodes(trace)


def late_nodes(trace):
    """Returns the frames that a node has ended before the head began to send them."""
    found = []
    for stream in trace.named("stream"):
        begins = {}
        for span in stream.spans:
            if span.name == "send":
                begins.setdefault(span.frame, span.begin)
        for node in trace.nodes():
            for frame, begin in begins.items():
                spans = trace.thread("node %d" % node, "replay").of_frame(frame)
                if spans and spans[-1].end < begin - SLACK_US - trace.clock_error():
                    found.append("node %d ends frame %d before the head sends it" % (node, frame))
    return found


class CriticalPath:
    """Explains the time between the ends of two frames: walks back along the threads that waited for each other."""

    def __init__(self, trace):
        self.trace = trace

    def of_frame(self, frame, begin):
        """Returns ({part: us}, us without an explanation) between this time and the end of the frame."""
        parts, unexplained, time = collections.Counter(), 0.0, self.trace.done[frame]
        thread = self._latest(self.trace.named("reader"), time)
        while thread is not None and time > begin:
            span = thread.before(time)
            if span is None:
                break
            if span.end < time - SLACK_US:
                unexplained += time - max(span.end, begin)
                time = span.end
                continue
            cause = self._cause(thread, span, time) if span.is_wait else None
            work = cause.before(time, works=True) if cause is not None else None
            if work is not None and work.end > span.begin:
                unexplained += max(0.0, time - max(work.end, begin))
                time, thread = min(time, work.end), cause
                continue
            if cause is not None:
                unexplained += time - max(span.begin, begin)
            else:
                parts["%s: %s" % (thread.process.split()[0], span.name)] += time - max(span.begin, begin)
            time = span.begin
        return parts, unexplained + max(0.0, time - begin)

    @staticmethod
    def _latest(threads, time):
        """Returns the thread with the latest work before this time."""
        def ends(thread):
            span = thread.before(time, works=True)
            return min(span.end, time) if span else float("-inf")
        return max(threads, key=ends, default=None)

    def _cause(self, thread, span, time):
        """Returns the thread that this thread waits for. None: none of the trace; the wait counts under its own name."""
        trace, wait, process = self.trace, span.name[len("wait: "):], thread.process
        if wait == "node":
            node = "node " + thread.name.split()[-1]
            return trace.thread(node, "pictures") or trace.thread(node, "replay")
        if wait == "frame":
            return trace.thread(process, "replay")
        if wait == "picture queue":
            return trace.thread(process, "pictures")
        if wait == "packets":
            return self._latest(trace.named("stream"), time)
        if wait == "program":
            return trace.program()
        if wait in ("credit", "picture"):
            return self._latest(trace.named("reader"), time)
        if wait == "output":
            return trace.thread("head", "output")
        if wait == "window":
            return self._latest(trace.named("windows of program"), time)
        return None


def frames_explained(trace):
    """Returns [(frame, interval in us, {part: us}, unexplained us)] for successive frames."""
    path, rows = CriticalPath(trace), []
    order = sorted(trace.done)
    for before, frame in zip(order, order[1:]):
        begin = trace.done[before]
        if trace.done[frame] > begin:
            parts, unexplained = path.of_frame(frame, begin)
            rows.append((frame, trace.done[frame] - begin, parts, unexplained))
    return rows
