#!/usr/bin/env python3
"""With --display app a program that reads its own window right after a swap finds that frame there.

  window_reads.py --build build/release --programs immediate,resize --layouts 2x2 --size 250x190 --frames 4
  window_reads.py --build build/release --read copy    through a pixmap instead of XGetImage

As run_exact.py, but the pictures are the windows' contents (window_grab.c), not the pixels that GL reads.
"""

import os
import sys

from harness import programs, shared_nodes
import run_exact

# Without threads_windows: its windows overlap, so a read returns the pixels that another thread has just shown there.
PROGRAMS = "immediate,single_buffered,several_windows,resize,window_churn,thread_keys,es1_scene,es2_scene,egl_desktop"


class WindowComparison(run_exact.Comparison):
    def run(self, name, label, launcher=(), environment=None):
        arguments = self.arguments
        folder = os.path.join(self.folder, name, label)
        environment = dict(environment or {}, GRAB_READ=arguments.read)
        return programs.run_program(arguments.build, name, folder, self.display_name, arguments.size,
                                    arguments.frames, launcher, arguments.seconds, environment,
                                    library="window_grab.so")

    def run_shared(self, name, label, launcher):
        if label not in self.shared:
            self.forget_report(label)
            self.shared[label] = WindowNodes(launcher, self.display_name, os.path.join(self.folder, "shared." + label))
            self.shared[label].read = self.arguments.read
        return super().run_shared(name, label, launcher)


class WindowNodes(shared_nodes.SharedNodes):
    """Nodes for several programs, whose windows are captured."""

    def run_program(self, build, name, folder, size, frames, seconds=120):
        os.makedirs(folder)
        settings, words = programs.command_of(build, name, folder, size, frames, "window_grab.so")
        return programs.Run(*self.run("GRAB_READ=%s %s" % (self.read, settings), words, folder + ".log", seconds), folder)


def add_arguments(parser):
    parser.add_argument("--read", choices=("image", "copy"), default="image")
    parser.set_defaults(options="--display app", programs=PROGRAMS)


if __name__ == "__main__":
    sys.exit(run_exact.main(__doc__, add_arguments, WindowComparison))
