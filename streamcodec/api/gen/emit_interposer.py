"""Emits encoders, one per command in the stream, and wrappers, one per command that a program may call."""
import re

from emit_common import HEAD, ctype, prototype
from registry import TYPE_BYTES

# Commands that emit a vertex between glBegin and glEnd if the index is 0.
PROVOKING = re.compile(r'glVertexAttribs?[ILP]?\d')
# Commands that a program may call between glBegin and glEnd.
IN_PRIMITIVE = re.compile(r'gl((Begin|End|CallLists?|PrimitiveRestartNV)$|(Vertex|Color|SecondaryColor|Normal|TexCoord|MultiTexCoord)P?\d'
                          r'|VertexAttribs?[ILP]?\d|Index([dfisx]|ub)v?|FogCoord[dfh]|EdgeFlagv?$|Material[fix]|ArrayElement|Eval(Coord|Point))')
DATA_KINDS = ('array', 'pixels', 'packed', 'data', 'made', 'text', 'strings')


def pixel_shape(c, dims):
    """Returns format, type, width, height and depth of an image parameter as C++ expressions."""
    if c.name == 'glPolygonStipple':
        return 'GL_COLOR_INDEX, GL_BITMAP, 32, 32, 1'
    have = {p.name for p in c.params}
    width = 'width' if 'width' in have else 'count'
    height = 'height' if dims >= 2 else '1'
    depth = 'depth' if dims >= 3 else '1'
    return 'format, type, %s, %s, %s' % (width, height, depth)


def result_bytes(c):
    """Returns the size of a name that the driver creates; it follows the arguments in the record."""
    if c.name == 'glFenceSync' or (c.command_class == 'object' and c.returns == 'GLuint64'):
        return 8
    return 4 if c.command_class == 'object' and c.returns != 'void' else 0


def fixed_bytes(c):
    total = 4
    for p in c.params:
        if p.how == 'scalar':
            total += max(4, TYPE_BYTES[p.base])
        elif p.how in ('handle', 'offset'):
            total += 8
        elif p.how == 'fixed':
            total += (p.expr + 3) // 4 * 4
    return total + result_bytes(c)


def encoder(c, opcode):
    args, puts, datas = ['ThreadState& self'], [], []
    for p in c.params:
        if p.how == 'skip':
            continue
        if p.how in DATA_KINDS:
            args.append('const DataArg& %s' % p.name)
            datas.append(p.name)
            puts.append('out_.data(%s);' % p.name)
        elif p.how == 'fixed':
            args.append('%s %s' % (ctype(p.type), p.name))
            puts.append('out_.bytes(%s, %d);' % (p.name, p.expr))
        elif p.how == 'offset':
            args.append('const void* %s' % p.name)
            puts.append('out_.put8(reinterpret_cast<uint64_t>(%s));' % p.name)
        elif p.how == 'handle':
            args.append('%s %s' % (ctype(p.type), p.name))
            puts.append('out_.put8(reinterpret_cast<uint64_t>(%s));' % p.name)
        else:
            args.append('%s %s' % (ctype(p.type), p.name))
            puts.append('out_.%s(%s);' % ('put8' if TYPE_BYTES[p.base] == 8 else 'put4', p.name))
    if result_bytes(c):
        args.append('%s result' % c.returns)
        puts.append('out_.put4(result);' if result_bytes(c) == 4 else
                    'out_.put8(result);' if c.returns == 'GLuint64' else 'out_.put8(reinterpret_cast<uint64_t>(result));')
    size = ' + '.join([str(fixed_bytes(c))] + ['wireBytes(%s)' % d for d in datas])
    spills = ''.join('    spillLarge(self, %s);\n' % d for d in datas)
    return ('inline void encode_%s(%s) {\n%s    const uint32_t size_ = %s;\n'
            '    std::byte* at_ = beginRecord(self, %d, size_);\n    if (!at_) return;\n    Writer out_{at_};\n    %s\n'
            '    endRecord(self, at_, size_);\n}\n' % (c.name, ', '.join(args), spills, size, opcode, '\n    '.join(puts)))


def uniform_elements(c):
    """Returns the element size of commands whose excessive count drivers limit to the uniform's; 0: another command."""
    value = c.param('value')
    found = re.fullmatch(r'vn\(count,(\d+)\)', value.expr) if value and value.how == 'array' else None
    return int(found.group(1)) if found and re.match(r'gl(Program)?Uniform', c.name) else 0


