#!/usr/bin/env python3
"""mural doctor --network between two machines: network namespaces on one bridge, in a namespace of users of its own, so that
no rights are needed. Each fault is made, and must be told.

  two_machines.py --mural BIN/mural        exit status 77: this machine allows no namespaces, and why
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

HERE, THERE = '10.78.0.1', '10.78.0.2'
SKIP = 77

# The doctor's machine is the namespace that this runs in; "switch" and "there" are two more.
LAYOUT = '''
mount -t tmpfs none /run
ip netns add switch
ip netns add there
ip link set lo up
ip link add eth0 type veth peer name port0 netns switch
ip -n there link add eth0 type veth peer name port1 netns switch
ip -n switch link add bridge type bridge stp_state 0 forward_delay 0 mcast_snooping 0
for port in port0 port1; do ip -n switch link set $port mtu 9000 master bridge up; done
ip -n switch link set bridge mtu 9000 up
ip link set eth0 up mtu 9000
ip addr add %s/24 dev eth0
ip -n there link set lo up
ip -n there link set eth0 up mtu 9000
ip -n there addr add %s/24 dev eth0
''' % (HERE, THERE)

# What is cut at the other machine; netdev rules see all that comes in, as a switch would.
RULES = '''
add table netdev faults
add chain netdev faults in { type filter hook ingress device "eth0" priority 0; }
add rule netdev faults in %s drop
'''


def sh(script):
    done = subprocess.run(['sh', '-ec', script], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        raise RuntimeError((done.stderr.strip().splitlines() or ['exit status %d' % done.returncode])[-1])


def there(script):
    sh("ip netns exec there sh -ec '%s'" % script)


def drop(what):
    rules = RULES % what
    subprocess.run(['ip', 'netns', 'exec', 'there', 'nft', '-f', '-'], input=rules, text=True, check=True, timeout=60, capture_output=True)


def heal():
    there('nft delete table netdev faults')


class Doctor:
    def __init__(self, mural, folder):
        self.mural = mural
        self.launch = os.path.join(folder, 'launch')
        with open(self.launch, 'w', encoding='utf-8') as f:
            f.write('#!/bin/sh\n# HOST COMMAND...: runs it there, as ssh would\nshift\nexec ip netns exec there sh -c "$*"\n')
        os.chmod(self.launch, 0o755)

    def ask(self, *options):
        command = [self.mural, 'doctor', '--network', THERE, '--launch', self.launch, '--seconds', '0.3', '--rate', '200mbit', '--json', *options]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        if not done.stdout:
            raise RuntimeError('no report: exit status %d, %s' % (done.returncode, done.stderr.strip()))
        report = json.loads(done.stdout)
        if (done.returncode == 0) != report['usable']:
            raise RuntimeError('exit status %d, usable %s' % (done.returncode, report['usable']))
        return report, report['hosts'][0]


def bad(report):
    return [c['name'].split(': ')[-1] for h in report['hosts'] for c in h['checks'] if c['health'] == 'bad']


def check(what, holds, report):
    print('%s: %s' % (what, 'ok' if holds else 'FAILED'), flush=True)
    if not holds:
        print(json.dumps(report, indent=1))
    return holds


def cases(doctor):
    report, host = doctor.ask()
    yield check('a good network', not bad(report) and host['stream']['multicast'] and host['ways']['group']['largestBytes'] == 8972, report)

    there('ip link set eth0 mtu 1500')
    report, host = doctor.ask()
    yield check('a card with short packets', bad(report) == ['datagram size'] and host['ways']['group']['largestBytes'] == 1472 and host['stream']['multicast'], report)
    there('ip link set eth0 mtu 9000')
    sh('ip -n switch link set port1 mtu 4000')
    report, host = doctor.ask()
    yield check('a switch with shorter packets', bad(report) == ['datagram size'] and 3968 <= host['ways']['group']['largestBytes'] <= 3976, report)
    sh('ip -n switch link set port1 mtu 9000')

    drop('ip daddr 239.0.0.0/8')
    report, host = doctor.ask()
    told = [c for c in host['checks'] if c['name'].endswith('multicast')][0]
    yield check('a switch that lets no group through', bad(report) == ['multicast'] and 'querier' in told['advice'] and host['reachedBy'] == 'TCP only', report)
    heal()
    drop('ip daddr 224.0.0.0/4')
    report, host = doctor.ask()
    told = [c for c in host['checks'] if c['name'].endswith('multicast')][0]
    yield check('no multicast', bad(report) == ['multicast'] and 'no multicast arrives' in told['found'] and host['stream']['mbit'] > 0, report)
    heal()
    drop('meta l4proto udp')
    report, host = doctor.ask()
    yield check('no UDP', bad(report) == ['datagrams'], report)
    heal()
    drop('meta l4proto udp numgen random mod 100 < 5')
    report, host = doctor.ask()
    yield check('one datagram of twenty is lost', bad(report) == ['stream'] and 0.02 < host['stream']['lostShare'] < 0.09, report)
    heal()
    drop('tcp flags & syn == syn')
    report, host = doctor.ask()
    yield check('no connections', bad(report) == ['connection'], report)
    heal()
    report, host = doctor.ask('--launch', 'false')
    yield check('a host that can not be started', bad(report) == ['start'], report)
    report, host = doctor.ask()
    yield check('healed', not bad(report), report)


def inside(mural):
    try:
        sh(LAYOUT)
        drop('ip daddr 192.0.2.1')
        heal()
    except (RuntimeError, OSError, subprocess.SubprocessError) as e:
        print('skipped: this machine makes no networks of namespaces: %s' % e)
        return SKIP
    with tempfile.TemporaryDirectory() as folder:
        return 0 if all(list(cases(Doctor(mural, folder)))) else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--mural', required=True)
    parser.add_argument('--inside', action='store_true', help='used by the script itself')
    a = parser.parse_args()
    if a.inside:
        sys.exit(inside(a.mural))
    try:
        allowed = subprocess.run(['unshare', '-Urnm', 'true'], capture_output=True, text=True, timeout=20)
        why = allowed.stderr.strip() if allowed.returncode else ''
    except OSError as e:
        why = str(e)
    if why:
        print('skipped: unshare -Urnm: %s' % why)
        sys.exit(SKIP)
    # In a process group of its own, so that all of it ends with the test.
    os.execvp('unshare', ['unshare', '-Urnm', '--kill-child', '--pid', '--fork', sys.executable, os.path.abspath(__file__), '--mural', os.path.abspath(a.mural), '--inside'])


main()
