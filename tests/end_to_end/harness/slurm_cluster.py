"""A Slurm cluster on this machine: munged, slurmctld, and one slurmd per host of the cluster. All hosts are this machine
under other names. Requires own_network.enter(own_processes=True) as root: the servers end with the namespaces.

  with SlurmCluster(folder, ["wall1", "wall2"]) as cluster: subprocess.run(["srun", ...], env={**env, **cluster.environment})
"""

import os
import shutil
import subprocess
import time

NEEDED = ("munged", "slurmctld", "slurmd", "srun", "salloc", "scancel")

CONF = """
ClusterName=test
SlurmctldHost={here}
SlurmUser=root
SlurmctldPort=6817
AuthType=auth/munge
CryptoType=crypto/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=30
KillWait=3
SlurmdParameters=config_overrides
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
{nodes}
PartitionName=wall Nodes=ALL Default=YES MaxTime=INFINITE OverSubscribe=YES State=UP
"""


def absent():
    """Returns the reason why no cluster can be started; None: it can."""
    if os.getuid() != 0:
        return "slurmd needs root"
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    missing = [name for name in NEEDED if not shutil.which(name, path=path)]
    return "not installed: %s (tools/install-deps test)" % ", ".join(missing) if missing else None


class SlurmCluster:
    def __init__(self, folder, hosts):
        self.folder = folder
        self.hosts = hosts
        self.servers = {}
        self.conf = os.path.join(folder, "slurm.conf")
        self.environment = {"SLURM_CONF": self.conf}
        os.environ["PATH"] += ":/usr/sbin:/sbin"

    def _server(self, name, *command):
        log = open(os.path.join(self.folder, name + ".out"), "wb")
        environment = {"PATH": os.environ["PATH"], "SLURM_CONF": self.conf}
        self.servers[name] = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment)

    def __enter__(self):
        os.makedirs("/run/munge", exist_ok=True)
        key = os.path.join(self.folder, "munge.key")
        with open(os.open(key, os.O_WRONLY | os.O_CREAT, 0o600), "wb") as file:
            file.write(os.urandom(128))
        self._server("munged", "munged", "--force", "--foreground", "--key-file=" + key, "--num-threads=2",
                     "--pid-file=%s/munged.pid" % self.folder, "--log-file=%s/munged.log" % self.folder,
                     "--seed-file=%s/munged.seed" % self.folder)
        here = os.uname().nodename
        nodes = "\n".join("NodeName=%s NodeHostname=%s NodeAddr=127.0.0.1 Port=%d CPUs=4 RealMemory=1000 State=UNKNOWN"
                          % (host, here, 17001 + i) for i, host in enumerate(self.hosts))
        with open(self.conf, "w", encoding="ascii") as file:
            file.write(CONF.format(here=here, folder=self.folder, nodes=nodes))
        with open(os.path.join(self.folder, "cgroup.conf"), "w", encoding="ascii") as file:
            file.write("CgroupPlugin=cgroup/v1\n")
        with open(os.path.join(self.folder, "mpi.conf"), "w", encoding="ascii") as file:
            file.write("PMIxCliTmpDirBase=/run\n")
        os.makedirs(os.path.join(self.folder, "state"), exist_ok=True)
        self._await(lambda: os.path.exists("/run/munge/munge.socket.2"), "munged")
        self._server("slurmctld", "slurmctld", "-D", "-i", "-f", self.conf)
        for host in self.hosts:
            self.start_host(host)
        self._await(lambda: self.states().count("idle") == len(self.hosts), "the hosts")
        return self

    def start_host(self, host):
        os.makedirs(os.path.join(self.folder, host), exist_ok=True)
        self._server(host, "slurmd", "-D", "-N", host, "-f", self.conf)

    def states(self):
        done = self.run("sinfo", "-h", "-N", "-o", "%t")
        return done.stdout.split()

    def run(self, *command, seconds=60):
        return subprocess.run(command, env={**os.environ, **self.environment}, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=seconds, check=False)

    def _await(self, condition, what, seconds=30):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline or any(s.poll() is not None for s in self.servers.values()):
                raise RuntimeError("%s did not start: %s" % (what, self.logs()))
            time.sleep(0.05)

    def logs(self):
        text = ""
        for name in sorted(os.listdir(self.folder)):
            if name.endswith((".out", ".log")):
                with open(os.path.join(self.folder, name), encoding="utf-8", errors="replace") as file:
                    text += "\n--- %s\n%s" % (name, "".join(file.readlines()[-4:]))
        return text

    def __exit__(self, *_):
        self.run("scancel", "-u", "root")
        for name in reversed(list(self.servers)):
            server = self.servers[name]
            server.terminate()
            try:
                server.wait(5)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()