def is_element(c, p):
    """Returns true for a single pixel that fills a buffer. Drivers read it at the position given by the unpack state."""
    return p.how == 'array' and p.expr.startswith('clearBytes') and 'Buffer' in c.name


def data_argument(c, p):
    if is_element(c, p):
        return 'elementSource(self, %s, format, type)' % p.name
    if p.how == 'array':
        return 'DataArg::of(%s, %s)' % (p.name, p.expr)
    if p.how == 'text':
        return 'DataArg::text(%s)' % p.name
    if p.how == 'made':
        return 'DataArg::of(%s, vn(%s,4))' % (p.name, p.length)
    if p.how == 'packed':
        return 'packedSource(self, %s, vn(%s,1))' % (p.name, p.expr)
    if p.how == 'strings':
        return 'packStrings(self, %s, %s, %s)' % ('count', p.name, 'nullptr' if p.expr == '-' else p.expr)
    if p.how == 'pixels':
        return 'imageSource(self, %s, %s, %s)' % (p.name, pixel_shape(c, int(p.expr)), p.expr)
    raise SystemExit('%s: parameter %s needs app=custom' % (c.name, p.name))


def buffer_uses(c):
    """Returns statements for buffers that deferred reads may still write to."""
    if c.option('deferred') == 'completed':
        buffer = next((p.name for p in c.params if p.kind == 'Buffer'), None)
        return '    settleReads(self, %s);\n' % buffer if buffer else '    settleBound(self, target);\n'
    out = ''
    for p in c.params:
        if p.kind == 'Buffer' and p.pointers == 0:
            out += '    bufferUsed(self, %s);\n' % p.name
        elif p.kind == 'Buffer' and p.const:
            out += '    buffersUsed(self, %s, %s);\n' % (p.length or 'count', p.name)
    return out


def outside_primitive(c):
    """Returns a function that bypasses a hand-written wrapper between glBegin and glEnd, where drivers refuse the command."""
    names = ', '.join(p.name for p in c.params)
    return ('extern "C" %s outside_%s(%s) {\n    if (refusedInPrimitive(*tThread)) [[unlikely]] return gReal.%s(%s);\n    return mural_%s(%s);\n}\n'
            % (ctype(c.returns), c.name, prototype(c), c.name, names, c.name, names))


def wrapper(c):
    ret = ctype(c.returns)
    names = ', '.join(p.name for p in c.params)
    out = 'extern "C" %s mural_%s(%s) {\n    ThreadState& self = *tThread;\n' % (ret, c.name, prototype(c))
    if not IN_PRIMITIVE.match(c.name):
        out += '    if (refusedInPrimitive(self)) [[unlikely]] return gReal.%s(%s);\n' % (c.name, names)
    encode_args = ', '.join(['self'] + [data_argument(c, p) if p.how in DATA_KINDS else p.name
                                     for p in c.params if p.how != 'skip'])
    if c.option('array'):
        out += '    const ArrayWatch watch(self, vaobj, %s);\n' % c.option('array')
    out += buffer_uses(c)
    if c.option('app') == 'writes':
        if c.name.startswith('glBindBuffers'):
            out += '    if (writesThrough(target)) buffersMayBeWritten(self, count, buffers);\n'
        elif c.name.startswith('glBindBuffer'):
            out += '    if (writesThrough(target)) nodesMayWrite(self, buffer);\n'
        else:
            out += '    nodesMayWrite(self, 0);\n'
    if c.option('before'):
        out += '    %s;\n' % c.option('before')
    if c.option('reads') == 'buffers':
        out += '    buffersRead(self);\n'
    if c.command_class == 'object':
        if c.returns != 'void':
            out += '    const %s result = gReal.%s(%s);\n' % (ret, c.name, names)
            out += '    encode_%s(%s, result);\n    return result;\n' % (c.name, encode_args)
        else:
            out += '    gReal.%s(%s);\n    encode_%s(%s);\n' % (c.name, names, c.name, encode_args)
    elif c.option('app') == 'checked':
        local = 'gReal.%s(%s)' % (c.name, names)
        out += '    if (!self.context) return %s;\n' % local
        out += '    if (raisesNothing(*self.context, [&] { %s; })) encode_%s(%s);\n' % (local, c.name, encode_args)
    else:
        if c.option('copies'):
            out += '    copies::gather(self, x, y, width, %s, %s);\n' % ('height' if c.param('height') else '1', c.option('copies'))
        elements = uniform_elements(c)
        if elements:
            out += '    const GLsizei given = count;\n    if (count > kSureElements) [[unlikely]] count = readableElements(value, count, %d);\n' % elements
            names = names.replace('count', 'given')
        out += '    encode_%s(%s);\n' % (c.name, encode_args)
        local = c.option('local') != 'no'
        if local and c.command_class == 'draw':
            wrong = ' || !(%s)' % c.option('right') if c.option('right') else ''
            flag = 'drawLocally' if c.option('quiet') else 'vertexLocally'
            out += '    if (self.%s%s) gReal.%s(%s);\n' % (flag, wrong, c.name, names)
            if c.option('quiet'):
                out += '    else %s;\n' % c.option('quiet')
        elif local:
            if PROVOKING.match(c.name) and any(p.name == 'index' for p in c.params):
                right = '(%s) && ' % c.option('right') if c.option('right') else ''
                out += '    if (%squiet::vertex(self, index)) return;\n' % right
            out += '    gReal.%s(%s);\n' % (c.name, names)
    return out + '}\n'


