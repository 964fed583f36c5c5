// Minimum time for a flush. A flush has the deadline of the last write, which may have passed long ago.
#pragma once

#include <cstdint>

namespace mural {

constexpr int64_t kFlushGraceMs = 1000;

} // namespace mural
