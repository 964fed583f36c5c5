#!/usr/bin/env python3
"""mural app-report on programs of each kind: exact ones, and programs that bypass Mural, draw nothing, crash, hang, print
without end, leave processes or need a network. Each report is bounded in time, and leaves no process.

  app_report.py --mural BIN/mural --programs BUILD/tests/programs [--cases exact,hang]
"""
import argparse
import concurrent.futures
import itertools
import json
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'end_to_end'))
from harness import processes  # noqa: E402

SECONDS = 1.5
LOAD_ALLOWANCE = 20  # a loaded machine starts processes slowly; the bound itself is seconds * 4 + 20
EXACT, DIFFERENCES, ALONE, NOT_CAPTURABLE = 'works, exact', 'works, with differences', 'runs alone', 'not capturable'
STATUS = {EXACT: 0, DIFFERENCES: 1, ALONE: 2, NOT_CAPTURABLE: 2}


class Lab:
    def __init__(self, arguments, folder):
        self.mural, self.programs, self.folder = os.path.abspath(arguments.mural), os.path.abspath(arguments.programs), folder
        self.numbers = itertools.count(1)

    def run(self, program, seconds=SECONDS, options=(), file=None):
        """Returns the report, and an error about the run itself."""
        number = next(self.numbers)
        mark = 'APP_REPORT_TEST=%d.%03d' % (os.getpid(), number)  # no mark is the beginning of another one
        file = file or os.path.join(self.folder, '%d.json' % number)
        words = [word.replace('{programs}', self.programs) for word in program]
        command = [self.mural, 'app-report', '--seconds', str(seconds), '--json', file, *options, '--', *words]
        began = time.monotonic()
        try:
            done = subprocess.run(command, env=dict(os.environ, **dict([mark.split('=')])), capture_output=True, text=True, errors='replace', timeout=seconds * 4 + 20 + LOAD_ALLOWANCE)
        except subprocess.TimeoutExpired:
            return {}, 'it took longer than %g s' % (seconds * 4 + 20 + LOAD_ALLOWANCE)
        took = time.monotonic() - began
        left = processes.processes_with(mark)
        if left:
            return {}, 'processes remain: %s' % left
        if not os.path.exists(file):
            return {}, 'no report: status %d, %s' % (done.returncode, done.stderr[-500:])
        with open(file, encoding='utf-8') as stream:
            report = json.load(stream)
        if done.returncode != STATUS[report['verdict']]:
            return report, 'status %d with the verdict %s' % (done.returncode, report['verdict'])
        if report['verdict'] not in done.stdout or len(done.stdout) > 20000:
            return report, 'odd text: %s' % done.stdout[:500]
        print('   %.1f s, %s: %s' % (took, report['verdict'], report['sentence'][:150]), flush=True)
        return report, None


def fact(report, section, key):
    return report['sections'].get(section, {}).get('facts', {}).get(key)


def expect(lab, program, verdict, words=(), **more):
    report, wrong = lab.run(program, **more)
    if wrong:
        return wrong
    if report['verdict'] != verdict or any(word not in report['sentence'] for word in words):
        return 'verdict %s, "%s"; expected %s with %s' % (report['verdict'], report['sentence'], verdict, list(words))
    return None


def exact(lab):
    page = os.path.join(lab.folder, 'app.html')
    report, wrong = lab.run(['{programs}/long_run', '--frames', '100000', '--size', '250x190'], seconds=2.5, options=['--html', page])
    if wrong or report['verdict'] != EXACT:
        return wrong or report['sentence']
    with open(page, encoding='utf-8') as stream:
        html = stream.read()
    pictures = html.count('data:image/png;base64,')
    if pictures != 2 or 'http' in html or report['recommended'].replace('"', '') not in html:
        return 'the page has %d pictures, %d bytes' % (pictures, len(html))
    runs = {run['name']: run for run in report['runs']}
    # Every statement equals the report of its run.
    tiles = runs['tiles']['report']
    value = fact(report, 'divisions', 'tiles')['value']
    pairs = [(value['pixels'], tiles['verifiedPixels']), (value['differing'], tiles['differingPixels']),
             (fact(report, 'traffic', 'sentBytesPerFrame')['value'], tiles['bytesPerFrame']),
             (fact(report, 'speed', 'nativeFramesPerSecond')['value'], runs['native']['report']['framesPerSecond']),
             (fact(report, 'speed', 'muralFramesPerSecond')['value'], runs['balance']['report']['framesPerSecond']),
             (fact(report, 'traffic', 'nodeMemoryBytes')['value'], max(node['peakMemoryBytes'] for node in tiles['nodes']))]
    if any(a != b for a, b in pairs):
        return 'statements differ from the runs: %s' % pairs
    if fact(report, 'traffic', 'nodeMemoryBytes')['value'] < 1e7:
        return 'a node of less than 10 MB'
    return None


def own_status(lab):
    """A program that ends by itself keeps its exit status in the report."""
    report, wrong = lab.run(['sh', '-c', '{programs}/long_run --frames 20 --size 100x100; exit 7'], seconds=8)
    if wrong:
        return wrong
    ends = [fact(report, 'ends', name)['value'] for name in ('native', 'tiles')]
    return None if all(end and end['exitStatus'] == 7 for end in ends) and report['verdict'] == EXACT else str(ends)


def not_found(lab):
    return expect(lab, ['no-such-program'], NOT_CAPTURABLE, ['no-such-program', 'not found'])


def static(lab):
    return expect(lab, ['{programs}/static_program'], NOT_CAPTURABLE, ['static'])


