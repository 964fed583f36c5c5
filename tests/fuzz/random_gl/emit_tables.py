#!/usr/bin/env python3
"""Writes the tables of the random GL calls (tables.hpp) from the OpenGL registry.

  emit_tables.py --registry gl.xml --out tables.cpp
"""
import argparse
import fnmatch
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
sys.path.insert(0, os.path.join(ROOT, 'streamcodec', 'api', 'gen'))
import registry  # noqa: E402
import xml.etree.ElementTree as ET  # noqa: E402

VENDORS = 'ARB|EXT|KHR|OES|NV|NVX|ATI|AMD|ANGLE|APPLE|MESA|SGI|SGIS|SGIX|INTEL|IBM|SUN|HP|PGI|QCOM|IMG|3DFX|INGR|OVR'
INTEGERS = {1: 'int8_t', 2: 'int16_t', 4: 'int32_t', 8: 'int64_t'}
UNSIGNED = {'GLboolean', 'GLubyte', 'GLushort', 'GLuint', 'GLenum', 'GLbitfield', 'GLhalf', 'GLhalfNV', 'GLhandleARB',
            'GLuint64', 'GLuint64EXT', 'GLchar'}
REALS = {'GLfloat': 'float', 'GLclampf': 'float', 'GLdouble': 'double', 'GLclampd': 'double'}
KINDS = {'shader': 'Shader', 'program': 'Program', 'display list': 'List', 'arb program': 'ArbProgram'}
PACKED = re.compile(r'gl(ReadPixels|ReadnPixels|Getn?(Compressed)?Tex(ture)?(Sub)?Image|Getn?PixelMap|Getn?PolygonStipple|'
                    r'GetMultiTexImage|GetCompressedMultiTexImage)')
UNPACKED = re.compile(r'gl((Compressed)?(Multi)?Tex(ture)?(Sub)?Image|DrawPixels|Bitmap|PolygonStipple|PixelMap)')
# Ranges of numbers by parameter name.
RANGES = {
    'x': (-8, 70), 'y': (-8, 50), 'z': (-2, 4), 'w': (0, 90), 'width': (0, 36), 'height': (0, 28), 'depth': (0, 5),
    'h': (0, 70), 'xoffset': (-1, 12), 'yoffset': (-1, 12), 'zoffset': (-1, 4), 'level': (0, 4), 'levels': (0, 4),
    'border': (0, 0), 'size': (1, 4), 'stride': (0, 48), 'index': (0, 7), 'location': (-1, 16), 'count': (0, 12),
    'first': (0, 8), 'n': (0, 5), 'start': (0, 0), 'end': (300, 300), 'bufsize': (0, 900), 'instancecount': (0, 3),
    'primcount': (0, 3), 'basevertex': (0, 6), 'baseinstance': (0, 3), 'samples': (0, 4), 'divisor': (0, 3), 'ref': (0, 255),
    'drawcount': (0, 4), 'offset': (0, 96), 'readoffset': (0, 96), 'writeoffset': (0, 96), 'length': (0, 40),
    'imagesize': (0, 600), 'mapsize': (1, 32), 'value': (0, 9), 'param': (-2, 12), 'stream': (0, 1), 'unit': (0, 7),
    'texture': (0, 12), 'layer': (0, 3), 'mask': (0, 255), 'maskin': (0, 255), 's': (0, 255), 'timeout': (0, 0), 'ustride': (3, 8),
    'vstride': (3, 8), 'uorder': (1, 5), 'vorder': (1, 5), 'order': (1, 5), 'un': (1, 6), 'vn': (1, 6), 'i1': (0, 4),
    'i2': (0, 5), 'j1': (0, 4), 'j2': (0, 5), 'numgroupsx': (0, 3), 'numgroupsy': (0, 3), 'numgroupsz': (0, 2),
    'srcx0': (-4, 66), 'srcy0': (-4, 50), 'srcx1': (-4, 66), 'srcy1': (-4, 50), 'dstx0': (-4, 66), 'dsty0': (-4, 50),
    'dstx1': (-4, 66), 'dsty1': (-4, 50), 'pattern': (0, 65535), 'factor': (1, 6), 'v0': (-2, 5), 'range': (0, 3),
    'relativeoffset': (0, 32), 'maxcount': (0, 8), 'numattachments': (0, 3), 'left': (-8, 70), 'bottom': (-8, 50),
}


def family(name):
    name = re.sub(r'(%s)$' % VENDORS, '', name)
    return re.sub(r'(?<=[a-z])(P?[1-4](x[234])?)?(u?[bsi]|f|d|x|hv|i64|ui64|I)?(_)?v?$', '', name)