def unsupported(c):
    names = ', '.join(p.name for p in c.params)
    ret = ctype(c.returns)
    return ('extern "C" %s mural_%s(%s) {\n    unsupportedCalled("%s", "%s");\n    %sgReal.%s(%s);\n}\n' % (
        ret, c.name, prototype(c), c.name, c.reason.replace('"', "'"), 'return ' if ret != 'void' else '', c.name, names))


def own_needs(m):
    """Returns the function that loads what wrappers of other commands call."""
    names = ''.join('        "%s",\n' % c.name for c in m.canonical if c.option('loaded') == 'always')
    if not names:
        return ''
    return 'void loadOwnNeeds() {\n    static const char* const kNames[] = {\n%s    };\n    for (const char* name : kNames) wrapperFor(name);\n}\n' % names


def emit(m):
    encoders = HEAD + '''#pragma once
#include "gl_opcodes.hpp"
#include "interposer/encode/encode_support.hpp"
namespace mural {
'''
    encoders += ''.join(encoder(c, m.opcode[c.name]) for c in m.sent) + '} // namespace mural\n'

    custom = [c for c in m.canonical if c.option('app') == 'custom' and c.command_class != 'unsupported']
    declarations = HEAD + '#pragma once\n#include <GL/gl.h>\n#include <GL/glext.h>\n// Wrappers written by hand: interposer/wrappers/.\nextern "C" {\n'
    declarations += ''.join('%s mural_%s(%s);\n' % (ctype(c.returns), c.name, prototype(c)) for c in custom) + '}\n'

    wrappers = HEAD + '''#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/memory/array_watch.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/copies.hpp"
#include "interposer/wrappers/validate_only_draws.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/context/open_primitive.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/wrapper_table.hpp"
#include "streamcodec/size_expressions.hpp"
using namespace mural;
'''
    body, rows = '', []
    for c in m.canonical:
        if c.command_class == 'unsupported':
            body += unsupported(c)
            rows.append('unsupported')
        elif c.option('app') == 'custom':
            outside = not IN_PRIMITIVE.match(c.name)
            body += outside_primitive(c) if outside else ''
            rows.append('outside' if outside else 'wrapped')
        elif c.sent and c.name in m.opcode:
            body += wrapper(c)
            rows.append('wrapped')
        else:
            rows.append('direct') # a query: calls the driver's own entry point without overhead
    wrappers += body + '\nnamespace mural {\nnamespace {\nusing Entry = void (*)();\nconst Entry kWrappers[] = { // in the order of GlFunctions\n'
    for c, row in zip(m.canonical, rows):
        front = 'outside' if row == 'outside' else 'mural'
        wrappers += '    %s,\n' % ('nullptr' if row == 'direct' else 'reinterpret_cast<Entry>(%s_%s)' % (front, c.name))
    wrappers += '};\nconst bool kSupported[] = {\n'
    wrappers += ''.join('    %s,\n' % ('false' if row == 'unsupported' else 'true') for row in rows)
    wrappers += '''};
} // namespace
void (*wrapperAt(int index))() { return kWrappers[index]; }
bool isSupportedAt(int index) { return kSupported[index]; }
'''
    wrappers += own_needs(m) + '} // namespace mural\n'
    return {'encoders.hpp': encoders, 'custom_wrappers.hpp': declarations, 'wrappers.cpp': wrappers}
