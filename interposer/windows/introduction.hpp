// Tells the head where a window is, and proves that it is the program's: by the number of its X display, and by a
// property of the window (common/window_mark.hpp).
#pragma once

namespace mural {

struct Window;

// Call it before the window's first record and before the question for the window's size: the answer to that question
// proves that the server has the property. The thread must be allowed to use the window's X connection. Idempotent.
void introduceWindow(Window& w);

} // namespace mural
