// Reports the location of a window to the head, by the number of its X display. A property of the window
// (common/ipc/window_mark.hpp) proves that the window belongs to the program.
#pragma once

namespace mural {

struct Window;

// Call it before the window's first record and before the query of the window's size. The answer to that query proves
// that the server has the property. The thread must be allowed to use the window's X connection. Idempotent.
void introduceWindow(Window& w);

} // namespace mural
