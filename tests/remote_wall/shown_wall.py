"""A `mural show` under test."""

import os
import re
import signal
import subprocess
import threading

from harness import pictures, processes, programs


def secret(folder, name):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="ascii") as file:
        file.write(os.urandom(32).hex())
    os.chmod(path, 0o600)
    return path


class Wall:
    """A `mural show` that saves pictures. A context manager. at: starts a command on another machine."""

    def __init__(self, context, folder, name, key, port=0, more=("--display", "none"), address="127.0.0.1", at=()):
        self.out = os.path.join(folder, name)
        command = [*at, context.mural, "show", "--listen", "%s:%d" % (address, port), "--secret", key,
                   "--out", self.out, "--name", name, *more]
        self.lines = []
        self.process = subprocess.Popen(command, env=programs.clean_environment(context.display), text=True,
                                        stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.reader = threading.Thread(target=lambda: self.lines.extend(iter(self.process.stderr.readline, "")), daemon=True)
        self.reader.start()
        self.port = None

    def __enter__(self):
        if not self.has_line("waits for pictures"):
            raise RuntimeError("mural show does not start: " + "".join(self.lines))
        self.port = int(re.search(r"waits for pictures at tcp://\S+:(\d+)", "".join(self.lines)).group(1))
        return self

    def __exit__(self, *_):
        self.kill()

    def has_line(self, text, seconds=20):
        return processes.until(lambda: any(text in line for line in list(self.lines)), seconds)

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.reader.join(5)
        self.process.stderr.close()

    def numbers(self):
        """Returns the numbers of the saved frames."""
        names = os.listdir(self.out) if os.path.isdir(self.out) else []
        return sorted(int(name[6:-4]) for name in names if re.fullmatch(r"frame-\d+\.png", name))

    def path(self, number):
        return os.path.join(self.out, "frame-%06d.png" % number)

    def picture(self, number):
        return pictures.read_png(self.path(number))

    def saves_after(self, number, seconds=20):
        """Waits for a frame with a larger number."""
        return processes.until(lambda: (self.numbers() or [0])[-1] > number, seconds)

    def end(self):
        """Returns the status after SIGTERM."""
        self.process.send_signal(signal.SIGTERM)
        return programs.ended_within(self.process, 20)
