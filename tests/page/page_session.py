"""`mural page` of a real session, for the tests of the page."""

import json
import os
import select
import subprocess
import sys

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "end_to_end"))
sys.path.insert(0, os.path.join(TOP, "tests", "page"))
from harness import cases  # noqa: E402
from harness.control import ctl  # noqa: E402
from page_client import request  # noqa: E402

SIZE = "320x200"


class Page:
    """`mural page` of a run. `url` ends with a slash; `token` has the role operate."""

    def __init__(self, context, run, *options):
        command = [context.mural, "page", str(run.process.pid), *options]
        self.process = subprocess.Popen(command, env=run.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.context, self.run = context, run
        ready = select.select([self.process.stdout], [], [], 30)[0]
        line = self.process.stdout.readline().decode() if ready else ""
        self.url, _, self.token = line.strip().partition("#t=")

    def __enter__(self):
        if not self.token:
            raise RuntimeError("no page: " + self.process.communicate(timeout=10)[1].decode())
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()

    def link(self, role, **terms):
        """Returns (number, token) of a new link."""
        status, _, body = request(self.url, "/api/v1/links", self.token, "POST", {"role": role, **terms})
        made = json.loads(body)
        assert status == 200, body
        return made["link"], made["token"]

    def command(self, *words):
        """Runs `mural page WORDS` for this session. Returns (status, output, errors)."""
        done = subprocess.run([self.context.mural, "page", *words, str(self.run.process.pid)], env=self.run.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30, check=False)
        return done.returncode, done.stdout.decode(), done.stderr.decode()


def session(context, tiles="2x1", display="app"):
    return context.run([context.program("long_run"), "--frames", "1000000", "--size", SIZE], ["--tiles", tiles, "--display", display])


def draws(run):
    return run.wait_for_line("frame 5") or "no frames: " + " | ".join(run.standard_error[-3:])


def ended(context, run, wrong):
    ctl(context, str(run.process.pid), "stop")
    return "; ".join(wrong) or cases.check_end(run, 0)
