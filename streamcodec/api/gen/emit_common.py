"""Emits the tables that capture library and nodes share: opcodes, entry points and the command table."""

HEAD = '// Generated from the OpenGL registry by streamcodec/api/gen. Do not edit.\n'


class Model:
    def __init__(self, commands, extensions, opcode, digest):
        self.all = commands
        self.extensions = extensions
        self.opcode = opcode
        self.digest = digest
        # One entry per meaning: aliases share the wrapper, opcode and replay of their canonical command.
        self.canonical = [c for c in commands.values() if not c.alias]
        self.aliases = [c for c in commands.values() if c.alias]
        self.sent = [c for c in self.canonical if c.sent and c.name in opcode]

    def of(self, command):
        return self.all[command.alias] if command.alias else command


# Foreign handle types, declared as pointers. Commands with them have a name but are never supported.
OPAQUE = {'GLeglImageOES': 'void*', 'GLeglClientBufferEXT': 'void*', 'GLVULKANPROCNV': 'void*', 'GLvdpauSurfaceNV': 'GLintptr',
          'GLDEBUGPROC': 'void*', 'GLDEBUGPROCARB': 'void*', 'GLDEBUGPROCAMD': 'void*', 'GLDEBUGPROCKHR': 'void*',
          'GLhandleARB': 'GLuint', 'GLclampx': 'GLint', 'GLfixed': 'GLint'}


def ctype(text):
    for name, real in OPAQUE.items():
        text = text.replace(name, real)
    return (text.replace('struct _cl_context', 'void').replace('struct _cl_event', 'void')
            .replace(' *', '*').replace('*const*', '* const*'))


def prototype(c, params=True):
    return ', '.join(ctype(p.type) + ((' ' + p.name) if params else '') for p in c.params)


def emit(m):
    ops = HEAD + '#pragma once\n#include <cstdint>\nnamespace mural::op {\nenum Gl : uint16_t {\n'
    ops += ''.join('    %s = %d,\n' % (c.name, m.opcode[c.name]) for c in m.canonical if c.name in m.opcode)
    ops += '};\nconstexpr uint16_t kLimit = %d;\n} // namespace mural::op\n' % (max(m.opcode.values()) + 1)

    table = HEAD + '''#pragma once
#include <GL/gl.h>
#include <GL/glext.h>
namespace mural {
// Entry points of a driver, one per command; null where the driver has none.
struct GlFunctions {
'''
    table += ''.join('    %s (*%s)(%s);\n' % (ctype(c.returns), c.name, prototype(c, False)) for c in m.canonical)
    table += '''};
// Where in GlFunctions the command or alias `name` stands, as an index of pointers; -1 unknown.
int glFunctionIndex(const char* name);
// The command at that index, under the name that leads its aliases.
const char* glFunctionName(int index);
// Fills the table: loader(name) for each command and, where that gives nothing, for its aliases.
void loadGlFunctions(GlFunctions& table, void (*(*loader)(void* self, const char* name))(), void* self);
} // namespace mural
'''
    index = {c.name: i for i, c in enumerate(m.canonical)}
    rows = sorted((c.name, index[m.of(c).name]) for c in m.all.values())
    source = HEAD + '''#include "gl_functions.hpp"
#include <cstring>
namespace mural {
namespace {
struct Row { const char* name; int index; };
constexpr Row kRows[] = { // sorted by name
'''
    source += ''.join('    {"%s", %d},\n' % r for r in rows)
    source += '''};
constexpr int kCount = sizeof(kRows) / sizeof(kRows[0]);
constexpr const char* kNames[] = { // by index
NAMES};
} // namespace

const char* glFunctionName(int index) { return kNames[index]; }

int glFunctionIndex(const char* name) {
    int low = 0, high = kCount - 1;
    while (low <= high) {
        const int middle = (low + high) / 2;
        const int order = std::strcmp(name, kRows[middle].name);
        if (order == 0) return kRows[middle].index;
        if (order < 0) high = middle - 1; else low = middle + 1;
    }
    return -1;
}

void loadGlFunctions(GlFunctions& table, void (*(*loader)(void*, const char*))(), void* self) {
    auto** slots = reinterpret_cast<void (**)()>(&table);
    int index = 0;
    for (const char* name : kNames) slots[index++] = loader(self, name);
    for (const Row& row : kRows) {
        if (slots[row.index]) continue;
        slots[row.index] = loader(self, row.name);
    }
}
} // namespace mural
'''
    source = source.replace('NAMES', ''.join('    "%s",\n' % c.name for c in m.canonical))
    info = HEAD + '''#include "streamcodec/command_table.hpp"
#include "streamcodec/registry_digest.hpp"
namespace mural {
namespace {
constexpr CommandInfo kCommands[] = { // sorted by name
'''
    for c in sorted(m.all.values(), key=lambda x: x.name):
        k = m.of(c)
        info += '    {"%s", "%s", "%s", %s, %s},\n' % (
            c.name, k.command_class, k.reason.replace('"', "'"), 'true' if k.command_class != 'unsupported' else 'false',
            m.opcode.get(k.name, 0))
    info += '};\nconstexpr ExtensionInfo kExtensions[] = { // sorted by name\n'
    for name, (_, names) in sorted(m.extensions.items()):
        lacking = [n for n in names if m.of(m.all[n]).command_class == 'unsupported']
        info += '    {"%s", %s, "%s"},\n' % (name, 'false' if lacking else 'true', lacking[0] if lacking else '')
    info += '''};
} // namespace
std::span<const CommandInfo> commandTable() { return kCommands; }
std::span<const ExtensionInfo> extensionTable() { return kExtensions; }
uint64_t registryDigest() { return 0x%016xull; }
} // namespace mural
''' % m.digest
    return {'gl_opcodes.hpp': ops, 'gl_functions.hpp': table, 'gl_functions.cpp': source, 'command_table.cpp': info}
