#!/usr/bin/env python3
"""mural bench accuracy as a user meets it: what it measures holds, files say the same as the table, and a fault is seen.

  bench_accuracy.py MURAL
"""
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

failures = []


def run(*arguments, plant=None):
    environment = {name: value for name, value in os.environ.items() if name not in ('DISPLAY', 'MURAL_PLANT')}
    if plant:
        environment['MURAL_PLANT'] = plant
    done = subprocess.run([sys.argv[1], 'bench', *arguments], capture_output=True, text=True, timeout=400, env=environment)
    return done.returncode, done.stdout, done.stderr


def expect(holds, what):
    if not holds:
        failures.append(what)


def rows_of(path):
    with open(path, encoding='utf-8') as f:
        return json.load(f)


def quick(folder):
    files = os.path.join(folder, 'a.json'), os.path.join(folder, 'a.svg')
    recording = os.path.join(folder, 'scenes.mural')
    scenes = os.path.join(os.path.dirname(os.path.abspath(sys.argv[1])), 'mural-scenes')
    subprocess.run([sys.argv[1], 'run', '--quiet', '--display', 'none', '--size', '800x600', '--record', recording, '--', scenes, '--size', '253x191', '--frames', '6'],
                   timeout=120, check=True, env={name: value for name, value in os.environ.items() if name not in ('DISPLAY', 'MURAL_PLANT')})
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
    # What approximates must be seen to: a kernel or an eye that leaves every pixel as it was did nothing.
    for kind in ('pixel, kernel of 2x2: triangles', 'zoom of 0.5: triangles', 'yuv420'):
        expect(any(row['what'].startswith(kind) and row['differingPixels'] > 0 for row in rows), '%s changed nothing' % kind)
    expect('%d measured, 0 broken' % len(rows) in out, 'the table tells something else')
    # Costs: of what recordings, codecs and blending take; more samples are nearer to many and dearer.
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
    """A program of the user's, and the same with a tile that is read one pixel off."""
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
    for words, wanted in ((('accuracy', '--'), 'no program stands after --'), (('speed',), 'speed'), (('accuracy', '--frames', '0'), '--frames')):
        status, out, err = run(*words)
        expect(status == 2 and wanted in err and err.count('\n') == 1 and not out, '%s: %d %s %s' % (words, status, out, err))
    status, out, err = run('accuracy', '--quick', '--', os.path.join(folder, 'none'))
    expect(status == 1 and 'FAILED' in out, 'a program that is not there: %d %s %s' % (status, out, err))


with tempfile.TemporaryDirectory() as scratch:
    quick(scratch)
    program(scratch)
    refused(scratch)
for failure in failures:
    print('FAILED:', failure)
sys.exit(1 if failures else 0)
