"""A private X server, which finds a free number by itself."""

import os
import select
import subprocess
import sys
import time

START_SECONDS = 30


class BenchDisplay:
    """`with BenchDisplay("1280x1024") as name:` starts Xvfb and stops it again."""

    def __init__(self, size):
        self.size = size
        self.process = None

    def __enter__(self):
        read_end, write_end = os.pipe()
        command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", self.size + "x24", "-nolisten", "tcp", "-noreset"]
        try:
            self.process = subprocess.Popen(command, pass_fds=(write_end,), stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL, start_new_session=True)
        except FileNotFoundError:
            sys.exit("first_light: Xvfb is not installed: apt-get install xvfb")
        finally:
            os.close(write_end)
        try:
            return ":" + self._number(read_end)
        finally:
            os.close(read_end)

    def _number(self, descriptor):
        deadline, text = time.monotonic() + START_SECONDS, b""
        while not text.endswith(b"\n"):
            readable, _, _ = select.select([descriptor], [], [], max(0.0, deadline - time.monotonic()))
            part = os.read(descriptor, 16) if readable else b""
            if not part:
                self.__exit__()
                sys.exit("first_light: Xvfb did not start within %d s; does Xvfb run by itself?" % START_SECONDS)
            text += part
        return text.decode().strip()

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
