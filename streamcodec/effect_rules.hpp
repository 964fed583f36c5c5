// The effect of each command (streamcodec/command_effects.hpp), and the arguments that select the state it applies to.
#pragma once

#include <array>
#include <cstdint>

#include "streamcodec/command_effects.hpp"

namespace mural {

constexpr uint8_t kNoArgumentWord = 0xff;

struct EffectRule {
    EffectKind kind = EffectKind::Unknown;
    ObjectType type = ObjectType::None;
    uint32_t attribBits = 0; // of glPushAttrib: those that certainly save this state; 0: unknown
    // The words of a record that select the part of the state: scalars that name or count, before the first value of
    // variable size.
    uint8_t selectors = 0;
    std::array<uint8_t, 8> selectorWords{};
    uint8_t nameWord = kNoArgumentWord;   // CommandEffect::nameNumber
    uint8_t valueWord = kNoArgumentWord;  // the first value of variable size
    uint8_t resultWord = kNoArgumentWord; // a name that the driver created, after the arguments
    uint8_t dimensions = 1;               // of images
};

const EffectRule& effectRuleOf(uint16_t opcode);

} // namespace mural
