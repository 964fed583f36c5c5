// What CreateContext's flags say beyond GL's own.
#pragma once

#include <cstdint>

namespace mural::wire {

// What the context has not flushed stays so when the program gives the context up (KHR_context_flush_control).
constexpr uint32_t kKeepsUnflushed = 0x40000000;

} // namespace mural::wire
