"""Ends of benches. A stopped bench ends as after Ctrl-C, so that its processes and folders are removed."""

import os
import signal
import sys

STOPPED = 130


def run(main):
    """Exits with main's status. After Ctrl-C, SIGTERM or SIGHUP prints one line and exits with status 130."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # as under nohup
            signal.signal(number, signal.default_int_handler)
    try:
        status = main()
    except KeyboardInterrupt:
        print("%s: stopped before its end" % os.path.basename(sys.argv[0]), file=sys.stderr)
        status = STOPPED
    sys.exit(status)
