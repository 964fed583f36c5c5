"""One `mural run` for several test programs, one after another: the nodes start once, and have drawn other programs
before.
"""

import json
import os
import select
import shlex
import subprocess
import time

from harness import programs

# A shell that runs each line as a command, and writes its exit status into the pipe.
READER = 'while IFS= read -r line; do eval "$line"; echo $? > "$1"; done'


def text_of(path):
    if not os.path.exists(path):
        return ""
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read().strip()


class SharedNodes:
    def __init__(self, launcher, display, folder):
        os.makedirs(folder)
        self.log_path = os.path.join(folder, "log")
        self.frames = 0  # on the wall, after the last program
        statuses = os.path.join(folder, "statuses")
        os.mkfifo(statuses)
        self.statuses = os.open(statuses, os.O_RDWR)
        command = list(launcher) + ["sh", "-c", READER, "sh", statuses]
        with open(self.log_path, "wb") as log:
            self.process = subprocess.Popen(command, env=programs.clean_environment(display), stdin=subprocess.PIPE,
                                            stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        self.ended = os.pidfd_open(self.process.pid)

    def run_program(self, build, name, folder, size, frames, seconds=120):
        """Runs a program, with the interface of programs.run_program."""
        os.makedirs(folder)
        settings, words = programs.command_of(build, name, folder, size, frames)
        return programs.Run(*self.run(settings, words, folder + ".log", seconds), folder)

    def run(self, settings, words, log_path, seconds):
        """Returns the status of a command, and its output. The status is None if it did not end in time, or if the run
        itself has ended, with the reason as output."""
        line = "%s %s > %s 2>&1 < /dev/null\n" % (settings, shlex.join(words), shlex.quote(log_path))
        try:
            self.process.stdin.write(line.encode())
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # there is no status
        status = self._status(seconds)
        return status, "\n".join(text_of(path) for path in ((log_path,) if status is not None else (self.log_path, log_path)))

    def _status(self, seconds):
        watch = select.poll()
        watch.register(self.statuses, select.POLLIN)
        watch.register(self.ended, select.POLLIN)
        ready = [descriptor for descriptor, _ in watch.poll(seconds * 1000)]
        return int(os.read(self.statuses, 16)) if self.statuses in ready else None

    def new_frames(self, mural, seconds=10):
        """Returns the number of frames on the wall since the last call. It waits for at least one, because the last frames
        of a program can be late."""
        deadline = time.monotonic() + seconds
        while True:
            frames = self._frames(mural)
            if frames > self.frames or time.monotonic() > deadline or self.process.poll() is not None:
                new, self.frames = frames - self.frames, frames
                return new
            time.sleep(0.02)

    def _frames(self, mural):
        done = subprocess.run([mural, "ctl", "--json", str(self.process.pid), "status"], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, timeout=60, check=False)
        return json.loads(done.stdout)["result"]["frames"] if done.returncode == 0 else self.frames

    def end(self, seconds):
        """Returns the status of the run; None: it did not end in time, and was killed."""
        try:
            self.process.stdin.close()
        except BrokenPipeError:
            pass
        status = programs.ended_within(self.process, seconds)
        programs.stop_group(self.process)
        self.process.wait()
        os.close(self.statuses)
        os.close(self.ended)
        return status
