#!/usr/bin/env python3
"""mural doctor --network between two machines: network namespaces on one bridge, in a user namespace, so that no
privileges are needed. Each fault is planted, and must be reported.

  two_machines.py --mural BIN/mural        exit status 77, with a reason: this machine permits no namespaces
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'end_to_end'))
from harness import own_network  # noqa: E402
from harness.own_network import sh  # noqa: E402

HERE, THERE = '10.78.0.1', '10.78.0.2'


class Doctor:
    def __init__(self, mural, launch):
        self.mural, self.launch = mural, launch

    def diagnose(self, *options):
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


def cases(doctor, network):
    def there(script):
        network.at('there', script)

    def drop(what):
        network.drop('there', what)

    def heal():
        network.heal('there')

    report, host = doctor.diagnose()
    yield check('a good network', not bad(report) and host['stream']['multicast'] and host['ways']['group']['largestBytes'] == 8972, report)

    there('ip link set eth0 mtu 1500')
    report, host = doctor.diagnose()
    yield check('a card with short packets', bad(report) == ['datagram size'] and host['ways']['group']['largestBytes'] == 1472 and host['stream']['multicast'], report)
    there('ip link set eth0 mtu 9000')
    sh('ip -n switch link set port1 mtu 4000')
    report, host = doctor.diagnose()
    yield check('a switch with shorter packets', bad(report) == ['datagram size'] and 3968 <= host['ways']['group']['largestBytes'] <= 3976, report)
    sh('ip -n switch link set port1 mtu 9000')

    drop('ip daddr 239.0.0.0/8')
    report, host = doctor.diagnose()
    reported = [c for c in host['checks'] if c['name'].endswith('multicast')][0]
    yield check('a switch that lets no group through', bad(report) == ['multicast'] and 'querier' in reported['advice'] and host['reachedBy'] == 'TCP only', report)
    heal()
    drop('ip daddr 224.0.0.0/4')
    report, host = doctor.diagnose()
    reported = [c for c in host['checks'] if c['name'].endswith('multicast')][0]
    yield check('no multicast', bad(report) == ['multicast'] and 'no multicast arrives' in reported['found'] and host['stream']['mbit'] > 0, report)
    heal()
    drop('meta l4proto udp')
    report, host = doctor.diagnose()
    yield check('no UDP', bad(report) == ['datagrams'], report)
    heal()
    drop('meta l4proto udp numgen random mod 100 < 5')
    report, host = doctor.diagnose()
    yield check('one datagram of twenty is lost', bad(report) == ['stream'] and 0.02 < host['stream']['lostShare'] < 0.09, report)
    heal()
    drop('tcp flags & syn == syn')
    report, host = doctor.diagnose()
    yield check('no connections', bad(report) == ['connection'], report)
    heal()
    report, host = doctor.diagnose('--launch', 'false')
    yield check('a host that can not be started', bad(report) == ['start'], report)
    report, host = doctor.diagnose()
    yield check('healed', not bad(report), report)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--mural', required=True)
    a = parser.parse_args()
    own_network.enter(own_processes=True)
    network = own_network.OwnNetwork(HERE, {'there': THERE}, mtu=9000)
    with tempfile.TemporaryDirectory() as folder:
        doctor = Doctor(os.path.abspath(a.mural), network.launch_script(os.path.join(folder, 'launch')))
        sys.exit(0 if all(list(cases(doctor, network))) else 1)


main()
