"""Length of a test run. tools/check runs short tests: each program, way and division occurs, but not each combination.
tools/check --long sets MURAL_LONG_TESTS=1 and runs all combinations."""

import os

LONG = os.environ.get("MURAL_LONG_TESTS") == "1"


def pairs(first, second):
    """Returns all pairs in a long run. Otherwise it returns each element of both lists at least once."""
    if LONG:
        return [(a, b) for a in first for b in second]
    first, second = list(first), list(second)
    count = max(len(first), len(second))
    return [(first[i % len(first)], second[i % len(second)]) for i in range(count)]


def some(items, step=2):
    """Returns all items in a long run, otherwise every `step`-th of them, beginning with the first."""
    return list(items) if LONG else list(items)[::step]
