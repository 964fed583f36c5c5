// From an opcode to the generated function that decodes and calls it.
#pragma once

#include <array>
#include <cstdint>

#include "streamcodec/args.hpp"

namespace mural {

class Replay;
// False: the record is malformed.
using ReplayFunction = bool (*)(Replay&, Args&);
// Null: no such command.
ReplayFunction replayFunction(uint16_t opcode);

} // namespace mural
