"""One `mural run` under test: started, observed, disturbed, and checked for remains."""

import os
import queue
import re
import signal
import subprocess
import tempfile
import threading
import time
import uuid

from harness import processes, programs

MARK = "MURAL_TEST_RUN"  # variable in the environment of every process that a run starts


def processes_of(mark):
    return processes.processes_with("%s=%s" % (MARK, mark))


def shared_memory():
    return {name for name in os.listdir("/dev/shm") if "mural" in name.lower()}


def end_after(end_file, frames):
    """Limits the program with this END_FILE to that number of further frames."""
    with open(end_file + ".new", "w", encoding="ascii") as file:
        file.write(str(frames))
    os.rename(end_file + ".new", end_file)  # atomic, because the program reads the file before each frame


class Session:
    """A context manager; it kills all processes that are alive at the end."""

    def __init__(self, command, display, environment=None):
        self.mark = uuid.uuid4().hex
        self.shared_memory_before = shared_memory()
        self.folder = tempfile.TemporaryDirectory(prefix="mural-failures.")
        self.environment = programs.clean_environment(display)
        self.environment.update({MARK: self.mark, "TMPDIR": self.folder.name})
        self.environment.update(environment or {})
        self.environment = {key: value for key, value in self.environment.items() if value is not None}
        self.lines = queue.Queue()
        self.standard_output = []
        self.standard_error = []
        self.process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        start_new_session=True)
        self.readers = [threading.Thread(target=self._read, args=pair, daemon=True)
                        for pair in ((self.process.stdout, self.standard_output),
                                     (self.process.stderr, self.standard_error))]
        for reader in self.readers:
            reader.start()

    def _read(self, stream, lines):
        for line in stream:
            text = line.decode(errors="replace").rstrip()
            lines.append(text)
            self.lines.put(text)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for pid in processes_of(self.mark):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.process.wait()
        for reader in self.readers:
            reader.join(5)
        self.folder.cleanup()

    def wait_for_line(self, text, seconds=60):
        """Returns True when a line with the text arrived in time."""
        deadline = time.monotonic() + seconds
        while True:
            try:
                if text in self.lines.get(timeout=max(0.0, deadline - time.monotonic())):
                    return True
            except queue.Empty:
                return False

    def processes(self, pattern):
        """Returns the pids of this run whose command line matches the pattern."""
        return sorted(pid for pid, command in processes_of(self.mark).items()
                      if re.search(pattern, command))

    def wait_for_processes(self, pattern, count=1, seconds=30):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline and self.process.poll() is None:
            found = self.processes(pattern)
            if len(found) >= count:
                return found
            time.sleep(0.01)
        return []

    def status(self, seconds=90):
        """Returns the status of `mural run`; None after the timeout."""
        status = self.process.poll()
        if status is None:
            status = programs.ended_within(self.process, seconds)
        if status is None:
            return None
        for reader in self.readers:
            reader.join(5)
        return status

    def left_behind(self, seconds=10):
        """Returns the remains some time after the end: processes, shared memory, files."""
        deadline = time.monotonic() + seconds
        while True:
            left = ["process %d (%s)" % item for item in processes_of(self.mark).items()]
            left += ["/dev/shm/" + name for name in shared_memory() - self.shared_memory_before]
            left += [os.path.join(self.folder.name, name) for name in os.listdir(self.folder.name)]
            if not left or time.monotonic() > deadline:
                return left
            time.sleep(0.05)
