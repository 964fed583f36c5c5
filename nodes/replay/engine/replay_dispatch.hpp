// Maps an opcode to the generated function that decodes and executes it.
#pragma once

#include <array>
#include <cstdint>

#include "streamcodec/wire/args.hpp"

namespace mural {

class Replay;
// Returns false for a malformed record.
using ReplayFunction = bool (*)(Replay&, Args&);
// Null: unknown opcode.
ReplayFunction replayFunction(uint16_t opcode);

} // namespace mural
