// Keeps the sample count of framebuffer objects without attachments equal to the native one. Mesa rounds the count to a
// supported number at the first draw, and reports the rounded number afterwards.
#pragma once

#include "interposer/context/thread_state.hpp"

namespace mural {

// Makes the driver round the count by an empty clear, because this context may not draw. Call before the next draw.
void fitDefaultSamples(const ThreadState& t);

} // namespace mural
