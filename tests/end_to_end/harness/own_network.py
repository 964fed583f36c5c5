"""A private network for tests: machines (network namespaces) on one bridge, within user, mount and network namespaces.
They need no privileges where the kernel permits user namespaces. Rules at a machine's card cause faults.

  own_network.enter()                    starts the script again, inside; or prints the reason, and ends with 77
  network = own_network.OwnNetwork(...)  requires enter()
"""

import os
import subprocess
import sys

SKIP = 77
INSIDE = "MURAL_TEST_OWN_NETWORK"

# Rules of the netdev family see all incoming packets, as a switch would.
RULES = """
add table netdev faults
add chain netdev faults in { type filter hook ingress device "%s" priority 0; }
"""
# Rate of a slower path: a packet of 1514 bytes takes 2.4 ms, and the packets after it wait.
DETOUR_RATE = "5mbit"


def skip(why):
    print("skipped: %s" % why, flush=True)
    sys.exit(SKIP)


def enter(own_processes=False, own_users=True):
    """Starts the script inside the namespaces. own_processes: its child processes end with it in every case; their
    numbers then differ from the numbers in /proc. own_users=False: requires root, because servers that change their
    user fail in a user namespace."""
    if os.environ.get(INSIDE):
        return
    reasons = [] if own_users or os.getuid() == 0 else ["it needs root"]
    # In a chroot the kernel permits no user namespaces; root needs none.
    for namespaces in (["-Urnm"] if own_users else []) + (["-nm"] if os.getuid() == 0 else []):
        command = ["unshare", namespaces, "--kill-child", "--fork"] + (["--pid"] if own_processes else [])
        try:
            allowed = subprocess.run(command + ["true"], capture_output=True, text=True, timeout=20, check=False)
            why = allowed.stderr.strip() if allowed.returncode else ""
        except OSError as e:
            why = str(e)
        if not why:
            os.environ[INSIDE] = "1"
            os.execvp("unshare", command + [sys.executable, os.path.abspath(sys.argv[0])] + sys.argv[1:])
        reasons.append("unshare %s: %s" % (namespaces, why))
    skip("; ".join(reasons))


def sh(script):
    done = subprocess.run(["sh", "-ec", script], capture_output=True, text=True, timeout=60, check=False)
    if done.returncode != 0:
        raise RuntimeError((done.stderr.strip().splitlines() or ["exit status %d" % done.returncode])[-1])


def own_x_sockets():
    """Hides the sockets of X servers outside. A server detects others in its own network only, and would replace theirs."""
    sh("mkdir -m 1777 -p /tmp/.X11-unix; mount -t tmpfs -o mode=1777 none /tmp/.X11-unix")


class OwnNetwork:
    """The network. {name: address} are the other machines; this one has `here`. All have an eth0 in one /24.
    single_packets: a sender's packets leave its card one by one as on the wire, so each is lost on its own."""

    def __init__(self, here, others, mtu=1500, single_packets=False):
        self.others = others
        try:
            self._build(here, mtu)
            for at in (["ip"] + ["ip -n " + name for name in others]) if single_packets else []:
                sh(at + " link set dev eth0 gso_max_segs 1")
            for name in others:
                self.drop(name, "ip daddr 192.0.2.1")  # tests whether rules can be created
                self.heal(name)
        except (RuntimeError, OSError, subprocess.SubprocessError) as e:
            skip("this machine makes no networks of namespaces: %s" % e)

    def _build(self, here, mtu):
        own_x_sockets()
        sh("mount -t tmpfs none /run; ip netns add switch; ip link set lo up")
        sh("ip -n switch link add bridge mtu %d type bridge stp_state 0 forward_delay 0 mcast_snooping 0" % mtu)
        sh("ip -n switch link set bridge up; ip link add eth0 mtu %d type veth peer name port0 mtu %d netns switch" % (mtu, mtu))
        sh("ip addr add %s/24 dev eth0; ip link set eth0 up; ip -n switch link set port0 master bridge up" % here)
        for number, (name, address) in enumerate(self.others.items(), 1):
            port = "port%d" % number
            sh("ip netns add %s; ip -n %s link set lo up" % (name, name))
            sh("ip -n %s link add eth0 mtu %d type veth peer name %s mtu %d netns switch" % (name, mtu, port, mtu))
            sh("ip -n %s addr add %s/24 dev eth0; ip -n %s link set eth0 up" % (name, address, name))
            sh("ip -n switch link set %s master bridge up" % port)

    def at(self, name, script):
        sh("ip netns exec %s sh -ec '%s'" % (name, script))

    def start(self, name, script):
        """Starts a shell script on that machine, in the background."""
        return subprocess.Popen(["ip", "netns", "exec", name, "sh", "-ec", script], stdin=subprocess.DEVNULL)

    def rules(self, name, card, *rules):
        text = RULES % card + "".join("add rule netdev faults in %s\n" % rule for rule in rules)
        done = subprocess.run(["ip", "netns", "exec", name, "nft", "-f", "-"], input=text, text=True, check=False, timeout=60, capture_output=True)
        if done.returncode != 0:
            raise RuntimeError("nft at %s: %s" % (name, done.stderr.strip()))

    def drop(self, name, what):
        self.rules(name, "eth0", what + " drop")

    def heal(self, name):
        self.at(name, "nft delete table netdev faults")

    def mend(self):
        """Removes all rules and reconnects all cables."""
        for name in ("switch", *self.others):
            self.at(name, "nft flush ruleset")
        for name in self.others:
            self.join(name)

    def port(self, name):
        return "port%d" % (1 + list(self.others).index(name))

    def cut(self, name):
        sh("ip -n switch link set %s down" % self.port(name))

    def join(self, name):
        sh("ip -n switch link set %s up" % self.port(name))

    def detour(self, what):
        """Delays the selected packets of this machine, so that they arrive after packets sent later."""
        sh("ip -n switch link add slow0 mtu 1500 type veth peer name slow1; ip -n switch link set slow0 up")
        sh("ip -n switch link set slow1 master bridge up; tc -n switch qdisc add dev slow0 root tbf rate %s burst 2kb limit 1mb" % DETOUR_RATE)
        # An unused branch: no addresses are learnt from it, nothing is sent to it.
        sh("ip -n switch link set slow1 type bridge_slave learning off flood off mcast_flood off bcast_flood off")
        self.rules("switch", "port0", what + " counter fwd to \"slow0\"")

    def end_detour(self):
        self.at("switch", "nft flush ruleset")
        sh("ip -n switch link del slow0")

    def launch_script(self, path):
        """Returns the command for `--launch`: HOST COMMAND..., with an address as HOST."""
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n# HOST COMMAND...: runs the command on the host, as ssh does\ncase $1 in\n")
            for name, address in self.others.items():
                file.write("%s) machine=%s ;;\n" % (address, name))
            file.write("esac\nshift\nexec ip netns exec $machine sh -c \"$*\"\n")
        os.chmod(path, 0o755)
        return path
