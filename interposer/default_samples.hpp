// Framebuffer objects without attachments have their own number of samples. Mesa rounds it to a supported number at the
// first draw, and reports the rounded number afterwards.
#pragma once

#include "interposer/thread_state.hpp"

namespace mural {

// Call before the next draw. A context that does not draw then rounds the number as well.
void fitDefaultSamples(const ThreadState& t);

} // namespace mural
