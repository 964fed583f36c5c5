"""Emits names, types and enums of the commands' parameters, for tools that print records."""
import xml.etree.ElementTree as ET

from emit_common import HEAD
from emit_interposer import result_bytes
from registry import TYPE_BYTES

ELEMENTS = {'GLboolean': 'Boolean', 'GLenum': 'Enum', 'GLbitfield': 'Bits', 'GLbyte': 'I8', 'GLubyte': 'U8', 'GLchar': 'U8', 'GLcharARB': 'U8',
            'GLshort': 'I16', 'GLushort': 'U16', 'GLhalf': 'U16', 'GLhalfNV': 'U16', 'GLhalfARB': 'U16', 'GLfloat': 'F32', 'GLclampf': 'F32',
            'GLdouble': 'F64', 'GLclampd': 'F64', 'GLint': 'I32', 'GLsizei': 'I32', 'GLfixed': 'I32', 'GLclampx': 'I32', 'GLuint': 'U32',
            'GLhandleARB': 'U32', 'GLint64': 'I64', 'GLint64EXT': 'I64', 'GLintptr': 'I64', 'GLsizeiptr': 'I64', 'GLintptrARB': 'I64',
            'GLsizeiptrARB': 'I64', 'GLuint64': 'U64', 'GLuint64EXT': 'U64'}
TRAVELS = {'scalar': 'Scalar', 'handle': 'Wide', 'offset': 'Wide', 'fixed': 'Fixed', 'text': 'Text', 'strings': 'Texts'}


def read_enums(gl_xml):
    """Returns {group: {value: name}}; group '' has all values that are no bits. Core names take precedence, then names
    without a vendor, then short ones."""
    root = ET.parse(gl_xml).getroot()
    core = {e.get('name') for f in root.findall('feature') for r in f.findall('require') for e in r.findall('enum')}

    def rank(name):
        return (name not in core, not name.endswith(('_ARB', '_KHR')) and name[-3:].isupper() and '_' in name[-5:], len(name), name)

    groups = {}
    for block in root.findall('enums'):
        bits = block.get('type') == 'bitmask'
        for e in block.findall('enum'):
            value = int(e.get('value'), 0)
            if value < 0 or value > 0xffffffff:
                continue
            names = [g for g in (e.get('group') or '').split(',') if g] + ([] if bits else [''])
            for group in names:
                known = groups.setdefault(group, {})
                if value not in known or rank(e.get('name')) < rank(known[value]):
                    known[value] = e.get('name')
    return groups


def parameter(p, group_number):
    travel = TRAVELS.get(p.how, 'Value')
    element = 'U64' if travel == 'Wide' else ELEMENTS.get(p.base, 'Bytes')
    if p.how in ('pixels', 'packed', 'data'):
        element = 'Bytes'
    size = p.expr if p.how == 'fixed' else 0
    group = group_number.get(p.group, 0) if element in ('Enum', 'Bits') else 0
    return '{"%s", Travel::%s, Element::%s, %d, %d}' % (p.name, travel, element, size, group)


def emit(m, gl_xml):
    enums = read_enums(gl_xml)
    used = {p.group for c in m.sent for p in c.params if p.group in enums and p.base in ('GLenum', 'GLbitfield')}
    group_number = {name: i for i, name in enumerate([''] + sorted(used))}
    out = HEAD + '''#include "streamcodec/command_parameters.hpp"

#include <algorithm>

#include "gl_opcodes.hpp"
namespace mural {
namespace {
constexpr ParameterInfo kParameters[] = {
'''
    first, ranges = 0, []
    for c in m.sent:
        params = [p for p in c.params if p.how != 'skip']
        assert all(p.base in TYPE_BYTES or p.pointers for p in params), c.name
        out += ''.join('    %s,\n' % parameter(p, group_number) for p in params)
        ranges.append('    case op::%s: return {std::span(kParameters).subspan(%d, %d), %d};\n' % (c.name, first, len(params), result_bytes(c)))
        first += len(params)
    out += '};\nconstexpr EnumName kEnums[] = { // sorted by group and value\n'
    for name, number in group_number.items():
        out += ''.join('    {%d, 0x%xu, "%s"},\n' % (number, value, named) for value, named in sorted(enums.get(name, {}).items()))
    out += '};\n} // namespace\n\nCommandParameters parametersOf(uint16_t opcode) {\n    switch (opcode) {\n' + ''.join(ranges)
    out += '''    default: return {};
    }
}

std::span<const EnumName> enumNames(uint16_t group) {
    const auto [first, end] = std::equal_range(std::begin(kEnums), std::end(kEnums), EnumName{group, 0, nullptr},
                                               [](const EnumName& a, const EnumName& b) { return a.group < b.group; });
    return {first, end};
}

const char* enumName(uint16_t group, uint32_t value) {
    const auto names = enumNames(group);
    const auto at = std::lower_bound(names.begin(), names.end(), value, [](const EnumName& e, uint32_t v) { return e.value < v; });
    return at != names.end() && at->value == value ? at->name : nullptr;
}
} // namespace mural
'''
    return {'command_parameters.cpp': out}
