#include "nodes/replay/features/window_use.hpp"

#include "streamcodec/command_traits.hpp"

namespace mural {

WindowUse useOf(uint16_t opcode) {
    using enum Trait;
    if (hasTrait(opcode, Clear, ClearBuffer)) return WindowUse::Clears;
    if (hasTrait(opcode, Draw, Pixels, ClearNamed, Begin, CallList)) return WindowUse::Draws;
    if (hasTrait(opcode, FeedbackBegin)) return WindowUse::FeedbackBegins;
    return hasTrait(opcode, FeedbackEnd) ? WindowUse::FeedbackEnds : WindowUse::None;
}

} // namespace mural
