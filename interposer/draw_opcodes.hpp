// Records that draw into the window or copy from it. At the first one after a swap, a driver adopts the window's size.
#pragma once

#include <cstdint>

namespace mural {

bool drawsIntoWindow(uint32_t opcode);

} // namespace mural
