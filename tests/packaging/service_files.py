#!/usr/bin/env python3
"""The files for services are valid: systemd unit, firewalld service, Slurm job, maintainer scripts, changelog.

  service_files.py BUILD
"""
import gzip
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PACKAGING = os.path.join(TOP, 'packaging')
MOST_EXPOSED = 5.0

failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def run(*words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    return done.returncode, done.stdout


def check_unit(build, folder):
    """Returns the exposure that systemd-analyze reports."""
    with open(os.path.join(build, 'packaging', 'mural-node.service'), encoding='utf-8') as file:
        text = file.read()
    expect('@' not in re.sub(r'@(system-service|privileged)', '', text), 'the unit has unset variables')
    # The installed path does not exist here.
    text = re.sub(r'^ExecStart=\S+/mural', 'ExecStart=' + os.path.join(os.path.abspath(build), 'bin', 'mural'), text, flags=re.M)
    path = os.path.join(folder, 'mural-node.service')
    with open(path, 'w', encoding='utf-8') as file:
        file.write(text)
    status, out = run('systemd-analyze', 'verify', '--man=no', path)
    expect(status == 0 and 'mural-node' not in out, 'systemd-analyze verify: %d %s' % (status, out))
    status, out = run('systemd-analyze', 'security', '--offline=yes', '--no-pager', path)
    level = re.search(r'exposure level for mural-node.service: ([\d.]+)', out)
    expect(level and float(level.group(1)) <= MOST_EXPOSED, 'systemd-analyze security: %d %s' % (status, out[-300:]))
    return level.group(1) if level else 'unknown'


def check_changelog(folder):
    out = os.path.join(folder, 'changelog.gz')
    script = os.path.join(PACKAGING, 'debian', 'changelog.py')
    with open(os.path.join(TOP, 'CMakeLists.txt'), encoding='utf-8') as file:
        version = re.search(r'project\(mural VERSION (\S+)', file.read()).group(1)
    status, text = run(sys.executable, script, os.path.join(TOP, 'CHANGELOG.md'), version, 'A B <a@b.org>', out)
    expect(status == 0, 'CHANGELOG.md: %s' % text)
    with gzip.open(out, 'rt', encoding='utf-8') as file:
        text = file.read()
    expect(text.startswith('mural (%s) bookworm; urgency=medium\n\n  * ' % version), 'changelog: %s' % text[:200])
    if shutil.which('dpkg-parsechangelog'):
        plain = os.path.join(folder, 'changelog')
        with open(plain, 'w', encoding='utf-8') as file:
            file.write(text)
        status, parsed = run('dpkg-parsechangelog', '-l', plain)
        expect(status == 0 and 'warning' not in parsed and 'Version: %s\n' % version in parsed, 'dpkg-parsechangelog: %s' % parsed)
    expect(run(sys.executable, script, os.path.join(TOP, 'CHANGELOG.md'), '9.9', 'A B <a@b.org>', out)[0] == 1, 'a version without a section is accepted')


def main():
    build = sys.argv[1]
    service = tree.parse(os.path.join(PACKAGING, 'firewalld', 'mural.xml')).getroot()
    expect(service.tag == 'service' and {port.get('port') for port in service.findall('port')} == {'4276', '4277', '4278', '4279'}, 'firewalld: the ports')
    for script in ('../configs/launch/wall.sbatch', '../configs/launch/wall-pmix.sbatch', 'debian/mural/prerm', 'debian/mural/postrm', 'completion/mural.bash'):
        status, out = run('bash', '-n', os.path.join(PACKAGING, script))
        expect(status == 0, '%s: %s' % (script, out))
    exposure = 'not tested'
    with tempfile.TemporaryDirectory() as folder:
        check_changelog(folder)
        if shutil.which('systemd-analyze'):
            exposure = check_unit(build, folder)
    for failure in failures:
        print(failure)
    print('exposure of the unit: %s, %d failures' % (exposure, len(failures)))
    if failures:
        return 1
    if exposure == 'not tested':
        print('systemd-analyze is not installed')
        return 77
    return 0


sys.exit(main())
