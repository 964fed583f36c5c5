#!/usr/bin/env python3
"""Failures have a defined result: render nodes and the head are killed, programs end in all ways, arguments are
invalid. Each case checks the status, the number of printed lines, and that nothing remains.

  failures.py --build build/release [--cases node,head,ends,arguments] [--list]
"""

import os
import resource
import signal
import stat
import sys
import tempfile
import time

from harness import cases, programs, session


FEW_NODES = ("--tiles", "2x1", "--display", "none")


def drawing(context, name, frames=5, tiles="2x1", **more):
    """Starts a session with few nodes, because each costs more time than a short program."""
    return context.drawing(name, frames, options=("--tiles", tiles, "--display", "none"), **more)


def kill_during_run(context, pattern, how_many, after_line, words, tiles="2x1"):
    """Kills processes of the session while the program draws; the program must not be affected."""
    frames = 60
    with drawing(context, "long_run", frames, tiles) as run:
        if after_line and not run.wait_for_line(after_line):
            return "the program did not reach \"%s\": %s" % (after_line, " | ".join(run.standard_error[-3:]))
        found = run.wait_for_processes(pattern, max(how_many, 1))
        if not found:
            return "no process fits \"%s\"" % pattern
        cases.kill_all(found if how_many == 0 else found[:how_many])
        wrong = cases.check_end(run, 0, frames)
        output = cases.error_lines(run, words)
        if wrong is None and len(output) != max(how_many, 1):
            wrong = "%d lines about it instead of %d: %s" % (len(output), max(how_many, 1), " | ".join(output))
        return wrong


@cases.case
def node_killed_in_the_middle(context):
    return kill_during_run(context, cases.NODE, 1, "frame 20", ["was lost:"])


@cases.case
def node_killed_at_the_start(context):
    return kill_during_run(context, cases.NODE, 1, "frame 0", ["was lost:"])


@cases.case
def two_nodes_killed(context):
    return kill_during_run(context, cases.NODE, 2, "frame 10", ["was lost:"], "2x2")


def range_lost(context, composition):
    """One of the nodes that divide draws is killed: its draws are missing, which one line reports, and no process waits
    for long."""
    with context.drawing("long_scene", 10 ** 6, options=("--display", "none", "--db", "4", "--composition", composition), environment={"SCENE_SHARES": "1"}) as run:
        if not run.wait_for_line("frame 20 "):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        found = run.wait_for_processes(cases.NODE, 4)
        if len(found) < 4:
            return "%d of 4 nodes run" % len(found)
        started = time.monotonic()
        cases.kill_all(sorted(found)[2:3])
        if not run.wait_for_line("a range of the picture is missing until its node rejoins: range 3"):
            return "no message about a missing range: " + " | ".join(run.standard_error[-3:])
        drawn = sum(line.startswith("frame ") for line in run.standard_output)
        if not run.wait_for_line("frame %d " % (drawn + 80)):
            return "no more frames: " + " | ".join(run.standard_error[-3:])
        if time.monotonic() - started > 60:
            return "it took %d s" % (time.monotonic() - started)
        run.process.send_signal(signal.SIGTERM)
        run.status()
        left = run.left_behind()
        return "left over: " + ", ".join(left) if left else None


@cases.case
def range_lost_serial(context):
    return range_lost(context, "serial")


@cases.case
def range_lost_direct_send(context):
    return range_lost(context, "direct-send")


@cases.case
def range_lost_streaming(context):
    return range_lost(context, "streaming")


@cases.case
def head_killed_in_the_middle(context):
    return kill_during_run(context, cases.HEAD, 1, "frame 20", ["head"])


@cases.case
def head_killed_at_the_start(context):
    return kill_during_run(context, cases.HEAD, 1, "frame 0", ["head"])


