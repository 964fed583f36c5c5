// Minimum time for a flush, whose deadline is that of the last write and may have passed long ago.
#pragma once

#include <cstdint>

namespace mural {

constexpr int64_t kFlushGraceMs = 1000;

} // namespace mural
