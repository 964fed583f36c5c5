// Detects pictures drawn past the capture library, wholly or partly. Without captured GL calls: does the program draw
// into its context by another path, or has it not drawn yet? With captured calls, which do not draw locally: has
// something been drawn there anyway (local_pixels.hpp)?
#pragma once

namespace mural {

struct ThreadState;
struct Window;

// Call before and after control records are written. Calls in between belong to the program.
void noteCalls(ThreadState& t);
void watchFromHere(ThreadState& t);
// Call before a picture is sent. Returns true if the context is used past us; this has been reported, and the program
// continues without capture.
bool drawnElsewhere(ThreadState& t, Window& w);

} // namespace mural
