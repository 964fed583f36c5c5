#!/usr/bin/env python3
"""Runs test programs through a `mural` that was built with the address and undefined-behaviour sanitizers.

  sanitized.py --build build/asan --programs client_arrays,es3_scene --layouts 2x1 --size 253x191 --frames 3

As run_exact.py; in addition no process of a run may report anything: launcher, head, nodes, and the library in the
program. The program itself is built without sanitizers, so their runtime is preloaded there. At the end a node reads
beyond its memory on purpose (MURAL_PLANT=overflow), which must be reported, or the test proves nothing.
"""

import glob
import os
import subprocess
import sys

import run_exact

RUNTIMES = ("libasan.so", "libubsan.so")
FINDINGS = ("ERROR: ", "runtime error: ")
PROGRAMS = "client_arrays,pixels_read,framebuffers,glsl_stages,es3_scene"
PLANTED_IN = "client_arrays"


def runtimes_of(library):
    """Returns the sanitizers' runtime libraries that a library needs."""
    needed = subprocess.run(["ldd", library], stdout=subprocess.PIPE, text=True, timeout=60, check=True).stdout
    paths = [line.split("=>")[1].split()[0] for line in needed.splitlines() if line.strip().startswith(RUNTIMES)]
    if len(paths) != len(RUNTIMES):
        raise SystemExit("%s is not built with the sanitizers: cmake --preset asan" % library)
    return paths


class SanitizedComparison(run_exact.Comparison):
    def __init__(self, arguments, display_name, folder):
        super().__init__(arguments, display_name, folder)
        self.runtimes = runtimes_of(os.path.join(arguments.build, "lib", "libGLX_mural.so.0"))

    def environment(self):
        reports = "log_path=" + self.report_prefix()
        return {"LD_PRELOAD": " ".join(self.runtimes),
                # Leaks are not reported, because drivers keep memory until the end. The test's own library precedes the
                # runtime.
                "ASAN_OPTIONS": reports + ":detect_leaks=0:verify_asan_link_order=0",
                "UBSAN_OPTIONS": reports + ":print_stacktrace=1"}

    def report_prefix(self):
        return os.path.join(self.folder, "sanitizer")

    def take_findings(self):
        """Returns one line per process that reported something since the last call."""
        found = []
        for path in sorted(glob.glob(self.report_prefix() + ".*")):
            with open(path, encoding="utf-8", errors="replace") as report:
                lines = [line.strip() for line in report if line.strip()]
            os.remove(path)
            reason = next((line for line in lines if any(word in line for word in FINDINGS)), " ".join(lines[:1]))
            place = next((line for line in lines if line.startswith("#0")), "")
            found.append(reason + (" " + place if place else ""))
        return found

    def run(self, name, label, launcher=(), environment=None):
        more = dict(environment or {}, **self.environment()) if launcher else environment
        return super().run(name, label, launcher, more)

    def compare(self, native, through):
        found = self.take_findings()
        if found:
            return "sanitizers report: " + "; ".join(found)
        return super().compare(native, through)

    def planted(self):
        """Returns None if the planted fault is detected, otherwise an error."""
        label, launcher = next(iter(self.launchers().items()))
        self.run(PLANTED_IN, "planted", launcher, {"MURAL_PLANT": "overflow"})
        found = self.take_findings()
        return None if any("heap-buffer-overflow" in line for line in found) else "MISSED: " + ("; ".join(found) or "nothing was reported")

    def finish(self):
        wrong = self.planted()
        self.failures += wrong is not None
        print("planted overflow         %s" % (wrong or "found"), flush=True)


def add_arguments(parser):
    parser.set_defaults(options="--display app --verify", programs=PROGRAMS, layouts="2x1", size="253x191", frames=3)


if __name__ == "__main__":
    sys.exit(run_exact.main(__doc__, add_arguments, SanitizedComparison))
