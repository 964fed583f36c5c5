// Functions of the entries that the rest of the interposer calls.
#pragma once

#include <cstdint>

namespace mural {

struct Context;
struct Window;
// Call the driver's own function, not the wrapper of the entry: make the context current with these windows in the
// calling thread.
bool makeGlxCurrent(const Window& draw, const Window& read, const Context& context);
bool makeEglCurrent(const Window& draw, const Window& read, const Context& context);
bool queryGlxSize(const Window& w, uint32_t& width, uint32_t& height);
bool queryEglSize(const Window& w, uint32_t& width, uint32_t& height);

} // namespace mural
