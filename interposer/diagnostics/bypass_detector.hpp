// Detects pictures that bypass the capture library, wholly or partly. If no GL call was captured, the program draws by
// another path, or has not drawn yet. If calls were captured but do not draw locally, a changed local back buffer
// proves another path (back_buffer_probe.hpp).
#pragma once

namespace mural {

struct ThreadState;
struct Window;

// Call before and after control records are written. Calls in between belong to the program.
void recordCalls(ThreadState& t);
void watchFromHere(ThreadState& t);
// Call before a picture is sent. Returns true if the program draws into the context by another path. This has then been
// reported, and the program continues without capture.
bool bypassesCapture(ThreadState& t, Window& w);

} // namespace mural
