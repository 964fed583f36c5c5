#!/usr/bin/env python3
"""Checks that each C++ block of docs/guide/native.md is an excerpt of a file of examples/. Indentation may differ.

  guide_code.py ROOT
"""
import os
import re
import sys


def lines_of(text):
    return [line.strip() for line in text.strip().split('\n')]


def contains(lines, part):
    return any(lines[at:at + len(part)] == part for at in range(len(lines) - len(part) + 1))


def main():
    root = sys.argv[1]
    sources = []
    for folder in ('hello', 'ply', 'volume'):
        directory = os.path.join(root, 'examples', folder)
        for name in sorted(os.listdir(directory)):
            with open(os.path.join(directory, name), encoding='utf-8') as file:
                sources.append(lines_of(file.read()))
    with open(os.path.join(root, 'docs', 'guide', 'native.md'), encoding='utf-8') as file:
        blocks = re.findall(r'^```cpp\n(.*?)^```$', file.read(), re.M | re.S)
    wrong = [block for block in blocks if not any(contains(lines, lines_of(block)) for lines in sources)]
    for block in wrong:
        print('docs/guide/native.md: no file of examples/ has these lines; update the guide:\n' + block)
    print('%d blocks, %d wrong' % (len(blocks), len(wrong)))
    return 1 if wrong or not blocks else 0


sys.exit(main())