class Excluded:
    def __init__(self, path):
        lines = [line.split(None, 1) for line in open(path, encoding='utf-8') if line.strip() and line[0] != '#']
        self.used = {pattern: False for pattern, _ in lines}

    def __contains__(self, name):
        for pattern in self.used:
            if fnmatch.fnmatchcase(name, pattern):
                self.used[pattern] = True
                return True
        return False


class Groups:
    """Values of the enum groups; group 0 is all values of any version or common extension."""

    def __init__(self, root, excluded):
        values, members = {}, {}
        wanted = set()
        for feature in root.findall('feature'):
            wanted.update(e.get('name') for e in feature.iter('enum'))
        for extension in root.find('extensions'):
            if re.match(r'GL_(ARB|EXT|KHR|OES)_', extension.get('name')):
                wanted.update(e.get('name') for e in extension.iter('enum'))
        for enum in root.iter('enum'):
            name, value = enum.get('name'), enum.get('value')
            if not value or name not in wanted or name in excluded or int(value, 0) > 0xffffffff:
                continue
            values[name] = int(value, 0)
            for group in (enum.get('group') or '').split(','):
                members.setdefault(group, set()).add(int(value, 0))
        members.pop('', None)
        self.names = [''] + sorted(members)
        self.values = [sorted({v for v in values.values() if v < 0xa000})] + [sorted(members[n]) for n in self.names[1:]]
        self.queries = sorted(members['GetPName'])
        self.index = {name: i for i, name in enumerate(self.names)}


def kind_of(command, p):
    word = KINDS.get(p.object_class) or registry.KINDS.get(p.object_class)
    if command.name in ('glIsShader', 'glGetAttachedShaders') and p.name == 'shader':
        word = 'Shader'
    return word or 'Nothing'


def value_type(base):
    if base in REALS:
        return 'Single' if REALS[base] == 'float' else 'Double'
    return 'Unsigned' if base in UNSIGNED else 'Signed'


def pointed_type(base):
    return {'GLfloat': 'Float', 'GLclampf': 'Float', 'GLdouble': 'Double', 'GLclampd': 'Double', 'GLfixed': 'Wide'}.get(
        base, {1: 'Byte', 2: 'Short', 4: 'Int', 8: 'Double'}.get(registry.TYPE_BYTES.get(base, 1)))


def pointer_source(command, p, groups):
    if p.base in ('GLchar', 'GLcharARB') and p.const:
        return 'Text' if p.pointers == 1 else None
    if p.pointers > 1:
        return None if p.const else 'Output'
    if not p.const:
        if command.command_class == 'object' and p.object_class:
            return 'Made'
        return 'Pack' if PACKED.match(command.name) else 'Output'
    if p.name == 'pointer':
        return 'Array'
    if p.name == 'indices' and 'Draw' in command.name:
        return 'Indices'
    if UNPACKED.match(command.name):
        return 'Unpack'
    if kind_of(command, p) != 'Nothing':
        return 'Names'
    if p.base == 'GLenum' and p.group in groups.index:
        return 'Enums'
    return 'Input'


def value_source(p, groups):
    if p.base == 'GLsync':
        return 'Sync'
    if p.object_class and registry.KINDS.get(p.object_class, p.object_class == 'display list'):
        return 'Object'
    if p.base == 'GLboolean':
        return 'Boolean'
    if p.base == 'GLbitfield':
        return 'Bits'
    if p.base == 'GLenum' or (p.base == 'GLint' and p.group in groups.index and len(groups.values[groups.index[p.group]]) > 1):
        return 'Enum'
    return 'Real' if p.base in REALS else 'Number'


def param_row(command, p, groups):
    """Returns the initializer of a Param; None if no value can be passed."""
    if p.pointers:
        source, type_name = pointer_source(command, p, groups), pointed_type(p.base)
        if p.base in registry.FOREIGN_TYPES:
            return None
    elif p.base in registry.TYPE_BYTES:
        source, type_name = value_source(p, groups), value_type(p.base)
    else:
        return None
    if source is None:
        return None
    low, high = RANGES.get(p.name.lower().replace('_', ''), (-2, 9))
    if p.base in ('GLsizeiptr', 'GLsizeiptrARB') and not p.pointers:
        low, high = 0, 300
    if p.base == 'GLfixed' and not p.pointers:
        low, high = -131072, 131072
    return '{"%s", Draw::%s, Type::%s, Kind::%s, %d, %d, %d}' % (
        p.name, source, type_name, kind_of(command, p), groups.index.get(p.group, 0), low, high)


