#!/usr/bin/env python3
"""Nodes start by ssh, in a Slurm job, and by mpirun, against real servers that this test starts: sshd, munged, slurmctld,
several slurmd, mpirun. Every pixel equals a native run's. After every case no process is left.

  launchers.py --build build/release [--cases ssh,slurm,mpi] [--list]
Exit status 77, with a reason: this machine lacks the servers or permits no namespaces.
"""

import argparse
import glob
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "end_to_end"))

from harness import display, own_network, processes, session, shared_nodes
from harness.slurm_cluster import SlurmCluster
from harness.ssh_hosts import SshHosts
import harness.slurm_cluster
import harness.ssh_hosts

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HOSTS = ["wall1", "wall2", "wall3"]
NODES = r"(starter|mural node) ?"
FRAMES = 40
ENDLESS = 10 ** 6
CASES = {}


def mpirun(count):
    return ("mpirun", "-n", str(count), "--oversubscribe", "--mca", "plm_rsh_agent", "false")


def case(launcher):
    def register(function):
        CASES[launcher + "_" + function.__name__] = function
        return function
    return register


class Lab:
    """Runs mural on the hosts of one launcher."""

    def __init__(self, build, folder, display_name, servers):
        self.build, self.folder, self.display, self.servers = build, folder, display_name, servers
        self.mural = os.path.join(build, "bin", "mural")
        self.environment = dict(getattr(servers, "environment", {}))

    def run(self, *options, frames=FRAMES, before=(), environment=None):
        program = os.path.join(self.build, "tests", "programs", "long_run")
        command = [*before, self.mural, "run", "--display", "none", *options, "--", program, "--frames", str(frames), "--size", "250x190"]
        return session.Session(command, self.display, {**self.environment, **(environment or {})})

    def wrapper(self, script):
        """Returns a program for --remote-mural; $MURAL is mural, and $HOST the host's name."""
        path = os.path.join(self.folder, "mural")
        with open(path, "w", encoding="ascii") as file:
            file.write("#!/bin/sh\nMURAL=%s\nHOST=${SLURMD_NODENAME:-wall$(($(echo $SSH_CONNECTION | cut -d. -f7 | cut -d' ' -f1) - 1))}\n%s\n" % (self.mural, script))
        os.chmod(path, 0o755)
        return path


def ended(run, status, wants=(), wants_not=(), seconds=60):
    """Returns None, or the error of a run that should end now with this status, these texts, and no process left."""
    got = run.status(seconds)
    output = "\n".join(run.standard_error)
    if got != status:
        return "status %s instead of %s; output:\n%s" % (got, status, output)
    missing = [text for text in wants if text not in output]
    extra = [text for text in wants_not if text in output]
    if missing or extra:
        return "missing: %s, too much: %s; output:\n%s" % (missing, extra, output)
    left = run.left_behind()
    return "left over: %s" % left if left else None


def drawing(run, line="frame 10"):
    return None if run.wait_for_line(line) else "it did not draw: %s" % " | ".join(run.standard_error[-6:])


def stop(run):
    """Ends the run in order, as a batch system does; salloc would end the job first."""
    os.kill(run.processes(r"^\S*/mural run\b")[-1], signal.SIGTERM)


def draws_on(run):
    """Returns an error unless the program draws further frames."""
    drawn = sum(line.startswith("frame ") for line in run.standard_output)
    return drawing(run, "frame %d" % (drawn + 20))


def no_node_left(run, seconds=10):
    return processes.until(lambda: not run.processes(r"\b(starter|node)\b"), seconds)


# ---- ssh


@case("ssh")
def all_well(lab):
    before = [lab.servers.connections(host) for host in HOSTS]
    with lab.run("--nodes", "wall1,wall2", "--per-host", "2", "--tiles", "2x2", "--verify", "--explain") as run:
        wrong = ended(run, 0, [" 0 differ", "nodes start by ssh"], ["was lost"])
    made = [lab.servers.connections(host) - n for host, n in zip(HOSTS, before)]
    return wrong or (None if made == [1, 1, 0] else "connections: %s" % made)


@case("ssh")
def host_file(lab):
    path = os.path.join(lab.folder, "hosts")
    with open(path, "w", encoding="ascii") as file:
        file.write("# the wall\nwall1 slots=2\nwall3\n")
    with lab.run("--hostfile", path, "--tiles", "3x1", "--verify") as run:
        wrong = ended(run, 0, [" 0 differ"])
    with open(path, "a", encoding="ascii") as file:
        file.write("wall4 slot=1\n")
    with lab.run("--hostfile", path, "--tiles", "3x1") as run:
        return wrong or ended(run, 2, [path + ":4: \"slot=1\""])


