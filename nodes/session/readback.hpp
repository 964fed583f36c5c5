// Methods of picture readback. Direct: synchronous, before the next frame. Buffer: into a pixel buffer that another
// thread maps. Auto: the method that blocks the drawing thread less.
#pragma once

#include <cstdint>

namespace mural {

enum class Readback : uint8_t { Auto, Direct, Buffer };

} // namespace mural
