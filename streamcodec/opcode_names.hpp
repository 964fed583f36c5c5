// Names of GL opcodes, for messages and dumps. Null: unknown.
#pragma once

#include <cstdint>

namespace mural {
const char* glOpcodeName(uint16_t opcode);
} // namespace mural
