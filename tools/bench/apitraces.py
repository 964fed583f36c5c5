"""apitrace as a peer at the same job."""

LEAST_TRACE_BYTES = 1000  # less: it has recorded nothing
TRIES = 4


def traced(trace):
    """What trace() returns, the size of a trace in bytes first. It is called again while that is hardly one.

    apitrace keeps the trace of a short run in memory, and gives it up when the signal that ends the program comes while a call is
    being traced: 1 of 25 runs of 64 frames of glxgears.
    """
    for _ in range(TRIES):
        size_bytes, *rest = trace()
        if size_bytes >= LEAST_TRACE_BYTES:
            break
    return (size_bytes, *rest)
