#!/usr/bin/env python3
"""Each option of each command is completed, and so is its value; bash, zsh and fish complete real lines.

  shell_completion.py BUILD
"""
import os
import pty
import select
import shutil
import subprocess
import sys
import tempfile
import time

import command_line

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, 'tests', 'end_to_end'))
from harness import length  # noqa: E402

SCRIPTS = os.path.join(TOP, 'packaging', 'completion')
LINE_LIMIT_S = 30 # of a loaded machine

# Typed text, and the line after the tab key. Each has one completion only.
LINES = [
    ('mural ru', 'mural run'),
    ('mural run --tilin', 'mural run --tiling'),
    ('mural run --tiling cul', 'mural run --tiling culled'),
    ('mural run --tiling=cul', 'mural run --tiling=culled'),
    ('mural replay app.mural --stere', 'mural replay app.mural --stereo'),
    ('mural config che', 'mural config check'),
    ('mural config check wal', 'mural config check wall.eqc'),
    ('mural run --config=wal', 'mural run --config=wall.eqc'),
    ('mural run --config wall.eqc --layout Sid', 'mural run --config wall.eqc --layout Sideways'),
    ('mural help --man fol', 'mural help --man folder/'),
    ('mural run --tiles 2x2 -- quaintpro', 'mural run --tiles 2x2 -- quaintprogram'),
    ('mural run --tiles 2x2 quaintpro', 'mural run --tiles 2x2 quaintprogram'),
]
CONFIG = """server { config {
  appNode { pipe { window { channel { name "c" } } } }
  layout { name "Sideways" view { } }
  layout { name "Other" view { } }
  canvas { layout "Sideways" layout "Other" segment { channel "c" } }
} }
"""

failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def complete(mural, *words):
    """Returns the candidates, and the last line."""
    lines = subprocess.run([mural, 'complete', '--', 'mural', *words], capture_output=True, text=True, timeout=60, check=True).stdout.split('\n')[:-1]
    return [line.split('\t')[0] for line in lines[:-1]], lines[-1]


def check_options(mural):
    count, described = 0, set()
    for command in command_line.commands_of(mural):
        expect(command in complete(mural, '')[0], '%s is not completed' % command)
        offered = complete(mural, command, '-')[0]
        for option in command_line.options_of(mural, command):
            count += 1
            expect(option in offered, 'mural %s %s is not completed' % (command, option))
        for option, value in command_line.values_of(mural, command):
            # One function describes an option of several commands; a short run tests it with the first of them.
            if option == '--interface' or ((option, value) in described and not length.LONG): # the values of --interface are of this machine
                continue
            described.add((option, value))
            expect(complete(mural, command, option, '')[1] != ':undescribed',
                   'mural %s %s: the name of its value has no kind in tools/mural/help/value_kinds.cpp' % (command, option))
        expect(complete(mural, command, '')[1] != ':undescribed', 'mural %s: its argument has no kind in tools/mural/help/value_kinds.cpp' % command)
    expect(count > 100 and len(described) > 100, 'only %d options were found, %d with values' % (count, len(described)))
    return count


class Shell:
    """An interactive shell on a terminal. Ctrl-X Ctrl-P appends the line to a file."""

    def __init__(self, words, folder, environment):
        self.shown = os.path.join(folder, 'shown')
        open(self.shown, 'w').close()
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            os.execvpe(words[0], words, dict(environment, SHOWN=self.shown, TERM='dumb'))
        self.lines = 0

    def send(self, text):
        os.write(self.terminal, text.encode())

    def line_after(self, text):
        """Returns the line; None: the shell has not answered in time."""
        self.send('\x15' + text + '\t\x18\x10')
        end = time.monotonic() + LINE_LIMIT_S
        while time.monotonic() < end:
            if select.select([self.terminal], [], [], 0.05)[0]:
                try:
                    os.read(self.terminal, 65536)
                except OSError:
                    return None
            with open(self.shown, encoding='utf-8') as file:
                lines = file.read().split('\n')[:-1]
            if len(lines) > self.lines:
                self.lines = len(lines)
                return lines[-1]
        return None

    def close(self):
        self.send('\x15exit\r')
        os.close(self.terminal)
        try:
            os.kill(self.pid, 9)
        except ProcessLookupError:
            pass
        os.waitpid(self.pid, 0)


