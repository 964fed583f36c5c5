// A flush goes by the deadline of the last write, which may be long ago: so long it has in any case.
#pragma once

#include <cstdint>

namespace mural {

constexpr int64_t kFlushGraceMs = 1000;

} // namespace mural
