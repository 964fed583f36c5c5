"""Runs call_cost natively and through Mural in alternation, to measure the cost of small calls."""

import json
import os
import statistics
import sys
import tempfile

from benchlib.mural_runs import Wall


def find_call_cost(wish, mural, tool):
    """Returns the path of the program. None if it is not built (one line reports this) or not requested ("none")."""
    if wish == "none":
        return None
    path = wish or os.path.join(os.path.dirname(mural), "call_cost")
    if os.path.isfile(path):
        return os.path.abspath(path)
    if wish:
        sys.exit("%s: there is no %s; it is built as the target call_cost" % (tool, path))
    print("%s: the cost of calls is left out: %s is not built (target call_cost)" % (tool, path), file=sys.stderr, flush=True)
    return None


def measure_calls(runs, call_cost, repeats, options, say):
    """Returns [{"name", "bytes", "nativeNs", "muralNs", "overNs", "copyNs"}], medians over the repeats. Takes options
    of call_cost."""
    collected = {"native": [], "1x1": []}
    for repeat in range(repeats):
        for text, into in collected.items():
            say("cost of calls: repeat %d of %d, %s" % (repeat + 1, repeats, " ".join([text] + options)))
            with tempfile.TemporaryDirectory(prefix="mural-bench.") as folder:
                file_name = os.path.join(folder, "calls.json")
                runs.run(Wall(text), [call_cost, "--json", file_name, *options])
                with open(file_name, encoding="utf-8") as file:
                    into.append(json.load(file)["calls"])
    rows = []
    for index, call in enumerate(collected["native"][0]):
        def median(kind, field):
            return statistics.median(calls[index][field] for calls in collected[kind])
        over = statistics.median(m[index]["cpuNs"] - n[index]["cpuNs"] for n, m in zip(collected["native"], collected["1x1"]))
        rows.append({"name": call["name"], "bytes": call["bytes"], "nativeNs": median("native", "cpuNs"),
                     "muralNs": median("1x1", "cpuNs"), "overNs": over, "copyNs": median("native", "copyNs")})
    return rows