BASH = """source /usr/share/bash-completion/bash_completion
source %s/mural.bash
bind 'set enable-bracketed-paste off'
bind 'set completion-query-items 0'
bind 'set page-completions off'
bind -x '"\\C-x\\C-p": printf "%%s\\n" "$READLINE_LINE" >>"$SHOWN"'
"""
ZSH = """fpath=(%s $fpath)
autoload -Uz compinit
compinit -u -D
show() { print -r -- "$BUFFER" >>"$SHOWN" }
zle -N show
bindkey -e
bindkey '^X^P' show
unsetopt zle_bracketed_paste 2>/dev/null
"""


def check_lines(name, shell):
    for typed, wanted in LINES:
        line = shell.line_after(typed)
        expect(line is not None and line.rstrip() == wanted, '%s: "%s" became "%s"' % (name, typed, line))
    shell.close()


def check_shells(mural, folder):
    work = os.path.join(folder, 'work')
    programs = os.path.join(folder, 'programs')
    os.makedirs(os.path.join(work, 'folder'))
    os.makedirs(programs)
    for path, text in ((os.path.join(work, 'wall.eqc'), CONFIG), (os.path.join(work, 'wallpaper.txt'), ''), (os.path.join(programs, 'quaintprogram'), '#!/bin/sh\n')):
        with open(path, 'w', encoding='ascii') as file:
            file.write(text)
    os.chmod(os.path.join(programs, 'quaintprogram'), 0o755)
    environment = dict(os.environ, PATH=':'.join([os.path.dirname(mural), programs, os.environ['PATH']]), HOME=folder, XDG_CONFIG_HOME=folder,
                       XDG_DATA_HOME=folder, LC_ALL='C.UTF-8')
    missing = []
    if shutil.which('bash') and os.path.exists('/usr/share/bash-completion/bash_completion'):
        start = os.path.join(folder, 'bashrc')
        with open(start, 'w', encoding='ascii') as file:
            file.write(BASH % SCRIPTS)
        check_lines('bash', Shell(['bash', '--noprofile', '--rcfile', start, '-i'], work, environment))
    else:
        missing.append('bash-completion')
    if shutil.which('zsh'):
        with open(os.path.join(folder, '.zshrc'), 'w', encoding='ascii') as file:
            file.write(ZSH % SCRIPTS)
        check_lines('zsh', Shell(['zsh', '-i'], work, dict(environment, ZDOTDIR=folder)))
    else:
        missing.append('zsh')
    if shutil.which('fish'):
        # One shell completes all lines.
        script = 'source %s/mural.fish\n' % SCRIPTS + ''.join('complete -C "%s"; echo END\n' % typed for typed, _ in LINES)
        done = subprocess.run(['fish', '--no-config', '-c', script], cwd=work, env=environment, capture_output=True, text=True, timeout=60)
        parts = done.stdout.split('END\n')
        expect(len(parts) == len(LINES) + 1, 'fish ended early: %s' % done.stderr)
        for (typed, wanted), part in zip(LINES, parts):
            words = [line.split('\t')[0] for line in part.split('\n') if line]
            expect(words == [wanted.split(' ')[-1]], 'fish: "%s" has the completions %s %s' % (typed, words, done.stderr))
    else:
        missing.append('fish')
    return missing


def main():
    mural = os.path.abspath(os.path.join(sys.argv[1], 'bin', 'mural'))
    options = check_options(mural)
    with tempfile.TemporaryDirectory(prefix='mural-completion.') as folder:
        missing = check_shells(mural, folder)
    for failure in failures:
        print(failure)
    print('%d options, %d lines per shell, %d failures' % (options, len(LINES), len(failures)))
    if failures:
        return 1
    if missing:
        print('not tested because these packages are not installed: %s; run tools/install-deps test' % ', '.join(missing))
        return 77
    return 0


sys.exit(main())
