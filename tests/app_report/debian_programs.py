#!/usr/bin/env python3
"""Reports on 20 programs of Debian. Every statement of a report is compared with its own runs, and with one more
`mural run --report` of each program. Prints the table of docs/measurements/programs.md.

  debian_programs.py --mural BIN/mural [--seconds 4] [--programs glxgears,etr] [--keep FOLDER]

Programs that are not installed are left out, with a line. Exit status 1: a statement was wrong.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

HACKS = '/usr/libexec/xscreensaver/'
QT = '/usr/lib/x86_64-linux-gnu/qt5/examples/'
PYGLET = 'import pyglet\nw = pyglet.window.Window(320, 240)\nb = pyglet.shapes.Rectangle(40, 40, 80, 60)\n@w.event\ndef on_draw():\n    w.clear()\n    b.rotation += 3\n    b.draw()\npyglet.clock.schedule_interval(lambda dt: None, 1 / 60)\npyglet.app.run()\n'
PROGRAMS = {
    'glxgears': ['glxgears'],
    'es2gears_x11': ['es2gears_x11'],
    'glxheads': ['glxheads'],
    'glxdemo': ['glxdemo'],
    'glxinfo': ['glxinfo', '-B'],
    'glmark2 build': ['glmark2', '-s', '320x240', '-b', 'build:use-vbo=true:duration=60'],
    'glmark2 terrain': ['glmark2', '-s', '320x240', '-b', 'terrain:duration=60'],
    'glmark2 shadow': ['glmark2', '-s', '320x240', '-b', 'shadow:duration=60'],
    'glmark2-es2 texture': ['glmark2-es2', '-s', '320x240', '-b', 'texture:duration=60'],
    'extremetuxracer': ['etr'],
    'chromium-bsu': ['chromium-bsu', '--window', '--noaudio'],
    'xscreensaver gears': [HACKS + 'gears', '--window', '--geometry', '320x240'],
    'xscreensaver morph3d': [HACKS + 'morph3d', '--window', '--geometry', '320x240'],
    'xscreensaver glblur': [HACKS + 'glblur', '--window', '--geometry', '320x240'],
    'xscreensaver atunnel': [HACKS + 'atunnel', '--window', '--geometry', '320x240'],
    'Qt hellogl2': [QT + 'opengl/hellogl2/hellogl2'],
    'Qt qopenglwidget': [QT + 'opengl/qopenglwidget/qopenglwidget'],
    'Qt openglwindow': [QT + 'gui/openglwindow/openglwindow'],
    'Qt wiggly (no GL)': [QT + 'widgets/widgets/wiggly/wiggly'],
    'pyglet': ['/usr/bin/python3', '-c', PYGLET],
}
STATUS = {'works, exact': 0, 'works, with differences': 1, 'runs alone': 2, 'not capturable': 2}


def fact(report, section, key):
    return report['sections'].get(section, {}).get('facts', {}).get(key, {})


def value(report, section, key):
    return fact(report, section, key).get('value')


def number(run, name):
    return (run.get('report') or {}).get(name) or 0


def own_trips(run):
    return {k: v for k, v in ((run.get('report') or {}).get('roundTripsBy') or {}).items() if k != '--verify'}


def wrong_statements(report, status):
    """Compares the report with the reports of its own runs."""
    runs = {run['name']: run for run in report['runs']}
    tiles, balance, native, db = (runs[name] for name in ('tiles', 'balance', 'native', 'db'))
    frames = number(tiles, 'frames')
    checks = [('exit status', status, STATUS[report['verdict']])]
    if report['verdict'] == 'works, exact':
        checks += [('differing pixels', number(tiles, 'differingPixels'), 0), ('compared pixels', number(tiles, 'verifiedPixels') > 0, True)]
    if frames == 0:
        checks.append(('verdict without frames', STATUS[report['verdict']], 2))
        return [c for c in checks if c[1] != c[2]]
    checks.append(('verdict with frames', STATUS[report['verdict']] < 2, True))
    checks.append(('round trips per frame', round(value(report, 'roundTrips', 'perFrame') * frames), sum(own_trips(tiles).values())))
    for command, count in own_trips(tiles).items():
        checks.append(('round trips of ' + command, round(value(report, 'roundTrips', 'by.' + command) * frames), count))
    checks.append(('sent bytes', value(report, 'traffic', 'sentBytesPerFrame'), number(tiles, 'bytesPerFrame')))
    checks.append(('stream bytes', round(value(report, 'traffic', 'rawBytesPerFrame') * frames), round(tiles['report']['delta']['programBytes'])))
    checks.append(('memory', value(report, 'traffic', 'nodeMemoryBytes'), max(node['peakMemoryBytes'] for node in tiles['report']['nodes'])))
    checks.append(('unsupported calls', value(report, 'commands', 'unsupportedCalls'), number(tiles, 'callsUnsupported')))
    for command, count in ((tiles.get('report') or {}).get('callsUnsupportedBy') or {}).items():
        checks.append(('unsupported calls of ' + command, value(report, 'commands', 'unsupported.' + command), count))
    if number(native, 'frames') > 1:
        checks.append(('native rate', value(report, 'speed', 'nativeFramesPerSecond'), number(native, 'framesPerSecond')))
    if number(balance, 'frames') > 1:
        checks.append(('rate', value(report, 'speed', 'muralFramesPerSecond'), number(balance, 'framesPerSecond')))
        stays = any(limit['code'] == 'areas-stay' for limit in balance['report']['limits'])
        if value(report, 'divisions', 'tilesMove') is not None:
            checks.append(('tiles can move', value(report, 'divisions', 'tilesMove'), not stays))
    draws = (db.get('report') or {}).get('sharedDraws')
    if draws:
        checks.append(('shared draws', value(report, 'divisions', 'sharedDraws'), draws['shared'] / draws['frames']))
    return [c for c in checks if c[1] != c[2]]


def wrong_against_another_run(mural, command, report, seconds, folder):
    """Runs the program once more, as a user would, and compares what does not vary."""
    file = os.path.join(folder, 'again.json')
    if os.path.exists(file):
        os.remove(file)
    # The number of frames ends it, because a loaded machine starts sessions slowly.
    run = ['timeout', '-k', '10', '-s', 'TERM', str(seconds + 20), mural, 'run', '--quiet', '--frames', '20', '--tiles', '2x2', '--verify', '--report', file, '--display', 'none', '--', *command]
    environment = {k: v for k, v in os.environ.items() if k not in ('DISPLAY', 'XAUTHORITY')}
    done = subprocess.run(run, env=environment, capture_output=True, timeout=seconds + 60)
    again = {}
    if os.path.exists(file):
        with open(file, encoding='utf-8') as stream:
            again = json.load(stream)
    frames = again.get('frames', 0)
    wrong = []
    if (frames > 0) != (STATUS[report['verdict']] < 2):
        wrong.append(('captured, in another run', frames, report['verdict']))
    if report['verdict'] == 'works, exact' and (again.get('differingPixels', 1) != 0 or again.get('verifiedPixels', 0) == 0):
        wrong.append(('exact, in another run', again.get('differingPixels'), 0))
    trips = {k for k, v in again.get('roundTripsBy', {}).items() if k != '--verify' and frames and v / frames > 0.5}
    stated = {key[3:] for key in report['sections'].get('roundTrips', {}).get('facts', {}) if key.startswith('by.')}
    if not trips <= stated:
        wrong.append(('round trips in each frame of another run', sorted(trips), sorted(stated)))
    return wrong, done.returncode


def short(number_of):
    return '%.3g' % number_of if number_of < 1000 else '%.0f' % number_of


def size(number_of):
    return '–' if number_of is None else '%.0f B' % number_of if number_of < 1000 else '%.1f kB' % (number_of / 1e3) if number_of < 1e6 else '%.1f MB' % (number_of / 1e6)


def row(name, report):
    move, part = value(report, 'divisions', 'tilesMove'), value(report, 'divisions', 'sharedDraws')
    trips = value(report, 'roundTrips', 'perFrame')
    native, here = value(report, 'speed', 'nativeFramesPerSecond'), value(report, 'speed', 'muralFramesPerSecond')
    return '| %s | %s | %s | %s | %s | %s | %s | %s | %s |' % (
        name, report['verdict'], ', '.join(value(report, 'capture', 'contexts') or {}) or '–',
        '–' if trips is None else short(trips), size(value(report, 'traffic', 'rawBytesPerFrame')), size(value(report, 'traffic', 'sentBytesPerFrame')),
        '–' if move is None else 'yes' if move else 'no', '–' if part is None else '%.0f %%' % (100 * part),
        '–' if not native or not here else '%.2f' % (here / native))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--mural', required=True)
    parser.add_argument('--seconds', type=float, default=4)
    parser.add_argument('--programs')
    parser.add_argument('--keep')
    a = parser.parse_args()
    mural = os.path.abspath(a.mural)
    os.environ['PATH'] += ':/usr/games'
    rows, failed = [], 0
    folder = os.path.abspath(a.keep) if a.keep else tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    for name in a.programs.split(',') if a.programs else PROGRAMS:
        command = PROGRAMS[name]
        if not shutil.which(command[0]):
            print('%s: not installed' % name, flush=True)
            continue
        file = os.path.join(folder, name.replace(' ', '_').replace('/', '_') + '.json')
        done = subprocess.run([mural, 'app-report', '--seconds', str(a.seconds), '--json', file, '--', *command], capture_output=True, text=True, errors='replace', timeout=a.seconds * 4 + 120)
        if not os.path.exists(file):
            failed += 1
            print('%s: NO REPORT, status %d: %s' % (name, done.returncode, done.stderr[-300:]), flush=True)
            continue
        with open(file, encoding='utf-8') as stream:
            report = json.load(stream)
        wrong = wrong_statements(report, done.returncode)
        more, _ = wrong_against_another_run(mural, command, report, a.seconds + 2, folder)
        wrong += more
        failed += bool(wrong)
        rows.append(row(name, report))
        print('%s: %s%s\n%s' % (name, report['sentence'][:120], '; WRONG: %s' % wrong if wrong else '', rows[-1]), flush=True)
    print('\n| program | verdict | GL of its contexts | round trips per frame | stream per frame | sent to each node | tiles can move | frames with shared draws | speed, two nodes here : native |\n|---|---|---|---|---|---|---|---|---|')
    print('\n'.join(rows))
    print('%d programs, %d with a wrong statement' % (len(rows), failed))
    if not a.keep:
        shutil.rmtree(folder, ignore_errors=True)
    sys.exit(1 if failed else 0)


main()