def c_type(base, pointers):
    if pointers or base == 'GLsync':
        return 'void*'
    if base in REALS:
        return REALS[base]
    return ('u' if base in UNSIGNED else '') + INTEGERS[registry.TYPE_BYTES[base]]


def thunk(types, returns):
    arguments = []
    for i, t in enumerate(types):
        if t in ('float', 'double', 'void*'):
            arguments.append('a[%d].%s' % (i, {'float': 'single', 'double': 'real', 'void*': 'pointer'}[t]))
        else:
            arguments.append('static_cast<%s>(a[%d].whole)' % (t, i))
    call = 'reinterpret_cast<%s (*)(%s)>(f)(%s)' % (returns, ', '.join(types), ', '.join(arguments))
    if returns == 'void':
        return '%s; return 0;' % call
    if returns == 'void*':
        return 'return reinterpret_cast<std::uintptr_t>(%s);' % call
    return 'return static_cast<std::uint64_t>(%s);' % call


def removed_commands(root):
    return {c.get('name') for feature in root.findall('feature') for r in feature.findall('remove')
            if r.get('profile') == 'core' for c in r.findall('command')}


def emit(root, commands, excluded):
    groups = Groups(root, excluded)
    removed = removed_commands(root)
    families, thunks, rows, params = {}, {}, [], []
    for name in sorted(commands):
        c = commands[name]
        if c.command_class == 'unsupported' or name in excluded:
            continue
        if c.returns not in ('void', 'GLsync') and c.returns not in registry.TYPE_BYTES:
            continue
        described = [param_row(c, p, groups) for p in c.params]
        if None in described:
            continue
        types = tuple(c_type(p.base, p.pointers) for p in c.params)
        returns = 'void' if c.returns == 'void' else c_type(c.returns, 0)
        call = thunks.setdefault((types, returns), 'call%d' % len(thunks))
        made = registry.KINDS.get(c.return_class) if c.returns == 'GLuint' else None
        made = {'glCreateShader': 'Shader', 'glGenLists': 'List'}.get(name, made) or 'Nothing'
        version = [int(c.core.get(api, 0) * 10 + 0.5) for api in ('gl', 'gles1', 'gles2')]
        rows.append('{"%s", %s, kParams + %d, %d, %d, %d, %d, %s, %s, Kind::%s, " %s ", %d},' % (
            name, call, len(params), len(described), *version, 'true' if name in removed else 'false',
            'false' if returns in ('void', 'void*') else 'true', made, ' '.join(c.extensions),
            families.setdefault(family(name), len(families))))
        params += described
    lines = ['// Made by emit_tables.py from the OpenGL registry.', '#include "tests/fuzz/random_gl/tables.hpp"', '',
             'namespace fuzz {', 'namespace {', '']
    for (types, returns), call in thunks.items():
        lines.append('std::uint64_t %s(void* f, [[maybe_unused]] const Value* a) { %s }' % (call, thunk(types, returns)))
    lines.append('constexpr Param kParams[] = {')
    lines += [p + ',' for p in params] + ['};', 'constexpr Command kCommandTable[] = {'] + rows + ['};']
    for i, values in enumerate(groups.values):
        lines.append('constexpr std::uint32_t kGroup%d[] = {%s}; // %s' % (i, ', '.join('0x%x' % v for v in values), groups.names[i]))
    lines.append('constexpr std::span<const std::uint32_t> kGroupTable[] = {%s};' % ', '.join('kGroup%d' % i for i in range(len(groups.values))))
    lines.append('constexpr std::uint32_t kQueryTable[] = {%s};' % ', '.join('0x%x' % v for v in groups.queries))
    lines += ['} // namespace', '', 'const std::span<const Command> kCommands = kCommandTable;',
              'const std::span<const std::span<const std::uint32_t>> kGroups = kGroupTable;',
              'const std::uint16_t kFamilies = %d;' % len(families),
              'const std::span<const std::uint32_t> kQueries = kQueryTable;', '', '} // namespace fuzz', '']
    unused = [pattern for pattern, used in excluded.used.items() if not used]
    if unused:
        raise SystemExit('excluded.txt: nothing in the registry matches ' + ', '.join(unused))
    return '\n'.join(lines)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument('--registry', required=True)
    arguments.add_argument('--out', required=True)
    o = arguments.parse_args()
    commands, _ = registry.load(o.registry, os.path.join(ROOT, 'streamcodec', 'api', 'semantics.txt'))
    root = ET.parse(o.registry).getroot()
    text = emit(root, commands, Excluded(os.path.join(HERE, 'excluded.txt')))
    with open(o.out, 'w', encoding='utf-8') as f:
        f.write(text)


main()