@case("ssh")
def wrong_host_name(lab):
    with lab.run("--nodes", "wall1,nowhere.invalid", "--tiles", "2x1") as run:
        return ended(run, 2, ["node 1 (nowhere.invalid) did not start: exit status 255 of \"ssh -T ", "Could not resolve hostname", "check the host's name"])


@case("ssh")
def node_fails_at_once(lab):
    path = lab.wrapper("[ $HOST = wall2 ] && { echo no mural here >&2; exit 3; }\nexec $MURAL \"$@\"")
    with lab.run("--nodes", "wall1,wall2", "--tiles", "2x1", "--remote-mural", path) as run:
        wrong = ended(run, 2, ["node 1 (wall2) did not start: exit status 3 of \"ssh ", ": no mural here"])
    if wrong:
        return wrong
    with lab.run("--nodes", "wall1,wall2", "--tiles", "2x1", "--remote-mural", path, "--min-nodes", "1") as run:
        return ended(run, 0, ["node 1 (wall2) is not connected yet: it did not start: exit status 3"])


@case("ssh")
def other_version(lab):
    path = lab.wrapper("[ $HOST = wall2 ] && { echo mural-starter 0.0.1 1.1.0 $HOST; exec cat; }\nexec $MURAL \"$@\"")
    with lab.run("--nodes", "wall1,wall2", "--tiles", "2x1", "--remote-mural", path) as run:
        return ended(run, 2, ["node 1 (wall2) did not start: wall2 has mural 0.0.1 (stream 1.1.0)", "install the same version"])


@case("ssh")
def connection_cut(lab):
    with lab.run("--nodes", "wall1,wall2", "--tiles", "2x2", "--per-host", "2", frames=ENDLESS) as run:
        wrong = drawing(run)
        if wrong:
            return wrong
        lab.servers.cut("wall2")
        if not (run.wait_for_line("was lost") and run.wait_for_line("rejoined") and run.wait_for_line("rejoined")):
            return "no return: %s" % run.standard_error
        wrong = draws_on(run)
        stop(run)
        return wrong or ended(run, 143)


def end_with_the_head(lab, *options):
    """Kills the head: its nodes end, and the run reports the loss."""
    with lab.run(*options, frames=ENDLESS) as run:
        wrong = drawing(run)
        if wrong:
            return wrong
        os.kill(run.wait_for_processes(r"mural head\b")[0], signal.SIGKILL)
        if not no_node_left(run):
            return "nodes are left: %s" % run.processes(r"\b(starter|node)\b")
        stop(run)
        return ended(run, 143, ["the head process was lost"])


@case("ssh")
def head_killed(lab):
    return end_with_the_head(lab, "--nodes", "wall1,wall2", "--tiles", "2x1")


@case("ssh")
def late_node(lab):
    path = lab.wrapper("[ $HOST = wall2 ] && sleep 6\nexec $MURAL \"$@\"")
    with lab.run("--nodes", "wall1,wall2", "--tiles", "2x1", "--remote-mural", path) as run:
        return ended(run, 0, [" late, ", "node  host  launched", "1     wall2 ", "node 1 (wall2) has caught up: connected "])


# ---- Slurm


@case("slurm")
def all_well(lab):
    """The run requests its job, and takes all hosts of it."""
    with lab.run("--slurm", "-N2", "--per-host", "2", "--tiles", "2x2", "--verify", "--explain") as run:
        return ended(run, 0, [" 0 differ", "nodes start by slurm: Slurm job", "has the hosts wall1,wall2"], ["was lost"])


@case("slurm")
def inside_of_a_job(lab):
    """A batch script is inside of the job: its head runs on a host of it. There are fewer tiles than hosts."""
    script = os.path.join(lab.folder, "job")
    with open(script, "w", encoding="ascii") as file:
        file.write("#!/bin/sh\nexec \"$@\"\n")
    os.chmod(script, 0o755)
    output = os.path.join(lab.folder, "out")
    with lab.run("--tiles", "2x1", "--verify", before=("sbatch", "-N3", "--wait", "-o", output, script)) as run:
        wrong = ended(run, 0)
    with open(output, encoding="utf-8") as file:
        text = file.read()
    return wrong or (None if " 0 differ" in text else text)


