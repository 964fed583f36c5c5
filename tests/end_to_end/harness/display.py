"""A private X server for tests and measurements; it selects a free display number."""

import os
import select
import subprocess
import time


class PrivateDisplay:
    """`with PrivateDisplay() as name:` starts Xvfb and stops it at the end."""

    def __init__(self, size="2600x1700x24", start_seconds=30):
        self.size = size
        self.start_seconds = start_seconds
        self.process = None

    def __enter__(self):
        read_end, write_end = os.pipe()
        command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", self.size]
        command += ["-nolisten", "tcp", "-noreset"]
        try:
            self.process = subprocess.Popen(command, pass_fds=(write_end,), stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL, start_new_session=True)
        except FileNotFoundError:
            raise SystemExit("Xvfb is not installed: apt-get install xvfb")
        finally:
            os.close(write_end)
        try:
            return ":" + self._read_number(read_end)
        finally:
            os.close(read_end)

    def _read_number(self, descriptor):
        deadline = time.monotonic() + self.start_seconds
        text = b""
        while not text.endswith(b"\n"):
            readable, _, _ = select.select([descriptor], [], [], max(0.0, deadline - time.monotonic()))
            part = os.read(descriptor, 16) if readable else b""
            if not part:
                self.__exit__()
                raise SystemExit("Xvfb did not start within %d s" % self.start_seconds)
            text += part
        return text.decode().strip()

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
