"""Traces of apitrace, which are compared with Mural's capture."""

MIN_TRACE_BYTES = 1000  # less: it has recorded nothing
TRIES = 4


def traced(trace):
    """Returns the result of trace(), whose first value is the size of the trace in bytes. Repeats the call while the
    trace is almost empty.

    apitrace keeps the trace of a short run in memory. It loses the trace if the terminating signal arrives while it
    traces a call: 1 of 25 runs of 64 frames of glxgears.
    """
    for _ in range(TRIES):
        size_bytes, *rest = trace()
        if size_bytes >= MIN_TRACE_BYTES:
            break
    return (size_bytes, *rest)