@case("slurm")
def task_fails_at_once(lab):
    path = lab.wrapper("[ $HOST = wall2 ] && { echo no mural here >&2; exit 3; }\nexec $MURAL \"$@\"")
    with lab.run("--slurm", "-N2", "--remote-mural", path) as run:
        return ended(run, 2, ["node 1 (wall2) did not start: srun: error: wall2: task 1: Exited with exit code 3", "no mural here"])


@case("slurm")
def task_killed(lab):
    """The node comes back in a step of its own."""
    with lab.run("--slurm", "-N2", frames=ENDLESS) as run:
        wrong = drawing(run)
        if wrong:
            return wrong
        starters = run.wait_for_processes(r"mural starter", 2)
        os.kill(starters[-1], signal.SIGKILL)
        if not (run.wait_for_line("was lost") and run.wait_for_line("rejoined")):
            return "no return: %s" % run.standard_error
        wrong = draws_on(run)
        stop(run)
        return wrong or ended(run, 143)


@case("slurm")
def daemon_killed(lab):
    """A host's slurmd dies: the step and the picture go on."""
    with lab.run("--slurm", "-N2", "--verify", frames=ENDLESS) as run:
        wrong = drawing(run)
        if wrong:
            return wrong
        server = lab.servers.servers["wall2"]
        server.kill()
        server.wait()
        wrong = draws_on(run)
        lab.servers.start_host("wall2")
        stop(run)
        return wrong or ended(run, 143, [" 0 differ"], ["was lost"])


@case("slurm")
def job_cancelled(lab):
    with lab.run("--slurm", "-N2", frames=ENDLESS) as run:
        wrong = drawing(run)
        if wrong:
            return wrong
        lab.servers.run("scancel", "-n", "mural")
        return ended(run, 143)


@case("slurm")
def time_limit(lab):
    """The run warns before the end of its job, follows a changed limit, and ends in order before Slurm ends the job."""
    with lab.run("--slurm", "-N2 -t 1", frames=ENDLESS) as run:
        if not run.wait_for_line("ends in "):
            return "no warning: %s" % run.standard_error
        wrong = drawing(run)
        if wrong:
            return wrong
        job = lab.servers.run("squeue", "-h", "-o", "%i", "-n", "mural").stdout.strip()
        changed = lab.servers.run("scontrol", "update", "JobId=" + job, "EndTime=now+14")
        if changed.returncode != 0:
            return "scontrol: " + changed.stderr
        return ended(run, 1, ["; an operator can extend it: scontrol update JobId=%s " % job, "the run ends now"], ["DUE TO TIME LIMIT"])


@case("slurm")
def pmix_of_srun(lab):
    """Rank 0 of the step is the head, the others are nodes. The PMIx servers of two slurmd of one machine collide."""
    if not glob.glob("/usr/lib/*/pmix2/lib/libpmix.so"):
        print("srun --mpi=pmix is not tested: libpmix-dev is not installed (tools/install-deps test)")
        return None
    with lab.run("--tiles", "2x1", "--verify", "--explain", before=("srun", "--mpi=pmix", "-n3", "-N1")) as run:
        return ended(run, 0, [" 0 differ", "nodes start by pmix: this is rank 0 of 3 processes"], ["was lost"])


def sample_job(lab, sample, *options):
    """Runs a batch script of configs/launch as the guide describes it, with other numbers of hosts."""
    script = os.path.join(TOP, "configs", "launch", sample)
    program = os.path.join(lab.build, "tests", "programs", "long_run")
    path = os.path.join(lab.build, "bin") + ":" + os.environ["PATH"]
    folder = tempfile.mkdtemp(dir=lab.folder)
    command = ["sbatch", "--wait", "-D", folder, *options, script, program, "--frames", str(FRAMES), "--size", "250x190"]
    with session.Session(command, lab.display, {**lab.environment, "PATH": path}) as run:
        wrong = ended(run, 0, seconds=120)
    text = "".join(open(name, encoding="utf-8").read() for name in glob.glob(os.path.join(folder, "wall.*.log")))
    pictures = glob.glob(os.path.join(folder, "wall.*", "frame-*.png"))
    return wrong or (None if len(pictures) == FRAMES and "was lost" not in text else "%d pictures: %s" % (len(pictures), text))


@case("slurm")
def sample_script(lab):
    return sample_job(lab, "wall.sbatch", "-N2")