@cases.case
def all_nodes_killed(context):
    with drawing(context, "long_run", 60, "3x1") as run:
        if not run.wait_for_line("frame 20"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        cases.kill_all(run.wait_for_processes(cases.NODE, 3))
        wrong = cases.check_end(run, 0, 60)
        if wrong is None and not cases.error_lines(run, ["was lost"]):
            wrong = "no message about the lost nodes"
        return wrong


def killed_while_frames_are_counted(context, pattern, how_many):
    """The process that counts to --frames is killed: the program ends nevertheless, and the run has failed."""
    options = ("--tiles", "2x1", "--display", "none", "--restart-nodes", "0", "--frames", "1000000")
    with context.drawing("long_run", 10 ** 6, options=options) as run:
        if not run.wait_for_line("frame 20"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        cases.kill_all(run.wait_for_processes(pattern, how_many))
        wrong = cases.check_end(run, 1)
        if wrong is None and len(cases.error_lines(run, ["does not count frames any more"])) != 1:
            wrong = "output: " + " | ".join(run.standard_error[-4:])
        return wrong


@cases.case
def head_killed_while_frames_are_counted(context):
    return killed_while_frames_are_counted(context, cases.HEAD, 1)


@cases.case
def all_nodes_killed_while_frames_are_counted(context):
    return killed_while_frames_are_counted(context, cases.NODE, 2)


@cases.case
def node_without_memory(context):
    """One node has no memory for a texture: the program receives the error once, as from its own driver."""
    frames = 60
    with drawing(context, "no_memory", frames) as run:
        if not run.wait_for_line("frame 3"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        node = run.wait_for_processes(cases.NODE, 1)[0]
        with open("/proc/%d/statm" % node, encoding="ascii") as sizes:
            pages = int(sizes.read().split()[0])
        limit = pages * resource.getpagesize() + (3 << 20)  # less than one texture
        resource.prlimit(node, resource.RLIMIT_AS, (limit, limit))
        wrong = cases.check_end(run, 0, frames)
        if wrong is None and run.standard_output.count("no memory") != 1:
            wrong = "it received %d notifications" % run.standard_output.count("no memory")
        if wrong is None and len(cases.error_lines(run, ["no memory for a GL object"])) == 0:
            wrong = "no message about the node without memory"
        return wrong


@cases.case
def node_driver_reset(context):
    """One node's driver reports a reset (a planted fault). A program with reset notification receives it once, through
    the status and through GL's error for it; for another program one line is printed."""
    for arguments, reported in (([], ["lost by status 0x8254, error 0x0507 behind it"]), (["--unasked"], [])):
        command = [context.program("context_lost"), "--frames", "60", "--size", "250x190"] + arguments
        with context.run(command, FEW_NODES, {"MURAL_PLANT": "reset"}) as run:
            wrong = cases.check_end(run, 0, 60)
            output = [line for line in run.standard_output if line.startswith("lost")]
            lines = cases.error_lines(run, ["did not enable reset notification"])
            if wrong is None and output != reported:
                wrong = "it received \"%s\" instead of \"%s\"" % (" | ".join(output), " | ".join(reported))
            if wrong is None and len(lines) != (0 if reported else 1):
                wrong = "%d lines for a program that %s: %s" % (len(lines), "enabled reset notification" if reported else "did not enable it", " | ".join(lines))
            if wrong is None and not cases.error_lines(run, ["lost a context"]):
                wrong = "no message about the lost context"
            if wrong:
                return wrong
    return None


@cases.case
def node_stopped_and_continued(context):
    """A node that is only stopped for a while is not lost."""
    with drawing(context, "long_run", 60) as run:
        if not run.wait_for_line("frame 10"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        nodes = run.wait_for_processes(cases.NODE, 1)
        os.kill(nodes[0], signal.SIGSTOP)
        run.wait_for_line("frame 59", 1)
        os.kill(nodes[0], signal.SIGCONT)
        wrong = cases.check_end(run, 0, 60)
        if wrong is None and cases.error_lines(run, ["was lost"]):
            wrong = "it was reported as lost: " + " | ".join(cases.error_lines(run, ["was lost"]))
        return wrong


@cases.case
def node_stopped_for_good(context):
    """A hanging node is dropped, with one line; the others and the program continue."""
    with drawing(context, "long_run", 60) as run:
        if not run.wait_for_line("frame 10"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        node = run.wait_for_processes(cases.NODE, 1)[0]
        os.kill(node, signal.SIGSTOP)
        wrong = cases.check_end(run, 0, 60)
        output = cases.error_lines(run, ["was lost:"])
        if wrong is None and (len(output) != 1 or "pid %d)" % node not in output[0]):
            wrong = "not one line about node %d: %s" % (node, " | ".join(output))
        return wrong


@cases.case
def program_killed(context):
    with drawing(context, "long_run", 100000) as run:
        if not run.wait_for_line("frame 10"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        cases.kill_all(run.processes(r"^\S*/long_run --frames"))  # not the launcher, whose command line also has the name
        return cases.check_end(run, 128 + signal.SIGKILL)


def interrupted(context, number):
    with drawing(context, "long_run", 100000) as run:
        if not run.wait_for_line("frame 10"):
            return "the program did not start: " + " | ".join(run.standard_error[-3:])
        os.kill(run.process.pid, number)
        status = run.status(30)
        if status in (None, 0):
            return "status %s after the signal" % status
        left = run.left_behind()
        return "left over: " + ", ".join(left) if left else None


@cases.case
def launcher_interrupted(context):
    return interrupted(context, signal.SIGINT)


@cases.case
def launcher_terminated(context):
    return interrupted(context, signal.SIGTERM)


@cases.case
def launcher_killed(context):
    """kill -9 of `mural run` itself: the other processes must notice it themselves."""
    return interrupted(context, signal.SIGKILL)


def ends(name):
    def check(context):
        wanted = programs.STATUS.get(name, 0)
        with drawing(context, name, tiles="2x2" if name == "exit_dirty" else "1x1") as run:
            return cases.check_end(run, wanted if wanted >= 0 else 128 - wanted)
    check.__name__ = "ends_" + name
    cases.case(check)


for ending in ("exit_dirty", "exit_quick", "exit_three", "exit_abort", "exit_segv", "exit_term",
               "fork_exec", "fork_child"):
    ends(ending)


@cases.case
def ends_launcher_script(context):
    """A script that starts the program in the background and waits for it."""
    script = "\"$0\" --frames 5 --size 250x190 & wait $!; exit 7"
    with context.run(["sh", "-c", script, context.program("long_run")], FEW_NODES) as run:
        return cases.check_end(run, 7, 5)


@cases.case
def ends_script_that_execs(context):
    with context.run(["sh", "-c", "exec \"$0\" --frames 5 --size 250x190", context.program("exit_three")], FEW_NODES) as run:
        return cases.check_end(run, 3)


@cases.case
def ends_program_without_gl(context):
    with context.run(["sh", "-c", "exit 5"], FEW_NODES) as run:
        return cases.check_end(run, 5)


@cases.case
def ends_frames_reached(context):
    options = ("--tiles", "2x1", "--display", "none", "--frames", "10")
    with context.drawing("long_run", 100000, options=options) as run:
        return cases.check_end(run, 0)


@cases.case
def ends_picture_that_nobody_sees(context):
    # The size of the wall needs a private display, because the program's window is there.
    for options, reported in ((("--size", "250x190", "--display", "app"), 1), (("--tiles", "1x1", "--display", "app"), 0)):
        with context.drawing("immediate", 3, options=options) as run:
            wrong = cases.check_end(run, 0)
            if wrong:
                return wrong
            lines = cases.error_lines(run, ["private display"])
            if len(lines) != reported:
                return "%s: %d lines with the window position, not %d" % (" ".join(options), len(lines), reported)
    return None


def complains(name, arguments, wanted_status, words, environment=None):
    """Checks that standard error is one line with one of the words, and that nothing was started."""
    def check(context):
        command = [argument.replace("{programs}", os.path.join(context.build, "tests", "programs"))
                   for argument in arguments]
        with session.Session([context.mural] + command, context.display, environment) as run:
            status = run.status(30)
            output = [line for line in run.standard_error if line.strip()]
            if status not in wanted_status:
                return "status %s instead of %s: %s" % (status, wanted_status, " | ".join(output))
            if len(output) != 1 or not any(word in output[0] for word in words):
                return "it printed %d lines: %s" % (len(output), " | ".join(output))
            left = run.left_behind()
            return "left over: " + ", ".join(left) if left else None
    check.__name__ = "arguments_" + name
    cases.case(check)


ANY = range(1, 128)
complains("unknown_command", ["rin"], ANY, ["rin"])
complains("unknown_option", ["run", "--tyles", "2x2", "--", "true"], [2], ["--tyles"])
complains("tiles_zero", ["run", "--tiles", "0x2", "--", "true"], [2], ["--tiles"])
complains("tiles_words", ["run", "--tiles", "many", "--", "true"], [2], ["--tiles"])
complains("size_words", ["run", "--size", "big", "--", "true"], [2], ["--size"])
complains("latency_negative", ["run", "--latency", "-1", "--", "true"], [2], ["--latency"])
complains("unknown_gl", ["run", "--gl", "vulkan", "--", "true"], [2], ["--gl"])
complains("save_without_out", ["run", "--save", "1", "--", "true"], [2], ["--save"])
complains("more_nodes_than_tiles", ["run", "--tiles", "1x1", "--local-nodes", "3", "--", "true"], [2], ["node"])
complains("no_program", ["run", "--tiles", "2x2"], [2], ["program"])
complains("program_not_found", ["run", "--", "no-such-program-here"], [127], ["no-such-program-here"])
complains("program_is_a_folder", ["run", "--", "/usr"], [126], ["/usr"])
complains("not_executable", ["run", "--", "/etc/passwd"], [126], ["/etc/passwd"])
complains("static_program", ["run", "--", "{programs}/static_program"], [2], ["static"])
complains("display_missing", ["run", "--display", "app", "--", "{programs}/exit_quick"], ANY, ["display", "DISPLAY"],
          {"DISPLAY": ":9876"})


@cases.case
def arguments_setuid_program(context):
    with tempfile.TemporaryDirectory(prefix="mural-setuid.") as folder:
        copy = os.path.join(folder, "setuid_program")
        with open(context.program("exit_quick"), "rb") as source, open(copy, "wb") as target:
            target.write(source.read())
        os.chmod(copy, 0o755 | stat.S_ISUID)
        with context.run([copy]) as run:
            status = run.status(30)
            output = [line for line in run.standard_error if line.strip()]
            if status != 2 or len(output) != 1 or "setuid" not in output[0]:
                return "status %s, output: %s" % (status, " | ".join(output))
            return None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
