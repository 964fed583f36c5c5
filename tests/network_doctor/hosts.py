#!/usr/bin/env python3
"""mural doctor --nodes on machines that are network namespaces on one bridge. A clean set has no findings. Each planted
fault is found at its host, and nothing else. Every run takes less than 15 s, with an allowance for a loaded machine.

  hosts.py --mural BIN/mural [--cases clean,clock]      exit status 77, with a reason: this machine permits no namespaces
"""
import argparse
import functools
import json
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'end_to_end'))
from harness import display, own_network  # noqa: E402
from harness.own_network import sh  # noqa: E402

HERE = '10.77.0.1'
HOSTS = {'wall1': '10.77.0.2', 'wall2': '10.77.0.3', 'wall3': '10.77.0.4', 'wall4': '10.77.0.5'}
BOUND_S = 15
LOAD_ALLOWANCE_S = 15
# Of a loaded machine without a GPU, not of the planted faults.
NOISE = {'rate to it', 'rate from it', 'buffers'}  # the last depends on the kernel's limit, which namespaces share
WALL_FILE = """
server { config {
  appNode { pipe { window { viewport [ 0 0 64 64 ] channel { name "app" } } } }
  node { host "10.77.0.3" pipe { port %d device 0 viewport [ 0 0 %d %d ] window { channel { name "c" } } } }
  compound { channel "c" }
} }
"""


class Doctor:
    def __init__(self, mural, network, folder):
        self.mural, self.network, self.folder = mural, network, folder
        self.before = {}  # host: commands of a shell before mural starts there

    def launch(self):
        """The launch command: an address, and a command that runs on it after the planted commands."""
        path = os.path.join(self.folder, 'launch')
        cases = ''.join('%s) machine=%s; before="%s" ;;\n' % (address, name, self.before.get(name, ':')) for name, address in HOSTS.items())
        with open(path, 'w', encoding='utf-8') as file:
            file.write('#!/bin/sh\ncase $1 in\n%s*) echo "ssh: Could not resolve hostname $1: Name or service not known" >&2; exit 255 ;;\nesac\n' % cases)
            file.write('shift\nexec ip netns exec $machine sh -c "$before; exec $*"\n')
        os.chmod(path, 0o755)
        return path

    def findings(self, *options, hosts=None, mural=None):
        """Returns {host name: names of its findings}, and an error about the run itself."""
        command = [self.mural, 'doctor', '--nodes', ','.join(hosts or HOSTS.values()), '--launch', self.launch(), '--json', *options]
        if mural:
            command += ['--remote-mural', mural]
        began = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True, timeout=90, stdin=subprocess.DEVNULL)
        took = time.monotonic() - began
        if not done.stdout:
            return {}, 'no report: status %d, %s' % (done.returncode, done.stderr.strip())
        report = json.loads(done.stdout)
        names = {address: name for name, address in HOSTS.items()}
        found = {}
        self.texts = [c['found'] for host in report['hosts'] for c in host['checks'] if c['health'] != 'ok']
        worst = 0
        for host in report['hosts']:
            wrong = [c for c in host['checks'] if c['health'] != 'ok']
            worst = max([worst] + [{'warn': 1, 'bad': 2}[c['health']] for c in wrong])
            for c in wrong:
                print('     %s: %s: %s' % (host['host'], c['name'], c['found']), flush=True)
            if any(not c['advice'] for c in wrong):
                return {}, 'a finding without a remedy: %s' % wrong
            wrong = [c['name'] for c in wrong if c['name'] not in NOISE]
            if wrong:
                found[names.get(host['host'], host['host'])] = wrong
        if took > BOUND_S + LOAD_ALLOWANCE_S:
            return found, 'it took %.1f s' % took
        if done.returncode != worst or report['status'] != ('ok', 'warn', 'bad')[worst]:
            return found, 'status %d, %s' % (done.returncode, report['status'])
        print('   %.1f s %s' % (took, found), flush=True)
        return found, None

    def mural_with_versions(self):
        """A stand-in for mural that reports another version on hosts with OTHER_VERSION."""
        path = os.path.join(self.folder, 'mural')
        with open(path, 'w', encoding='utf-8') as file:
            file.write('#!/bin/sh\n[ -z "$OTHER_VERSION" ] && exec %s "$@"\n' % self.mural)
            file.write('%s "$@" | sed -u -e \'s/"version":"[^"]*"/"version":"0.0.1"/\' -e \'s/"build":"[^"]*"/"build":"1.1.0"/\'\n' % self.mural)
        os.chmod(path, 0o755)
        return path

    def expect(self, wanted, *options, **more):
        found, wrong = self.findings(*options, **more)
        return wrong or (None if found == wanted else 'found %s instead of %s' % (found, wanted))


class Fault:
    """before: commands of a shell on the host before mural starts there. plant, heal: change the network. wanted: names
    of the findings."""

    def __init__(self, wanted, before=None, plant=None, heal=None):
        self.wanted, self.before, self.plant, self.heal = wanted, before, plant, heal


def rule(wanted, what):
    return Fault(wanted, plant=lambda network, host: network.drop(host, what))