def osmesa(lab):
    return expect(lab, ['{programs}/osmesa_window'], ALONE, ['OSMesa'])


def x11(lab):
    return expect(lab, ['sh', '-c', '{programs}/x11_window; sleep 60'], ALONE, ['X11']) if os.path.exists(lab.programs + '/x11_window') else None


def draws_nothing(lab):
    return expect(lab, ['true'], NOT_CAPTURABLE, ['no GL calls'])


def crash(lab):
    return expect(lab, ['sh', '-c', 'echo before the end; kill -SEGV $$'], NOT_CAPTURABLE, ['signal 11', 'before the end'])


def hang(lab):
    return expect(lab, ['sleep', '600'], NOT_CAPTURABLE, ['no picture through GL within'])


def hang_without_end(lab):
    return expect(lab, ['sh', '-c', "trap '' TERM HUP INT; while :; do sleep 0.2; done"], NOT_CAPTURABLE, ['no picture'])


def prints(lab):
    report, wrong = lab.run(['sh', '-c', 'exec yes a line that never ends'])
    if wrong:
        return wrong
    printed = fact(report, 'ends', 'outputBytes')['value']
    return None if printed > 1e6 and report['verdict'] == NOT_CAPTURABLE else '%s bytes, %s' % (printed, report['verdict'])


def network(lab):
    program = 'import socket, time; s = socket.socket(); s.bind(("127.0.0.1", 0)); s.listen(); print("waits for a server", flush=True); time.sleep(600)'
    return expect(lab, [sys.executable, '-c', program], NOT_CAPTURABLE, ['IP sockets', 'waits for a server'])


def unsupported(lab):
    """A command that the stream lacks has its number of calls and a reason."""
    report, wrong = lab.run(['{programs}/hard_limits', 'daemon_files'], seconds=8)
    if wrong:
        return wrong
    calls, each = fact(report, 'commands', 'unsupportedCalls'), fact(report, 'commands', 'unsupported.glSeparableFilter2DEXT') or {}  # the registry's alias
    good = calls['value'] == 1 and each.get('value') == 1 and 'registry' in each.get('advice', '')
    return None if good else '%s, %s' % (calls, each)


def leaves_processes(lab):
    """Its page has no pictures on request."""
    page = os.path.join(lab.folder, 'plain.html')
    wrong = expect(lab, ['sh', '-c', 'setsid sleep 601 >/dev/null 2>&1 & exec {programs}/long_run --frames 100000 --size 100x100'], EXACT,
                   options=['--html', page, '--no-pictures'])
    if wrong:
        return wrong
    with open(page, encoding='utf-8') as stream:
        return 'a picture in spite of --no-pictures' if 'data:image' in stream.read() else None


def diff(lab):
    files = [os.path.join(lab.folder, name) for name in ('first.json', 'second.json')]
    for file in files:
        _, wrong = lab.run(['true'], file=file)
        if wrong:
            return wrong
    same = subprocess.run([lab.mural, 'app-report', '--diff', *files], capture_output=True, text=True, timeout=60)
    with open(files[1], encoding='utf-8') as stream:
        other = json.load(stream)
    other['verdict'] = EXACT
    with open(files[1], 'w', encoding='utf-8') as stream:
        json.dump(other, stream)
    changed = subprocess.run([lab.mural, 'app-report', '--diff', *files], capture_output=True, text=True, timeout=60)
    bad = subprocess.run([lab.mural, 'app-report', '--diff', files[0], '/nonexistent'], capture_output=True, text=True, timeout=60)
    good = same.returncode == 0 and changed.returncode == 1 and 'verdict: not capturable => works, exact' in changed.stdout and bad.returncode == 2
    return None if good else '%s %s %s' % (same, changed, bad)


def interrupted(lab):
    """Ctrl-C ends all processes."""
    mark = 'APP_REPORT_TEST=%d.int' % os.getpid()
    process = subprocess.Popen([lab.mural, 'app-report', '--seconds', '60', '--', os.path.join(lab.programs, 'long_run'), '--frames', '1000000'],
                               env=dict(os.environ, **dict([mark.split('=')])), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if not processes.until(lambda: any('long_run' in line.split()[0] for line in processes.processes_with(mark).values()), 30):
        process.kill()
        return 'the program did not start'
    process.send_signal(2)
    try:
        _, errors = process.communicate(timeout=30)
    except subprocess.TimeoutExpired:
        process.kill()
        return 'it does not end'
    left = processes.processes_with(mark)
    return None if process.returncode == 130 and 'interrupted' in errors and not left else 'status %d, %s, left %s' % (process.returncode, errors, left)


# Programs without any window: their runs wait for most of their time, so they wait together.
WAITING = (not_found, static, draws_nothing, crash, hang, hang_without_end, prints, network, diff)
CASES = {f.__name__: f for f in (exact, own_status, unsupported, leaves_processes, osmesa, x11, interrupted) + WAITING}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--mural', required=True)
    parser.add_argument('--programs', required=True)
    parser.add_argument('--cases', default=','.join(CASES))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        lab = Lab(arguments, folder)
        def perform(name):
            wrong = CASES[name](lab)
            print('%s: %s' % (name, 'ok' if wrong is None else 'FAILED: ' + wrong), flush=True)
            return wrong is not None

        names = arguments.cases.split(',')
        failed = sum(perform(name) for name in names if CASES[name] not in WAITING)
        with concurrent.futures.ThreadPoolExecutor(4) as together:
            failed += sum(together.map(perform, [name for name in names if CASES[name] in WAITING]))
    sys.exit(1 if failed else 0)


main()
