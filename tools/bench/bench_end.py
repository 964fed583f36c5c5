"""How a bench ends that is stopped: as by Ctrl-C, so that what it has started and its folders end with it."""

import os
import signal
import sys

STOPPED = 130


def run(main):
    """Ends with main's status; with 130, and one line, when it is stopped by Ctrl-C, SIGTERM or SIGHUP."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # as under nohup
            signal.signal(number, signal.default_int_handler)
    try:
        status = main()
    except KeyboardInterrupt:
        print("%s: stopped before its end" % os.path.basename(sys.argv[0]), file=sys.stderr)
        status = STOPPED
    sys.exit(status)