FAULTS = {
    'clock ahead': Fault(['clock'], 'export MURAL_TEST_CLOCK_OFFSET_MS=300'),
    'clock behind': Fault(['clock'], 'export MURAL_TEST_CLOCK_OFFSET_MS=-60'),
    'short packets': Fault(['datagram size'], plant=lambda network, host: network.at(host, 'ip link set eth0 mtu 1500'),
                           heal=lambda network, host: network.at(host, 'ip link set eth0 mtu 9000')),
    'no multicast': rule(['multicast'], 'ip daddr 239.0.0.0/8'),
    'no UDP': rule(['datagrams'], 'meta l4proto udp'),
    'no connections to it': rule(['connection to it'], 'tcp flags & (syn | ack) == syn'),
    'no connections from it': rule(['connection from it'], 'tcp flags & (syn | ack) == (syn | ack)'),
    'no EGL': Fault(['EGL'], 'export __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent'),
    'small shared memory': Fault(['/dev/shm'], 'mount -t tmpfs -o size=16m none /dev/shm'),
    'few open files': Fault(['open files'], 'ulimit -n 100'),
    'small disk': Fault(['disk'], 'mount -t tmpfs -o size=20m none /mnt'),
    'not installed': Fault(['start'], 'exec /nonexistent/mural'),
    'password required': Fault(['start'], 'echo \\"user@wall: Permission denied (publickey,password).\\" >&2; exit 255'),
    'never replies': Fault(['start'], 'sleep 300'),
    'prints before its reply': Fault(['start'], 'echo Welcome'),
    'other version': Fault(['version', 'build'], 'export OTHER_VERSION=1'),
}
# Each host has one fault, so findings are attributable.
BATCHES = [
    ('clock ahead', 'short packets', 'no UDP', 'small shared memory'),
    ('no multicast', 'few open files', 'no connections to it', 'no EGL'),
    ('clock behind', 'no connections from it', 'small disk', 'other version'),
    ('not installed', 'password required', 'never replies', 'prints before its reply'),
]


def batch(doctor, network, names):
    faults = dict(zip(HOSTS, (FAULTS[name] for name in names)))
    for host, fault in faults.items():
        if fault.before:
            doctor.before[host] = fault.before
        if fault.plant:
            fault.plant(network, host)
    found, wrong = doctor.findings('--recordings', '/mnt', mural=doctor.mural_with_versions())
    for host, fault in faults.items():
        if fault.heal:
            fault.heal(network, host)
    # Without EGL another GL draws, so driver and version also differ from the other hosts.
    found = {host: [name for name in names if name != 'GL version'] for host, names in found.items()}
    wanted = {host: fault.wanted for host, fault in faults.items()}
    return wrong or (None if found == wanted else 'found %s instead of %s' % (found, wanted))


def clean(doctor, _):
    return doctor.expect({})


def text(doctor, _):
    """The table, and one line per finding."""
    doctor.before['wall2'] = 'ulimit -n 64'
    done = subprocess.run([doctor.mural, 'doctor', '--nodes', ','.join(HOSTS.values()), '--launch', doctor.launch()], capture_output=True, text=True, timeout=90)
    lines = done.stdout.splitlines()
    good = done.returncode == 1 and lines[0].split()[0] == 'check' and any(line.startswith('open files') for line in lines) and any(line.startswith('warn %s: open files: at most 64 -> `ulimit -n' % HOSTS['wall2']) for line in lines)
    return None if good else 'status %d: %s %s' % (done.returncode, done.stdout, done.stderr)


def unknown_host(doctor, _):
    wrong = doctor.expect({'10.77.0.99': ['start']}, hosts=[HOSTS['wall1'], '10.77.0.99'])
    return wrong or (None if any('Could not resolve hostname' in text for text in doctor.texts) else 'the reason is missing: %s' % doctor.texts)


def screen(doctor, _):
    """An X display of another size than in the file, then of the right size."""
    with display.PrivateDisplay(size='1280x1024x24') as name:
        number = int(name.lstrip(':').split('.')[0])
        path = os.path.join(doctor.folder, 'wall.eqc')
        for width, wanted in ((1280, {}), (1920, {'wall2': ['screen :%d.0' % number]})):
            with open(path, 'w', encoding='utf-8') as file:
                file.write(WALL_FILE % (number, width, 1024))
            wrong = doctor.expect(wanted, '--config', path, hosts=[HOSTS['wall1'], HOSTS['wall2']])
            if wrong:
                return '%d pixels in the file: %s' % (width, wrong)
    return None


def bad_config(doctor, _):
    done = subprocess.run([doctor.mural, 'doctor', '--nodes', 'x', '--config', '/nonexistent.eqc'], capture_output=True, text=True, timeout=60)
    return None if done.returncode == 2 and done.stderr.count('\n') == 1 else '%d %s' % (done.returncode, done.stderr)


CASES = {f.__name__: f for f in (clean, text, unknown_host, screen, bad_config)}
CASES.update({'faults%d' % i: functools.partial(batch, names=names) for i, names in enumerate(BATCHES)})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--mural', required=True)
    parser.add_argument('--cases', default=','.join(CASES))
    a = parser.parse_args()
    own_network.enter(own_processes=True)
    network = own_network.OwnNetwork(HERE, HOSTS, mtu=9000)
    sh('mount -t tmpfs none /mnt')
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        os.environ.pop('DISPLAY', None)
        doctor = Doctor(os.path.abspath(a.mural), network, folder)
        for name in a.cases.split(','):
            try:
                wrong = CASES[name](doctor, network)
            except (RuntimeError, ValueError, subprocess.SubprocessError) as e:
                wrong = repr(e)
            doctor.before = {}
            network.mend()
            failed += wrong is not None
            print('%s: %s' % (name, 'ok' if wrong is None else 'FAILED: ' + wrong), flush=True)
    sys.exit(1 if failed else 0)


main()
