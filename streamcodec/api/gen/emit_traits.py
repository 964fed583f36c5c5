"""Emits the tables of traits and effects (streamcodec/command_traits.hpp, streamcodec/command_effects.hpp)."""
import re

from emit_common import HEAD
from emit_interposer import DATA_KINDS
from registry import TYPE_BYTES


def traits_of(c):
    return sorted(c.traits | ({'DrawClass'} if c.command_class == 'draw' else set()))


# Commands without an effect in the registry that may change the meaning of later commands.
CHANGES_NAMES = re.compile('Bind|Use|Active|Push|Pop|Begin|End|Delete|Matrix|List|ClientAttrib')


def effect_of(c):
    kind = c.option('effect') or ('UnknownNames' if CHANGES_NAMES.search(c.name) else 'Unknown')
    bits = {None: '0', 'none': 'kNoAttribBit'}.get(c.option('attrib'), 'GL_%s_BIT' % c.option('attrib'))
    return '{EffectKind::%s, ObjectType::%s, Deferral::%s, %s}' % (kind, c.option('object', 'None'), c.option('deferral', 'ByEffect'), bits)


# Effects on an object that the first argument names; another argument names an object that it refers to.
OWNERS = {'ArrayNamedSet': 'vertex array', 'PipelineSet': 'program pipeline'}
IMAGE_EFFECTS = ('TexImage', 'TexStorage', 'TexSubImage', 'TexCopyImage', 'TexCopySubImage')
# Members of DrawWords, by the parameter whose position they hold.
DRAW_WORDS = {'count': 'count', 'first': 'first', 'type': 'type', 'indices': 'indices', 'instancecount': 'instances', 'basevertex': 'base'}


OFFSET_WORDS = 3  # a tag, and an offset of 64 bits


def words_of(c, offsets=False):
    """Returns {parameter name: word of the record}, up to the first value of variable size; offsets: as if such values
    were offsets into buffers."""
    words, at = {}, 0
    for p in c.params:
        if p.how == 'skip':
            continue
        words[p.name] = at
        if p.how in DATA_KINDS:
            if not offsets:
                break
            at += OFFSET_WORDS
            continue
        if p.how == 'fixed':
            at += (p.expr + 3) // 4
        else:
            at += 2 if p.how in ('handle', 'offset') else max(4, TYPE_BYTES[p.base]) // 4
    return words


def name_word(c):
    """Returns the word of the last object that the arguments name, except the object that the command changes; or None."""
    words = words_of(c)
    named = [words[p.name] for p in c.params if p.object_class and p.object_class != OWNERS.get(c.option('effect')) and p.name in words]
    return named[-1] if named else None


def dimensions_of(c):
    names = {p.name for p in c.params}
    return 3 if names & {'depth', 'zoffset'} else 2 if names & {'height', 'yoffset'} else 1


def details_of(c):
    """Returns (member, value) of the members of CommandEffect that differ from their defaults."""
    kind = c.option('effect', 'Unknown')
    if c.option('cell'):
        yield 'cell', 'StateCell::' + c.option('cell')
    if c.option('check'):
        yield 'check', 'StateCheck::' + c.option('check')
    if c.option('list'):
        yield 'list', 'ListRole::' + c.option('list')
    if kind not in ('Unknown', 'UnknownNames') and name_word(c) is not None:
        yield 'nameNumber', name_word(c) + 1
    if kind in IMAGE_EFFECTS and dimensions_of(c) > 1:
        yield 'dimensions', dimensions_of(c)
    if c.option('vertices') == 'divisible':
        words = words_of(c, offsets=True)
        places = ['.%s = %d' % (member, words[name]) for name, member in DRAW_WORDS.items() if name in words]
        yield 'draw', '{%s}' % ', '.join(places)


def emit_effects(m):
    out = HEAD + '''#include "streamcodec/command_effects.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
namespace mural {
constexpr std::array<CommandEffect, op::kLimit> kCommandEffects = [] {
    std::array<CommandEffect, op::kLimit> all{};
'''
    for c in m.sent:
        out += '    all[op::%s] = %s;\n' % (c.name, effect_of(c))
        out += ''.join('    all[op::%s].%s = %s;\n' % (c.name, member, value) for member, value in details_of(c))
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
