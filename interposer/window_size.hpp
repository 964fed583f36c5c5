// How large the driver takes a drawable to be.
#pragma once

#include <cstdint>

namespace mural {

struct Window;

// False when it can't be told (the drawable is gone).
bool askWindowSize(const Window& w, uint32_t& width, uint32_t& height);

} // namespace mural
