#!/usr/bin/env python3
"""Nodes without ssh: mural call finds and starts daemons (mural node --wait), which draw the same as local nodes.

daemons.py --build BUILD
"""
import argparse
import filecmp
import json
import os
import subprocess
import sys
import tempfile
import time

HOST = '127.0.0.2'  # an address of this machine without a daemon of its user
FRAMES = '3'


def lines_of(process, wanted, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        line = process.stderr.readline()
        if wanted in line:
            return line
    raise RuntimeError('the daemon did not print "%s"' % wanted)


def run(command, seconds=90):
    return subprocess.run(command, capture_output=True, text=True, timeout=seconds, stdin=subprocess.DEVNULL)


class Case:
    def __init__(self, build, folder):
        self.mural = os.path.join(build, 'bin', 'mural')
        self.program = os.path.join(build, 'tests', 'programs', 'immediate')
        self.folder = folder
        self.good = True

    def check(self, what, holds, more=''):
        print('%s: %s' % (what, 'ok' if holds else 'FAILED ' + more), flush=True)
        self.good = self.good and holds

    def secret(self, name):
        path = os.path.join(self.folder, name)
        with open(path, 'w', encoding='ascii') as f:
            f.write(os.urandom(32).hex())
        os.chmod(path, 0o600)
        return path

    def pictures(self, name, *options):
        out = os.path.join(self.folder, name)
        done = run([self.mural, 'run', '--display', 'none', '--size', '200x150', '--frames', FRAMES, '--out', out, *options, '--', self.program, '--frames', FRAMES])
        return done, out

    def call(self, secret):
        return '%s call --secret %s' % (self.mural, secret)

    def perform(self):
        secret, wrong = self.secret('key'), self.secret('other_key')
        with subprocess.Popen([self.mural, 'node', '--wait', '--secret', secret, '--listen', HOST + ':4279', '--discovery', 'beacon', '--name', 'test%d' % os.getpid()],
                              stderr=subprocess.PIPE, text=True) as node:
            try:
                lines_of(node, 'waits for heads', 20)
                local, expected = self.pictures('local', '--local-nodes', '2')
                self.check('local nodes', local.returncode == 0, local.stderr)
                waiting, drawn = self.pictures('waiting', '--nodes', '%s,%s' % (HOST, HOST), '--launch', self.call(secret))
                self.check('daemons', waiting.returncode == 0, waiting.stderr)
                names = sorted(os.listdir(expected))
                same = filecmp.cmpfiles(expected, drawn, names, shallow=False)[0]
                self.check('they draw the same', len(names) == int(FRAMES) and sorted(same) == names, str(names))
                refused, _ = self.pictures('refused', '--nodes', HOST, '--launch', self.call(wrong))
                self.check('not without the secret', refused.returncode != 0 and 'secret' in refused.stderr, refused.stderr)
                found = run([self.mural, 'discover', '--seconds', '3', '--no-avahi', '--json'])
                mine = [n for n in json.loads(found.stdout)['nodes'] if n['name'] == 'test%d' % os.getpid()]
                self.check('it is found', len(mine) == 1 and mine[0]['port'] == 4279, found.stdout)
            finally:
                node.terminate()
                node.wait(20)
        self.check('it ends on SIGTERM', node.returncode == 0, str(node.returncode))
        found = run([self.mural, 'discover', '--seconds', '0.5', '--no-avahi', '--json'])
        self.check('its announcement has ended', 'test%d"' % os.getpid() not in found.stdout, found.stdout)
        self.perform_by_name(secret, expected, names)
        return self.good

    def perform_by_name(self, secret, expected, names):
        name = 'named%d' % os.getpid()
        command = [self.mural, 'node', '--wait', '--secret', secret, '--listen', ':0', '--discovery', 'beacon', '--name', name]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as node:
            try:
                lines_of(node, 'waits for heads', 20)
                done, drawn = self.pictures('by_name', '--nodes', '@' + name, '--tiles', '2x1', '--launch', self.call(secret) + ' --discovery beacon')
                self.check('a node that is called by its name', done.returncode == 0, done.stderr)
                self.check('it draws the same', sorted(filecmp.cmpfiles(expected, drawn, names, shallow=False)[0]) == names)
            finally:
                node.terminate()
                node.wait(20)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--build', required=True)
    with tempfile.TemporaryDirectory() as folder:
        sys.exit(0 if Case(parser.parse_args().build, folder).perform() else 1)


main()
