// Classifies records that draw into the window or copy from it. At the first of them after a swap, drivers adopt a new
// size of the window.
#pragma once

#include <cstdint>

namespace mural {

bool drawsIntoWindow(uint32_t opcode);

} // namespace mural
