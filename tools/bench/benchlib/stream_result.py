"""The result of one run of one protocol."""

import statistics


class StreamFailed(Exception):
    """A run in which a protocol failed; the text has the reason."""


class StreamResult:
    """mbit: payload rate at the slowest receiver. CPU in seconds per GB of payload. repairs: datagrams in addition to
    the first transmissions."""

    def __init__(self, mbit, sender_cpu=None, receiver_cpu=None, repairs=None, datagrams=None):
        self.mbit, self.sender_cpu, self.receiver_cpu = mbit, sender_cpu, receiver_cpu
        self.repairs, self.datagrams = repairs, datagrams


class Cell:
    """The runs of one protocol under one set of conditions: results and failures, by round."""

    def __init__(self):
        self.results = []
        self.failures = []

    def add(self, run):
        """Calls run() and stores its result or its failure."""
        try:
            self.results.append(run())
        except StreamFailed as failure:
            self.results.append(None)
            self.failures.append(str(failure))

    def hopeless(self):
        return len(self.failures) >= 2 and not self.known()

    def give_up(self):
        self.results.append(None)
        self.failures.append("given up after the failures before")

    def known(self, field="mbit"):
        return [getattr(r, field) for r in self.results if r is not None and getattr(r, field) is not None]

    def median(self, field="mbit"):
        values = self.known(field)
        return statistics.median(values) if values else None

    def ratio_to(self, other, field="mbit"):
        """Returns the median of the rounds' ratios. Both runs of a round followed each other."""
        pairs = [(getattr(a, field), getattr(b, field)) for a, b in zip(self.results, other.results) if a is not None and b is not None]
        ratios = [a / b for a, b in pairs if a is not None and b]
        return statistics.median(ratios) if ratios else None

    def text(self, field="mbit", form="%.0f"):
        failed = " (fail %d/%d)" % (len(self.failures), len(self.results)) if self.failures else ""
        value = self.median(field)
        return ("-" if value is None else form % value) + failed

    def as_json(self):
        return {"runs": [None if r is None else vars(r) for r in self.results], "failures": self.failures}


def ratio_text(value, form="%.2f"):
    return "-" if value is None else form % value
