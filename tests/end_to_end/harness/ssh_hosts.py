"""Hosts with sshd: all are this machine, at addresses of the loopback network. Requires own_network.enter as root: the
client's configuration is in a private ~/.ssh.

  with SshHosts(folder, ["wall1", "wall2"]) as hosts: subprocess.run(["ssh", "wall1", "true"])
"""

import os
import pwd
import shutil
import subprocess
import time

SSHD = "/usr/sbin/sshd"


def absent():
    """Returns the reason why there can be no such hosts; None: there can."""
    if os.getuid() != 0:
        return "the private ~/.ssh needs root"
    missing = [name for name, path in (("openssh-server", SSHD), ("openssh-client", shutil.which("ssh") or "")) if not os.path.exists(path)]
    return "not installed: %s (tools/install-deps test)" % ", ".join(missing) if missing else None


class SshHosts:
    def __init__(self, folder, names):
        self.folder = folder
        self.names = names
        self.servers = {}
        self.logs = {name: os.path.join(folder, name + ".log") for name in names}

    def __enter__(self):
        user_home = pwd.getpwuid(os.getuid()).pw_dir
        start_up = os.path.join(user_home, ".bashrc")  # bash reads it in sessions of sshd, and it may be slow
        if os.path.exists(start_up):
            subprocess.run(["mount", "--bind", "/dev/null", start_up], check=True)
        home = os.path.join(user_home, ".ssh")
        os.makedirs(home, mode=0o700, exist_ok=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", "mode=0700", "none", home], check=True)
        os.makedirs("/run/sshd", exist_ok=True)
        for key in ("host", "user"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", os.path.join(home, key)], check=True)
        with open(os.path.join(home, "config"), "w", encoding="ascii") as config:
            for number, name in enumerate(self.names):
                config.write("Host %s\n  HostName 127.0.0.%d\n  Port 2222\n  IdentityFile %s/user\n" % (name, number + 2, home)
                             + "  UserKnownHostsFile /dev/null\n  StrictHostKeyChecking no\n  LogLevel ERROR\n")
        for number, name in enumerate(self.names):
            log = open(self.logs[name], "wb")
            self.servers[name] = subprocess.Popen(
                [SSHD, "-D", "-e", "-f", "/dev/null", "-o", "ListenAddress=127.0.0.%d:2222" % (number + 2), "-o", "HostKey=" + os.path.join(home, "host"),
                 "-o", "AuthorizedKeysFile=%s/user.pub" % home, "-o", "StrictModes=no", "-o", "UsePAM=no", "-o", "PidFile=none",
                 "-o", "PermitRootLogin=yes", "-o", "AcceptEnv=MURAL_* TMPDIR", "-o", "LogLevel=VERBOSE", "-o", "PrintMotd=no", "-o", "PrintLastLog=no"],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        with open(os.path.join(home, "config"), "a", encoding="ascii") as config:
            config.write("Host *\n  SendEnv MURAL_* TMPDIR\n")
        deadline = time.monotonic() + 20
        for name in self.names:
            while b"Server listening" not in self._log(name):
                if time.monotonic() > deadline:
                    raise RuntimeError("sshd did not start: %s" % self._log(name))
                time.sleep(0.02)
        return self

    def _log(self, name):
        with open(self.logs[name], "rb") as log:
            return log.read()

    def connections(self, name):
        """Returns the number of logins so far."""
        return self._log(name).count(b"Accepted publickey")

    def cut(self, name):
        """Ends all connections of a host, as a failed network does; new ones are possible."""
        parent = str(self.servers[name].pid)
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open("/proc/%s/stat" % pid, encoding="ascii") as stat:
                    if stat.read().rsplit(")", 1)[1].split()[1] == parent:
                        os.kill(int(pid), 9)
            except OSError:
                pass

    def __exit__(self, *_):
        for server in self.servers.values():
            server.kill()
            server.wait()
