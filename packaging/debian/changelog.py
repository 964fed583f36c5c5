#!/usr/bin/env python3
"""Writes the changelog of the Debian packages from the changelog of the tree.

  changelog.py CHANGELOG.md VERSION MAINTAINER OUT.gz

The tree's changelog has a section "## VERSION (DATE)" per version, with list items. The newest must be VERSION.
"""
import datetime
import email.utils
import gzip
import re
import sys
import textwrap

SECTION = re.compile(r'^## (\S+) \((\d{4}-\d{2}-\d{2})\)$')


def entries(text):
    """Returns (version, date, items) of each section."""
    found = []
    for line in text.split('\n'):
        heading = SECTION.match(line)
        if heading:
            found.append((heading.group(1), heading.group(2), []))
        elif line.startswith('- ') and found:
            found[-1][2].append(line[2:])
        elif line.startswith('  ') and found and found[-1][2]:
            found[-1][2][-1] += ' ' + line.strip()
    return found


def debian_entry(version, date, items, maintainer):
    lines = ['mural (%s) bookworm; urgency=medium' % version, '']
    for item in items:
        plain = re.sub(r'\[([^]]*)\]\([^)]*\)', r'\1', item).replace('`', '').replace('**', '')
        lines += textwrap.wrap(plain, 76, initial_indent='  * ', subsequent_indent='    ')
    at = datetime.datetime.fromisoformat(date).replace(tzinfo=datetime.timezone.utc)
    return '\n'.join(lines + ['', ' -- %s  %s' % (maintainer, email.utils.format_datetime(at)), ''])


def main():
    source, version, maintainer, out = sys.argv[1:]
    with open(source, encoding='utf-8') as file:
        found = entries(file.read())
    if not found or found[0][0] != version:
        raise SystemExit('changelog: the first section of %s must be "## %s (DATE)"' % (source, version))
    text = '\n'.join(debian_entry(*entry, maintainer) for entry in found)
    with open(out, 'wb') as raw, gzip.GzipFile('', 'wb', 9, raw, mtime=0) as file:
        file.write(text.encode())


if __name__ == '__main__':
    main()