@case("slurm")
def sample_script_of_pmix(lab):
    if not glob.glob("/usr/lib/*/pmix2/lib/libpmix.so"):
        print("wall-pmix.sbatch is not tested: libpmix-dev is not installed (tools/install-deps test)")
        return None
    return sample_job(lab, "wall-pmix.sbatch", "-N1", "--ntasks-per-node=3")


@case("slurm")
def head_killed(lab):
    return end_with_the_head(lab, "--slurm", "-N2")


@case("slurm")
def secret_unreadable(lab):
    """One host has no munged: the secrets for it cannot be read."""
    path = lab.wrapper("[ $HOST = wall2 ] && exec unshare -m sh -c 'mount -t tmpfs none /run/munge; exec \"$@\"' sh $MURAL \"$@\"\nexec $MURAL \"$@\"")
    with lab.run("--slurm", "-N2", "--remote-mural", path) as run:
        return ended(run, 2, ["node 1 (wall2) did not start: ", "the secrets of the nodes of wall2 cannot be read: MUNGE cannot unseal"])


@case("slurm")
def not_in_the_job(lab):
    with lab.run("--nodes", "wall1,wall9", "--launch", "slurm", before=("salloc", "-N1")) as run:
        return ended(run, 2, ["node 1 (wall9) did not start: wall9 is not in Slurm job"])


# ---- mpirun


@case("mpi")
def all_well(lab):
    with lab.run("--tiles", "2x1", "--verify", "--explain", before=mpirun(3)) as run:
        return ended(run, 0, [" 0 differ", "nodes start by pmix: this is rank 0 of 3 processes"], ["was lost"])


@case("mpi")
def stopped(lab):
    with lab.run("--tiles", "2x1", frames=ENDLESS, before=mpirun(3)) as run:
        wrong = drawing(run)
        if wrong:
            return wrong
        run.process.send_signal(signal.SIGTERM)
        status = run.status()
        left = run.left_behind()
        return "left over: %s" % left if left else None if status in (1, 143) else "status %s" % status


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="the build folder")
    parser.add_argument("--cases", default="", help="beginnings of the cases' names, separated by commas")
    parser.add_argument("--list", action="store_true", help="show the cases and stop")
    arguments = parser.parse_args()
    chosen = [name for name in CASES if name.startswith(tuple(arguments.cases.split(",")))]
    if arguments.list:
        print("\n".join(chosen))
        return 0
    own_network.enter(own_processes=True, own_users=False)
    return perform(os.path.abspath(arguments.build), chosen)


class Mpi:
    """mpirun needs no servers."""

    environment = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

    @staticmethod
    def absent():
        missing = [name for name in ("mpirun",) if not shutil.which(name)]
        return "not installed: openmpi-bin (tools/install-deps test)" if missing else None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


LAUNCHERS = {
    "slurm": (harness.slurm_cluster.absent, lambda folder: SlurmCluster(folder, HOSTS)),
    "mpi": (Mpi.absent, lambda folder: Mpi()),
    "ssh": (harness.ssh_hosts.absent, lambda folder: SshHosts(folder, HOSTS)),
}


def set_up_network():
    own_network.own_x_sockets()
    own_network.sh("mount -t tmpfs none /run; mount -t proc none /proc; ip link set lo up")
    # Slurm resolves names only if an interface other than the loopback has an address.
    own_network.sh("ip link add eth0 type veth peer name eth1; ip addr add 10.79.0.1/24 dev eth0; ip link set eth0 up; ip link set eth1 up")


def perform(build, chosen):
    """Runs the cases of each launcher with its servers. Returns the exit status."""
    set_up_network()
    done = wrong = 0
    for launcher, (absent, servers) in LAUNCHERS.items():
        names = [name for name in chosen if name.startswith(launcher + "_")]
        reason = absent() if names else None
        if reason:
            print("skipped: %s: %s" % (launcher, reason), flush=True)
        if not names or reason:
            continue
        with tempfile.TemporaryDirectory(prefix="mural-launchers.") as folder, display.PrivateDisplay() as display_name, servers(folder) as running:
            for name in names:
                began = time.monotonic()
                result = CASES[name](Lab(build, folder, display_name, running))
                done, wrong = done + 1, wrong + (result is not None)
                print("%-28s %4.1f s %s" % (name, time.monotonic() - began, "right" if result is None else "WRONG: " + result), flush=True)
    print("%d cases, %d wrong" % (done, wrong))
    return 1 if wrong else 0 if done else own_network.SKIP


if __name__ == "__main__":
    sys.exit(main())
