"""The table of command traits: streamcodec/command_traits.hpp."""
from emit_common import HEAD


def traits_of(c):
    return sorted(c.traits | ({'DrawClass'} if c.command_class == 'draw' else set()))


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
    return {'command_traits.cpp': out + '    return all;\n}();\n} // namespace mural\n', 'skippable_draws.inc': skippable}
