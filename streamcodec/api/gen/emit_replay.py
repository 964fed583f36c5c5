"""Emits the replay functions, one per command of the stream: each validates all lengths, decodes and calls GL."""
import re

from emit_common import HEAD, ctype
from emit_interposer import DATA_KINDS, is_element, pixel_shape, result_bytes
from registry import TYPE_BYTES

NULLABLE = re.compile(r'gl(Named)?Buffer(Data|Storage)')
WINDOW_POSITION = re.compile(r'glWindowPos')
COUNT = re.compile(r'(?:vn|n4|n8)\((\w+),')
MAY_BE_OFFSET = ('pixels', 'packed', 'data') # offset into a bound buffer; without one GL would use it as an address
RESULT = {4: 'GLuint', 8: 'uint64_t'}


def nullable(c, p):
    if p.how == 'array':
        return bool(NULLABLE.match(c.name)) or p.expr.startswith(('n4', 'n8', 'clearBytes', 'labelBytes', '0'))
    return p.how in ('pixels', 'packed') and 'Sub' not in c.name and c.name not in ('glDrawPixels', 'glPolygonStipple')


def negative_counts(c):
    """Returns the counts whose negative values are errors. The program has already received the error, and Mesa would copy
    that many values."""
    found = [COUNT.match(p.expr) for p in c.params if p.how == 'array']
    counts = {match.group(1) for match in found if match} | {p.length for p in c.params if p.how == 'made'}
    return [p.name for p in c.params if p.name in counts and p.how == 'scalar' and p.base in ('GLsizei', 'GLint', 'GLsizeiptr')]


def decode(c):
    """Returns statements that read the arguments into locals with the names of the parameters."""
    lines = []
    for p in c.params:
        if p.how == 'skip':
            continue
        if p.how in DATA_KINDS:
            lines.append('const Data %s = in_.%s();' % (p.name, 'data' if p.how in MAY_BE_OFFSET else 'values'))
        elif p.how == 'fixed':
            element = ctype(p.base) if p.base not in ('void', 'GLvoid') else 'std::byte'
            lines.append('const auto* %s = in_.fixed<%s>(%d);' % (p.name, element, p.expr))
        elif p.how in ('offset', 'handle'):
            lines.append('const auto %s = in_.get<uint64_t>();' % p.name)
        else:
            lines.append('const auto %s = in_.%s<%s>();' % (p.name, 'get' if TYPE_BYTES[p.base] >= 4 else 'narrow', ctype(p.type)))
    if result_bytes(c):
        lines.append('const auto result = in_.get<%s>();' % RESULT[result_bytes(c)])
    lines.append('if (!in_.ok()) return false;')
    lines += ['if (%s < 0) return true;' % name for name in negative_counts(c)]
    for p in c.params:
        if p.how == 'array' or p.how == 'made' or p.how == 'packed':
            expr = 'vn(%s,4)' % p.length if p.how == 'made' else p.expr
            lines.append('if (!%s.covers(%s)) return false;' % (p.name, expr if p.how != 'packed' else 'vn(%s,1)' % expr))
        elif p.how == 'pixels':
            lines.append('if (!%s.covers(sizes::tightBytes(%s))) return false;' % (p.name, pixel_shape(c, int(p.expr))))
        elif p.how == 'data' and p.expr is not True:
            lines.append('if (!%s.covers(%s)) return false;' % (p.name, p.expr))
        elif p.how == 'text':
            lines.append('if (!%s.isText()) return false;' % p.name)
        if p.how in ('array', 'pixels', 'packed', 'made', 'text') and not nullable(c, p):
            lines.append('if (%s.absent()) return true;' % p.name)
    return lines


