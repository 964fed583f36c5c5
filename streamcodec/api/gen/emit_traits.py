"""Emits the tables of traits and effects (streamcodec/command_traits.hpp, streamcodec/command_effects.hpp)."""
import re

from emit_common import HEAD


def traits_of(c):
    return sorted(c.traits | ({'DrawClass'} if c.command_class == 'draw' else set()))


# Commands without an effect in the registry that may change the meaning of later commands.
CHANGES_NAMES = re.compile('Bind|Use|Active|Push|Pop|Begin|End|Delete|Matrix|List|ClientAttrib')


def effect_of(c):
    kind = c.option('effect') or ('UnknownNames' if CHANGES_NAMES.search(c.name) else 'Unknown')
    bits = {None: '0', 'none': 'kNoAttribBit'}.get(c.option('attrib'), 'GL_%s_BIT' % c.option('attrib'))
    return '{EffectKind::%s, ObjectType::%s, Deferral::%s, %s}' % (kind, c.option('object', 'None'), c.option('deferral', 'ByEffect'), bits)


def emit_effects(m):
    out = HEAD + '''#include "streamcodec/command_effects.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
namespace mural {
constexpr std::array<CommandEffect, op::kLimit> kCommandEffects = [] {
    std::array<CommandEffect, op::kLimit> all{};
'''
    out += ''.join('    all[op::%s] = %s;\n' % (c.name, effect_of(c)) for c in m.sent)
    return out + '    return all;\n}();\n} // namespace mural\n'


def emit(m):
    out = HEAD + '''#include "streamcodec/command_traits.hpp"
namespace mural {
namespace {
constexpr auto bits(auto... traits) { return (bitOf(traits) | ...); }
} // namespace

constexpr std::array<uint64_t, op::kLimit> kCommandTraits = [] {
    using enum Trait;
    std::array<uint64_t, op::kLimit> all{};
'''
    for c in m.sent:
        if traits_of(c):
            out += '    all[op::%s] = bits(%s);\n' % (c.name, ', '.join(traits_of(c)))
    skippable = HEAD + '// Members of GlFunctions: the draws with the trait SkippableDraw.\n'
    skippable += ',\n'.join('&GlFunctions::%s' % c.name for c in m.sent if 'SkippableDraw' in c.traits) + '\n'
    return {'command_traits.cpp': out + '    return all;\n}();\n} // namespace mural\n', 'command_effects.cpp': emit_effects(m), 'skippable_draws.inc': skippable}
