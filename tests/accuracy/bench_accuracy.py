#!/usr/bin/env python3
"""Tests mural bench accuracy from the user's side: its bounds hold, its files agree with its table, and it detects a
fault.

bench_accuracy.py MURAL [CASE...]
"""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'end_to_end'))

from harness import length
from harness.processes import processes_with, until

START_SECONDS, END_SECONDS = 60, 60

failures = []


def environment_with(**more):
    return {**{name: value for name, value in os.environ.items() if name not in ('DISPLAY', 'MURAL_PLANT')}, **more}


def run(*arguments, plant=None):
    environment = environment_with(MURAL_PLANT=plant) if plant else environment_with()
    done = subprocess.run([sys.argv[1], 'bench', *arguments], capture_output=True, text=True, timeout=400, env=environment)
    return done.returncode, done.stdout, done.stderr


def expect(holds, what):
    if not holds:
        failures.append(what)


def rows_of(path):
    with open(path, encoding='utf-8') as f:
        return json.load(f)


def recorded(folder):
    """Returns the path of a trace of the scenes."""
    recording = os.path.join(folder, 'scenes.mural')
    scenes = os.path.join(os.path.dirname(os.path.abspath(sys.argv[1])), 'mural-scenes')
    if not os.path.exists(recording):
        subprocess.run([sys.argv[1], 'run', '--quiet', '--display', 'none', '--size', '800x600', '--record', recording, '--', scenes, '--size', '253x191', '--frames', '6'],
                       timeout=120, check=True, env=environment_with())
    return recording


def quick(folder):
    files = os.path.join(folder, 'a.json'), os.path.join(folder, 'a.svg')
    recording = recorded(folder)
    status, out, err = run('accuracy', '--quick', '--recording', recording, '--json', files[0], '--svg', files[1])
    print(out)
    expect(status == 0, 'status %d: %s' % (status, err))
    report = rows_of(files[0])
    rows = report['rows']
    expect(report['holds'] and all(row['holds'] for row in rows), 'broken: %s' % [row['what'] for row in rows if not row['holds']])
    expect(all(row['pixels'] > 0 for row in rows), 'rows without pixels')
    exact = [row for row in rows if row['bound'] == {'differingShare': 0}]
    for kind in ('2D', 'DB', 'DPlex', 'mixed', 'pixel', 'stereo', 'zoom'):
        expect(any(row['what'].startswith(kind) for row in rows), 'nothing of %s was measured' % kind)
    expect(len(exact) >= 10 and all(row['differingPixels'] == 0 and row['psnr'] is None for row in exact), '%d exact ones' % len(exact))
    # Approximations must have a visible effect: a kernel or an eye without any wrong pixel did nothing.
    for kind in ('pixel, kernel of 2x2: triangles', 'zoom of 0.5: triangles', 'yuv420'):
        expect(any(row['what'].startswith(kind) and row['differingPixels'] > 0 for row in rows), '%s changed nothing' % kind)
    expect('%d measured, 0 broken, 0 failed' % len(rows) in out, 'the table differs')
    # Costs of recordings, codecs and blending. More samples are closer to the reference and cost more.
    costs = {row['what']: row for row in rows if row['group'] == 'Recording: scenes'}
    expect(all(row['cpuNsPerPixel'] > 0 and row['bytesPerPixel'] > 0 for row in costs.values()) and len(costs) >= 5, 'costs of the recording: %s' % list(costs))
    one, two = costs.get('one sample'), costs.get('2 samples')
    expect(one and two and two['rootMeanSquare'] < one['rootMeanSquare'] and two['bytesPerPixel'] > one['bytesPerPixel'], 'samples: %s, %s' % (one, two))
    expect(any('cpuNsPerPixel' in row for row in rows if row['what'].startswith('bitplane')), 'codecs without times')
    svg = tree.parse(files[1]).getroot()
    texts = [''.join(t.itertext()) for t in svg.iter('{http://www.w3.org/2000/svg}text')]
    tips = list(svg.iter('{http://www.w3.org/2000/svg}title'))
    expect(all(any(text.rstrip('…') in row['what'] for text in texts if len(text) > 5) for row in rows), 'rows that are not drawn')
    expect(len(tips) >= len(rows), '%d dots for %d rows' % (len(tips), len(rows)))


def program(folder):
    """Measures a program of the user, and the same with a tile read one pixel off."""
    scenes = os.path.join(os.path.dirname(os.path.abspath(sys.argv[1])), 'mural-scenes')
    path = os.path.join(folder, 'p.json')
    words = 'accuracy', '--quick', '--frames', '6', '--json', path, '--', scenes, '--size', '253x191', '--frames', '6'
    status, out, err = run(*words)
    expect(status == 0 and rows_of(path)['holds'], 'a program: %d %s %s' % (status, out, err))
    expect(rows_of(path)['rows'][0]['pixels'] == 6 * 253 * 191, 'not all of its frames were compared: %s' % out)
    status, out, err = run(*words, plant='shift')
    rows = rows_of(path)['rows']
    expect(status == 1 and 'BROKEN' in out, 'a shifted tile was not seen: %d %s %s' % (status, out, err))
    expect(rows[0]['differingPixels'] > 0 and rows[0]['psnr'] < 60, 'a shifted tile is measured as %s' % rows[0])


