"""The commands and options of mural, as --help prints them: independent of the pages and completions made from them."""
import functools
import re
import subprocess

COMMAND = re.compile(r'^  ([a-z][a-z-]*) ', re.M)
OPTION = re.compile(r'^  ((?:-\w,)?--[a-z-]+)', re.M)
FORM = re.compile(r'^  ((?:-\w,)?--[a-z-]+)( ?\S+(?: \S+)*)?(?:  |$)', re.M)


@functools.lru_cache(maxsize=None)
def help_of(mural, command=None):
    return subprocess.run([mural] + ([command] if command else []) + ['--help'], capture_output=True, text=True, timeout=60, check=True).stdout


def commands_of(mural):
    """Returns the names in the section Subcommands."""
    return COMMAND.findall(help_of(mural).split('Subcommands:')[1].split('\n\n')[0])


def options_of(mural, command):
    """Returns the option names of a command: long ones, and short ones."""
    text = help_of(mural, command).split('Examples:')[0]
    return [name for names in OPTION.findall(text) for name in names.split(',')]


def values_of(mural, command):
    """Returns (longest name, name of its value) of the options that have values."""
    text = help_of(mural, command).split('Examples:')[0]
    return [(names.split(',')[-1], value.strip()) for names, value in FORM.findall(text) if value]
