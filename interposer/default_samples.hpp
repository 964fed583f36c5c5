// Framebuffer objects without attachments have a number of samples of their own. A driver may fit it to the
// numbers that it has when it first draws there (Mesa), and tells the fitted number from then on.
#pragma once

#include "interposer/thread_state.hpp"

namespace mural {

// Before the next draw: a context that draws nothing fits the number all the same.
void fitDefaultSamples(const ThreadState& t);

} // namespace mural
