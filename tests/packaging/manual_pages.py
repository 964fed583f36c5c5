#!/usr/bin/env python3
"""Every command has a manual page with all of its options, and man prints the pages without a warning.

  manual_pages.py BUILD
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import command_line

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def rendered(path):
    """Returns the page as text, and the warnings of the formatter."""
    environment = dict(os.environ, MANWIDTH='200', MAN_KEEP_FORMATTING='', LC_ALL='C.UTF-8', GROFF_NO_SGR='1')
    done = subprocess.run(['man', '-l', '--warnings', '--no-hyphenation', path], env=environment, capture_output=True, text=True, timeout=60)
    return re.sub('.\b', '', done.stdout), done.stderr + ('' if done.returncode == 0 else ' status %d' % done.returncode)


def write_pages(mural, folder, **variables):
    subprocess.run([mural, 'help', '--man', folder], env=dict(os.environ, **variables), timeout=60, check=True)
    return {name: open(os.path.join(folder, name), encoding='utf-8').read() for name in os.listdir(folder)}


def main():
    mural = os.path.join(sys.argv[1], 'bin', 'mural')
    if not shutil.which('man'):
        print('man is not installed; run tools/install-deps test')
        return 77
    version = subprocess.run([mural, '--version'], capture_output=True, text=True, check=True).stdout.split()[1]
    with tempfile.TemporaryDirectory() as top:
        pages = write_pages(mural, os.path.join(top, 'man1'), SOURCE_DATE_EPOCH='1772323200')
        commands = command_line.commands_of(mural)
        expect(len(commands) > 10 and 'run' in commands, 'the commands of --help: %s' % commands)
        expect(sorted(pages) == sorted(['mural.1'] + ['mural-%s.1' % c for c in commands]), 'pages: %s' % sorted(pages))
        options = 0
        for name in sorted(pages):
            text, warnings = rendered(os.path.join(top, 'man1', name))
            expect(not warnings, '%s: %s' % (name, warnings))
            expect('mural ' + version in text and '2026-03-01' in text, '%s: version or date is missing' % name)
            command = name[len('mural-'):-len('.1')] if name.startswith('mural-') else None
            for option in command_line.options_of(mural, command):
                options += 1
                expect(re.search(r'^ +.*%s\b' % re.escape(option), re.split('^OPTIONS$', text, flags=re.M)[-1], re.M), '%s lacks %s' % (name, option))
            for document in re.findall(r'docs/[a-z/-]+[.]md', text):  # the package installs docs/
                expect(os.path.exists(os.path.join(TREE, document)), '%s names %s, which does not exist' % (name, document))
            if command:
                expect('EXIT STATUS' in text and 'EXAMPLES' in text, '%s: a section is missing' % name)
        expect(options > 100, 'only %d options were found' % options)
        again = write_pages(mural, os.path.join(top, 'again'), SOURCE_DATE_EPOCH='1772323200')
        expect(again == pages, 'two writes differ')
        done = subprocess.run([mural, 'help', '--man', '/proc/none'], capture_output=True, text=True, timeout=60)
        expect(done.returncode == 1 and done.stderr.count('\n') == 1 and 'cannot be written' in done.stderr, 'a bad folder: %d %s' % (done.returncode, done.stderr))
        expect(subprocess.run([mural, 'help', 'nonsense'], capture_output=True).returncode == 2, 'an unknown command')
        same = subprocess.run([mural, 'help', 'run'], capture_output=True, text=True).stdout
        expect(same == command_line.help_of(mural, 'run'), 'mural help run differs from mural run --help')
    for failure in failures:
        print(failure)
    print('%d pages, %d options, %d failures' % (len(pages), options, len(failures)))
    return 1 if failures else 0


sys.exit(main())
