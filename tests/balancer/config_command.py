#!/usr/bin/env python3
"""Tests the command mural config: exit statuses, one line per fault, output that can be parsed again, drawings in valid XML.

  config_command.py MURAL CONFIGS    the binary; a folder of configurations without a fault
"""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

failures = []


def run(*arguments):
    done = subprocess.run([sys.argv[1], 'config', *arguments], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


def expect(holds, what):
    if not holds:
        failures.append(what)


def good(path):
    status, out, err = run('check', path)
    expect(status == 0 and '0 errors, 0 warnings' in out and not err, 'check %s: %d %s %s' % (path, status, out, err))
    status, text, err = run('print', path)
    expect(status == 0 and not err, 'print %s: %d %s' % (path, status, err))
    with tempfile.TemporaryDirectory() as folder:
        again = os.path.join(folder, 'again.eqc')
        with open(again, 'w', encoding='utf-8') as f:
            f.write(text)
        expect(run('print', again)[1] == text, 'print %s, and again, differs' % path)
        picture = os.path.join(folder, 'picture.svg')
        status, out, err = run('draw', path, '--out', picture)
        expect(status == 0 and not out + err, 'draw %s: %d %s%s' % (path, status, out, err))
        expect(tree.parse(picture).getroot().tag.endswith('svg'), 'draw %s is no SVG' % path)
    status, out, err = run('print', path, '--resolved', '--frame', '1')
    expect(status == 0 and out.startswith('frame 1\n') and 'draw' in out, 'print --resolved %s: %d %s' % (path, status, err))


def bad():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'bad.eqc')

        def lines(text, *options):
            with open(path, 'w', encoding='utf-8') as f:
                f.write(text)
            status, out, _ = run('check', path, *options)
            return status, out.replace(path, 'F').split('\n')

        status, out = lines('config {\n  latency x\n}')
        expect(status == 2 and out[0].startswith('error: F:2:11: latency can'), 'a wrong value: %s' % out)
        status, out = lines('config { latancy 3 }')
        expect(status == 0 and out[0].startswith('warning: F:1:10: section config has no field latancy'), 'a warning: %s' % out)
        expect(lines('config { latancy 3 }', '--strict')[0] == 2, '--strict takes a warning for none')
        status, _, err = run('draw', path, '--out', folder)
        expect(status == 1 and err.strip().split('\n')[-1].startswith('mural config: %s cannot be written' % folder), 'an output that is a folder: %d %s' % (status, err))
        status, _, err = run('print', path, '--resolved', '--layout', 'none')
        expect(status == 2 and 'no canvas has a layout none' in err, 'a layout that is not there: %s' % err)
    status, out, _ = run('check', '/nonexistent.eqc')
    expect(status == 2 and out.startswith("error: /nonexistent.eqc: cannot be read"), 'a file that is not there: %s' % out)
    expect(run('chek', '/nonexistent.eqc')[0] == 2, 'a verb that does not exist')
    for words, output in ((('print', files[0], '--resolved', '--frame', '-3'), '--frame'), (('print', files[0], '--frame', '2'), 'require print --resolved'),
                        (('draw', files[0], '--resolved'), '--resolved requires print'), (('check', files[0], '--out', 'x'), '--out requires print or draw')):
        status, out, err = run(*words)
        expect(status == 2 and not out and output in err and err.count('\n') == 1, '%s: %d %s' % (' '.join(words), status, err))
    # Each word of a file that is no configuration causes a warning; the error must still be visible.
    with tempfile.TemporaryDirectory() as folder:
        foreign = os.path.join(folder, 'foreign')
        with open(foreign, 'w', encoding='utf-8') as file:
            file.writelines('user%d:x:home\n' % i for i in range(40))
        status, out, _ = run('check', foreign)
    warnings = out.count('\nwarning: ') + out.startswith('warning: ')
    expect(status == 2 and warnings == 10 and 'more warnings are not shown' in out and 'error: ' in out, 'a foreign file: %d warnings, %s' % (warnings, out[-300:]))


files = sorted(os.path.join(sys.argv[2], f) for f in os.listdir(sys.argv[2]) if f.endswith('.eqc'))
expect(len(files) >= 10, 'no configurations in %s' % sys.argv[2])
for name in files:
    good(name)
bad()
print('\n'.join(failures) or '%d files' % len(files))
sys.exit(1 if failures else 0)
