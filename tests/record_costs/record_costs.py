#!/usr/bin/env python3
"""mural record-costs with a program whose cost lies in one corner, and with programs and options that fail.

  record_costs.py --mural BIN/mural --programs BUILD/tests/programs
"""
import argparse
import os
import subprocess
import sys
import tempfile

COLUMNS, ROWS, RANGES, FRAMES = 4, 3, 4, 8


def numbers(words):
    """The values of a line of a trace, where VALUE*COUNT stands for equal ones."""
    values = []
    for word in words:
        value, _, count = word.partition('*')
        values += [float(value)] * int(count or 1)
    return values


def read_trace(path):
    """Returns the words of the grid line, and the cells and ranges of each frame."""
    grid, frames = [], []
    with open(path, encoding='utf-8') as file:
        for line in file:
            kind, *words = line.split()
            if kind == 'grid':
                grid = words
            elif kind == 'frame':
                frames.append({'cells': [], 'ranges': []})
            elif kind in ('cells', 'ranges'):
                frames[-1][kind] += numbers(words)
    return grid, frames


class Lab:
    def __init__(self, arguments, folder):
        self.mural, self.programs, self.folder = os.path.abspath(arguments.mural), os.path.abspath(arguments.programs), folder

    def run(self, words, settings=None):
        environment = dict(os.environ, **(settings or {}))
        return subprocess.run([self.mural, *words], env=environment, capture_output=True, text=True, timeout=120, check=False)


def costs_lie_where_the_program_draws(lab):
    trace = os.path.join(lab.folder, 'uneven.cost')
    done = lab.run(['record-costs', '--out', trace, '--grid', '%dx%d' % (COLUMNS, ROWS), '--ranges', str(RANGES), '--frames', str(FRAMES), '--rounds', '2',
                    '--', os.path.join(lab.programs, 'uneven_cost'), '--size', '320x240', '--frames', '100'],
                   {'UNEVEN_LAYERS': '200', 'UNEVEN_STAY': '100000'})
    if done.returncode != 0:
        return 'status %d: %s' % (done.returncode, done.stderr[-300:])
    grid, frames = read_trace(trace)
    if grid != [str(COLUMNS), str(ROWS), str(RANGES)] or len(frames) != FRAMES:
        return 'grid %s, %d frames' % (grid, len(frames))
    for frame in frames:
        cells, ranges = frame['cells'], frame['ranges']
        if len(cells) != COLUMNS * ROWS or len(ranges) != RANGES or min(cells) < 0:
            return 'odd frame: %s' % frame
        if abs(sum(cells) - sum(ranges)) > 0.01 * sum(cells):
            return 'sums %g of the cells and %g of the range' % (sum(cells), sum(ranges))
    cells = [sum(frame['cells'][i] for frame in frames) for i in range(COLUMNS * ROWS)]
    print('   share of each cell, lowest row first: %s' % ' '.join('%.2f' % (cell / sum(cells)) for cell in cells))
    # An even cost is 0.08. On a busy machine other processes add to every cell.
    if cells.index(max(cells)) != 0 or cells[0] < 0.25 * sum(cells):
        return 'the lower left cell has the layers, but the costs are %s' % cells
    compared = lab.run(['simulate', '--cost', trace, '--nodes', '4', '--compare'])
    if compared.returncode != 0 or 'costmap' not in compared.stdout:
        return 'simulate: status %d: %s' % (compared.returncode, compared.stderr[-300:])
    return None


def failures_are_named(lab):
    trace = os.path.join(lab.folder, 'none.cost')
    glx = os.path.join(lab.programs, 'uneven_cost')
    cases = [
        (['--', glx], 2, '--out is needed'),
        (['--out', trace], 2, 'a program is required'),
        (['--out', trace, '--grid', '8y6', '--', glx], 2, '--grid "8y6": must be COLUMNSxROWS'),
        (['--out', trace, '--grid', '64x64', '--', glx], 2, '2 to 256 cells'),
        (['--out', trace, '--', 'no-such-program'], 127, 'no-such-program'),
        (['--out', '/nowhere/a.cost', '--', glx], 2, '/nowhere/a.cost'),
        (['--out', trace, '--smooth', '4', '--', glx], 2, '--smooth 4: must be odd, such as 5'),
        (['--out', trace, '--colour', '--', glx], 2, 'unknown option --colour'),
        (['--out', trace, '--', 'true'], 2, 'no node drew a second frame (the whole picture)'),
    ]
    for words, status, text in cases:
        done = lab.run(['record-costs', *words])
        lines = [line for line in done.stderr.splitlines() if line]
        if done.returncode != status or len(lines) != 1 or text not in lines[0]:
            return '%s: status %d, %s' % (words, done.returncode, done.stderr[-300:])
        if os.path.exists(trace):
            return '%s: left a file' % words
    return None


def frame_times_need_a_place(lab):
    done = lab.run(['run', '--frame-times', '/nowhere/times', '--', os.path.join(lab.programs, 'uneven_cost')])
    if done.returncode != 2 or '--frame-times /nowhere/times: cannot be written' not in done.stderr:
        return 'status %d, %s' % (done.returncode, done.stderr[-300:])
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--mural', required=True)
    parser.add_argument('--programs', required=True)
    arguments = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory(prefix='mural-test.') as folder:
        lab = Lab(arguments, folder)
        for case in (costs_lie_where_the_program_draws, failures_are_named, frame_times_need_a_place):
            problem = case(lab)
            failed += problem is not None
            print('%s %s%s' % ('FAILED' if problem else 'ok', case.__name__, ': ' + problem if problem else ''), flush=True)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
