"""Runs `mural run` for a bench: returns its report, and the CPU time of its processes per frame."""

import json
import os
import signal
import subprocess
import tempfile

from benchlib.cpu_times import CpuTimes

LIMIT_SECONDS = 300


class RunFailed(Exception):
    pass


class Wall:
    """The display of a run: "native", "2x2" (without a window), "2x2@app" (in the program's window)."""

    def __init__(self, text):
        self.text = text
        self.native = text == "native"
        tiles, _, display = text.partition("@")
        self.options = ["--native"] if self.native else ["--tiles", tiles, "--display", display or "none"]


def role_of(words):
    """Returns the role of a process of a run, from its command line."""
    name = os.path.basename(words[0])
    if len(words) > 1 and name == "mural" and words[1] in ("head", "node"):
        return words[1]
    return "app"


class MuralRuns:
    def __init__(self, mural, display):
        self.mural = mural
        self.environment = {key: value for key, value in os.environ.items() if not key.startswith("MURAL_")}
        # No waiting for a screen's refresh: Mesa's and NVIDIA's switches.
        self.environment.update({"DISPLAY": display, "vblank_mode": "0", "__GL_SYNC_TO_VBLANK": "0"})

    def run(self, wall, program, frames=None, options=()):
        """Returns the report, with "cpu": role → (seconds, first thread's seconds) between the first and the last
        frame."""
        with tempfile.TemporaryDirectory(prefix="mural-bench.") as folder:
            report_file = os.path.join(folder, "report.json")
            command = [self.mural, "run", "--report", report_file, "--quiet", *wall.options, *options]
            command += ["--frames", str(frames)] if frames else []
            command += ["--", *program]
            errors_file = os.path.join(folder, "errors")
            with open(errors_file, "wb") as errors:
                process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL,
                                           stdout=subprocess.DEVNULL, stderr=errors)
            with CpuTimes(process.pid, role_of) as times:
                status = self._wait(process, command)
            report = self._report(report_file, errors_file, status, command)
        report["cpu"] = times.of_last(report["seconds"], "app")
        return report

    @staticmethod
    def _wait(process, command):
        try:
            return process.wait(LIMIT_SECONDS)
        except (subprocess.TimeoutExpired, KeyboardInterrupt) as why:
            process.send_signal(signal.SIGTERM)  # mural run ends its processes
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            if isinstance(why, KeyboardInterrupt):
                raise
            raise RunFailed("not done within %d s: %s" % (LIMIT_SECONDS, " ".join(command)))

    @staticmethod
    def _report(report_file, errors_file, status, command):
        try:
            with open(report_file, encoding="utf-8") as file:
                report = json.load(file)
        except (OSError, ValueError):
            report = {}
        if status != 0 or report.get("frames", 0) < 1:
            with open(errors_file, encoding="utf-8", errors="replace") as file:
                output = file.read().strip().replace("\n", " | ")
            raise RunFailed("status %d, %d frames: %s%s" % (status, report.get("frames", 0), " ".join(command), " said: " + output if output else ""))
        return report
