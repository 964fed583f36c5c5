// Flags of CreateContext beyond GL's own.
#pragma once

#include <cstdint>

namespace mural::wire {

// No implicit flush when the context is released (KHR_context_flush_control).
constexpr uint32_t kKeepsUnflushed = 0x40000000;

} // namespace mural::wire
