// What the fronts tell the rest of the interposer.
#pragma once

#include <cstdint>

namespace mural {

struct Window;
bool askGlxSize(const Window& w, uint32_t& width, uint32_t& height);
bool askEglSize(const Window& w, uint32_t& width, uint32_t& height);

} // namespace mural