def argument(c, p):
    if p.how == 'skip':
        return None
    pointer = ctype(p.type)
    if p.how in ('array', 'pixels', 'packed', 'text', 'data'):
        if p.how == 'array' and p.kind and p.length:
            return 'replay_.names(Kind::%s, %s.as<GLuint>(), %s)' % (p.kind, p.name, p.length)
        return 'static_cast<%s>(%s.pointer())' % (pointer, p.name)
    if p.how == 'offset':
        return 'reinterpret_cast<const void*>(%s)' % p.name
    if p.how == 'fixed':
        if p.kind:
            return 'replay_.names(Kind::%s, %s, 1)' % (p.kind, p.name)
        if WINDOW_POSITION.match(c.name):
            return 'replay_.windowPosition(%s, %d).data()' % (p.name, p.expr // TYPE_BYTES[p.base])
        return p.name
    if WINDOW_POSITION.match(c.name) and p.name in ('x', 'y'):
        return 'replay_.window%s(%s)' % (p.name.upper(), p.name)
    if p.kind:
        return 'replay_.name(Kind::%s, %s)' % (p.kind, p.name)
    if p.name == 'location' and c.name.startswith('glUniform'):
        return 'replay_.uniformLocation(location)'
    if p.name == 'location' and c.name.startswith('glProgramUniform'):
        return 'replay_.uniformLocation(program, location)'
    return p.name


def strings_call(c):
    strings = next(p for p in c.params if p.how == 'strings')
    args = []
    for p in c.params:
        if p is strings:
            args.append('texts.pointers()')
        elif p.how == 'skip':
            args.append('texts.lengths()')
        else:
            args.append(argument(c, p))
    return ['StringList texts;', 'if (!texts.parse(%s, count)) return false;' % strings.name], args


def call(c):
    if c.option('node') == 'custom':
        args = [p.name for p in c.params if p.how != 'skip']
        if result_bytes(c):
            args.append('result')
        return ['replay_.%s(%s);' % (c.name, ', '.join(args)), 'return true;']
    lines = ['if (!replay_.gl.%s) return replay_.lacking(op::%s);' % (c.name, c.name)]
    if any(p.how == 'strings' for p in c.params):
        before, args = strings_call(c)
        return lines + before + ['replay_.gl.%s(%s);' % (c.name, ', '.join(args)), 'return true;']
    made = next((p for p in c.params if p.how == 'made'), None)
    if made:
        args = ', '.join('made' if p is made else argument(c, p) for p in c.params)
        lines.append('replay_.make(Kind::%s, %s, %s.as<GLuint>(), [&](GLuint* made) { replay_.gl.%s(%s); });' % (
            made.kind, made.length, made.name, c.name, args))
        return lines + ['return true;']
    args = ', '.join(argument(c, p) for p in c.params)
    if c.command_class == 'object' and c.returns != 'void':
        lines.append('replay_.bindName(Kind::Program, result, replay_.gl.%s(%s));' % (c.name, args))
        return lines + ['return true;']
    for p in c.params:
        if p.how in ('pixels', 'packed') or p.name == 'bitmap' or is_element(c, p):
            lines.append('if (!replay_.unpackFor(%s)) return true;' % p.name)
        elif p.how == 'data' and p.expr is not True:
            lines.append('if (!replay_.readable(%s, %s)) return true;' % (
                p.name, 'GL_DRAW_INDIRECT_BUFFER_BINDING' if p.name == 'indirect' else 'GL_ELEMENT_ARRAY_BUFFER_BINDING'))
    if c.option('copies'):
        moved = ', '.join('from' + p.name.upper() if p.name in ('x', 'y') else argument(c, p) for p in c.params)
        height = 'height' if c.param('height') else '1'
        return lines + ['replay_.copyLevel(x, y, width, %s, [&](GLint fromX, GLint fromY) { replay_.gl.%s(%s); });' % (height, c.name, moved), 'return true;']
    call_text = 'replay_.gl.%s(%s);' % (c.name, args)
    lines.append('replay_.withoutTile([&] { %s });' % call_text if c.option('node') == 'whole' else call_text)
    if c.name.startswith('glDelete'):
        for p in c.params:
            if p.how == 'array' and p.kind:
                lines.append('replay_.forget(Kind::%s, %s.as<GLuint>(), %s);' % (p.kind, p.name, p.length))
    return lines + ['return true;']


def custom_declaration(c):
    args = []
    for p in c.params:
        if p.how == 'skip':
            continue
        if p.how in DATA_KINDS:
            args.append('const Data& %s' % p.name)
        elif p.how == 'fixed':
            args.append('const %s* %s' % (ctype(p.base), p.name))
        elif p.how in ('offset', 'handle'):
            args.append('uint64_t %s' % p.name)
        else:
            args.append('%s %s' % (ctype(p.type), p.name))
    if result_bytes(c):
        args.append('%s result' % RESULT[result_bytes(c)])
    return 'void %s(%s);\n' % (c.name, ', '.join(args))


def emit(m):
    source = HEAD + '''#include "gl_opcodes.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/engine/replay_dispatch.hpp"
#include "streamcodec/size_expressions.hpp"
namespace mural {
namespace {
'''
    for c in m.sent:
        used = decode(c) + call(c)
        source += 'bool replay_%s([[maybe_unused]] Replay& replay_, [[maybe_unused]] Args& in_) {\n    %s\n}\n' % (c.name, '\n    '.join(used))
    source += '} // namespace\n\nReplayFunction replayFunction(uint16_t opcode) {\n    static constexpr auto kTable = [] {\n        std::array<ReplayFunction, op::kLimit> table{};\n'
    source += ''.join('        table[op::%s] = replay_%s;\n' % (c.name, c.name) for c in m.sent)
    source += '''        return table;
    }();
    return opcode < kTable.size() ? kTable[opcode] : nullptr;
}
} // namespace mural
'''
    names = HEAD + '''#include "gl_opcodes.hpp"
#include "streamcodec/opcode_names.hpp"
namespace mural {
const char* glOpcodeName(uint16_t opcode) {
    switch (opcode) {
'''
    names += ''.join('    case op::%s: return "%s";\n' % (c.name, c.name) for c in m.sent)
    names += '    default: return nullptr;\n    }\n}\n} // namespace mural\n'
    custom = HEAD + '// Members of class Replay that are written by hand: nodes/replay/.\n'
    custom += ''.join(custom_declaration(c) for c in m.sent if c.option('node') == 'custom')
    return {'replay_dispatch.cpp': source, 'replay_custom.inc': custom, 'opcode_names.cpp': names}
