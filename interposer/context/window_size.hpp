// The size of a drawable as the driver sees it.
#pragma once

#include <cstdint>

namespace mural {

struct ThreadState;
struct Window;

// Returns false if the drawable no longer exists.
bool queryWindowSize(const Window& w, uint32_t& width, uint32_t& height);

// Call before pixels of the window are read, because Mesa sizes its buffers then, too.
void beforeAwaitedReading(ThreadState& t);

} // namespace mural
