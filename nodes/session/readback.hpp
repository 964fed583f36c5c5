// How pictures leave a node's GL: Direct: they are read before the next frame is drawn. Buffer: GL writes them into a buffer, for which another thread waits.
// Auto: by which of both the drawing thread loses less.
#pragma once

#include <cstdint>

namespace mural {

enum class Readback : uint8_t { Auto, Direct, Buffer };

} // namespace mural