def refused(folder):
    for words, wanted in ((('accuracy', '--'), 'the program after -- is missing'), (('speed',), 'speed'), (('accuracy', '--frames', '0'), '--frames')):
        status, out, err = run(*words)
        expect(status == 2 and wanted in err and err.count('\n') == 1 and not out, '%s: %d %s %s' % (words, status, out, err))
    refused_before(folder)
    # A program that can be run, but draws nothing.
    status, out, err = run('accuracy', '--quick', '--', 'true')
    expect(status == 2 and '\n0 measured, 0 broken, 3 failed\n' in out, 'a program that draws nothing: %d %s %s' % (status, out, err))


def refused_before(folder):
    """Checks that invalid requests are rejected before any measurement, with one line."""
    left, kept, lost = (os.path.join(folder, name) for name in ('left.json', 'kept.json', os.path.join('none', 'a')))
    damaged = os.path.join(folder, 'damaged.mural')
    with open(kept, 'w', encoding='utf-8') as f:
        f.write('of last week')
    with open(recorded(folder), 'rb') as whole, open(damaged, 'wb') as f:
        content = whole.read()
        middle = len(content) // 2
        f.write(content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1:])
    for words, wanted in ((('--', 'mural-no-such-program'), 'was not found in PATH'), (('--', lost), 'No such file or directory'), (('--', kept), 'is not executable'),
                          (('--recording', damaged, '--', 'true'), 'omit --recording or the program'), (('--recording', '/etc/passwd'), 'is not a trace of Mural'),
                          (('--recording', damaged), 'is damaged'), (('--recording', lost), "cannot be read"),
                          (('--json', lost), "--json %s cannot be written: No such file" % lost), (('--svg', folder), 'Is a directory'),
                          (('--json', left, '--svg', lost), "--svg %s cannot be written" % lost), (('--json', kept, '--svg', lost), "--svg %s cannot be written" % lost),
                          (('--json', left, '--', lost), 'No such file or directory')):
        status, out, err = run('accuracy', '--quick', *words)
        expect(status == 2 and wanted in err and err.count('\n') == 1 and not out, '%s: %d %s %s' % (words, status, out, err))
    expect(not os.path.exists(left), 'an empty file is left over')
    with open(kept, encoding='utf-8') as f:
        expect(f.read() == 'of last week', 'a file is emptied before there is anything to write')


def start(folder, *words):
    """Starts a bench that is identified by its folder for temporary files."""
    inside = tempfile.mkdtemp(dir=folder)
    process = subprocess.Popen([sys.argv[1], 'bench', 'accuracy', *words], env=environment_with(TMPDIR=inside), text=True, start_new_session=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               preexec_fn=lambda: [signal.signal(number, signal.SIG_DFL) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)])
    return process, inside


def check_end(process, inside, name, status, result):
    """Checks the output and that nothing remains."""
    try:
        out, err = process.communicate(timeout=END_SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        failures.append('%s: it continues for %d s' % (name, END_SECONDS))
        return ''
    expect(process.returncode == status and not out, '%s: status %d instead of %d; %s %s' % (name, process.returncode, status, out, err))
    expect(not os.listdir(inside), '%s: these are left: %s' % (name, os.listdir(inside)))
    expect(not os.path.exists(result), '%s: an empty file is left' % name)
    # a killed process disappears a moment later
    expect(until(lambda: not processes_with(inside), 2), '%s: these go on: %s' % (name, processes_with(inside)))
    return err


def stopped(folder):
    """Sends a signal while a process with the given command line runs. Ctrl-C reaches all processes of a terminal."""
    result = os.path.join(folder, 'stopped.json')
    # A short run sends SIGTERM only to the program that ignores it.
    ignoring = '--', 'sh', '-c', 'trap "" INT TERM; while :; do sleep 0.1; done'
    for name, number, send, words, awaited in (('Ctrl-C, and a scene', signal.SIGINT, os.killpg, (), r'mural-scenes '),
                                               ('SIGINT, and mural run', signal.SIGINT, os.kill, ('--quick',), r' run --quiet '),
                                               ('SIGTERM, and mural run', signal.SIGTERM, os.kill, ('--quick',), r' run --quiet '),
                                               ('SIGHUP, and mural run', signal.SIGHUP, os.kill, ('--quick',), r' run --quiet '),
                                               ('SIGTERM, and a program that ignores it', signal.SIGTERM, os.kill, ignoring, r'^sh -c trap')):
        if not length.LONG and name == 'SIGTERM, and mural run':
            continue
        process, inside = start(folder, '--json', result, *words)
        if not until(lambda: any(re.search(awaited, line) for line in processes_with(inside).values()), START_SECONDS):
            failures.append('%s: there was no such process within %d s' % (name, START_SECONDS))
        send(process.pid, number)
        err = check_end(process, inside, name, 128 + number, result)
        expect(err.endswith('mural bench accuracy: the measurement was interrupted; nothing is written\n'), '%s: it prints %s' % (name, err))


def unread(folder):
    """Closes the reader of the output: the bench ends like other programs, and leaves nothing behind, either."""
    result = os.path.join(folder, 'unread.json')
    process, inside = start(folder, '--quick', '--json', result)
    process.stderr.readline()
    process.stderr.close()
    process.stderr = None
    check_end(process, inside, 'nobody reads', 128 + signal.SIGPIPE, result)


CASES = {case.__name__: case for case in (quick, program, refused, stopped, unread)}
with tempfile.TemporaryDirectory() as scratch:
    for name in sys.argv[2:] or CASES:
        CASES[name](scratch)
for failure in failures:
    print('FAILED:', failure)
sys.exit(1 if failures else 0)
