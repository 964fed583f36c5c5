#include "interposer/encode/draw_opcodes.hpp"

#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

bool drawsIntoWindow(uint32_t opcode) {
    return opcode == wire::kOpClientArrays || hasTrait(opcode, Trait::DrawClass, Trait::ReadsFramebuffer);
}

} // namespace mural
