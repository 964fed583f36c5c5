"""Requests of `mural ctl` to a session under test."""

import json
import subprocess

PATIENCE_SECONDS = 60


def ctl(context, *words):
    """Returns (exit status, output, errors)."""
    done = subprocess.run([context.mural, "ctl", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=PATIENCE_SECONDS, check=False)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def result_of(context, run, *words):
    """Returns the result of an operation of this run; after a failure the member "error" has its text."""
    status, output, errors = ctl(context, "--json", str(run.process.pid), *words)
    return json.loads(output)["result"] if status == 0 else {"error": errors}
