#include "streamcodec/effect_rules.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/command_parameters.hpp"
#include "streamcodec/command_traits.hpp"

namespace mural {
namespace {

using enum EffectKind;

bool selects(const ParameterInfo& p, EffectKind kind) {
    const std::string_view name = p.name;
    if (kind == Uniform || kind == ProgramUniform) return name == "program" || name == "location" || name == "count";
    if (kind == Attribute || kind == Color)
        return p.element == Element::Enum || name == "index"; // other numbers are the value
    return p.element == Element::Enum || p.element == Element::U32 || p.element == Element::Bits || name == "level" ||
           name == "count" || name == "first" || name == "n";
}

void findSelectors(EffectRule& rule, uint16_t opcode) {
    // A record with an invalid enum must not replace an earlier record.
    const bool valueToo = hasTrait(opcode, Trait::EnumAsNumber);
    size_t word = 0;
    for (const ParameterInfo& p : parametersOf(opcode).parameters) {
        if (p.travel != Travel::Scalar || word > 200) break;
        if ((valueToo || selects(p, rule.kind)) && rule.selectors < rule.selectorWords.size())
            rule.selectorWords[rule.selectors++] = static_cast<uint8_t>(word);
        word += bytesOf(p.element) == 8 ? 2 : 1;
    }
}

bool isValue(const ParameterInfo& p) {
    return p.travel == Travel::Value || p.travel == Travel::Text || p.travel == Travel::Texts;
}

size_t wordsOf(const ParameterInfo& p) {
    if (p.travel == Travel::Fixed) return (size_t{p.fixedBytes} + 3) / 4;
    return p.travel == Travel::Wide || bytesOf(p.element) == 8 ? 2 : 1;
}

void findWords(EffectRule& rule, uint16_t opcode) {
    const CommandParameters command = parametersOf(opcode);
    size_t word = 0;
    for (const ParameterInfo& p : command.parameters) {
        if (isValue(p)) {
            rule.valueWord = static_cast<uint8_t>(std::min<size_t>(word, kNoArgumentWord));
            return; // words after it are not fixed
        }
        word += wordsOf(p);
    }
    if (command.resultBytes > 0) rule.resultWord = static_cast<uint8_t>(std::min<size_t>(word, kNoArgumentWord));
}

std::vector<EffectRule> allRules() {
    std::vector<EffectRule> rules(op::kLimit);
    for (uint16_t opcode = 0; opcode < op::kLimit; ++opcode) {
        const CommandEffect& effect = kCommandEffects[opcode];
        EffectRule& rule = rules[opcode];
        rule.kind = effect.kind;
        rule.type = effect.object;
        rule.attribBits = effect.attribBits;
        if (effect.nameNumber > 0) rule.nameWord = effect.nameNumber - 1;
        if (effect.dimensions > 0) rule.dimensions = effect.dimensions;
        findSelectors(rule, opcode);
        findWords(rule, opcode);
    }
    return rules;
}

} // namespace

const EffectRule& effectRuleOf(uint16_t opcode) {
    static const std::vector<EffectRule> kAll = allRules();
    static const EffectRule kNone;
    return opcode < kAll.size() ? kAll[opcode] : kNone;
}

} // namespace mural
