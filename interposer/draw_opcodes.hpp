// Which records draw into the window, or copy out of it: at the first of them after a swap a driver
// gives its buffers the window's size.
#pragma once

#include <cstdint>

namespace mural {

bool drawsIntoWindow(uint32_t opcode);

} // namespace mural
