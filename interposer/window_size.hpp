// The size of a drawable as the driver sees it.
#pragma once

#include <cstdint>

namespace mural {

struct ThreadState;
struct Window;

// Returns false if the drawable no longer exists.
bool askWindowSize(const Window& w, uint32_t& width, uint32_t& height);

// Before pixels of the window are read: Mesa gives its buffers their size then, too.
void beforeAwaitedReading(ThreadState& t);

} // namespace mural
