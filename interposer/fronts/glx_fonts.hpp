// glXUseXFont: drivers make its display lists inside themselves, where no other machine sees them.
#pragma once

#include <X11/Xlib.h>

namespace mural {

// With a context current: makes the lists listBase to listBase + count - 1 of one glBitmap each by the program's own way to GL.
// False: nothing was done, the driver's own function is to be called.
bool listsFromXFont(Display* dpy, Font font, int first, int count, int listBase);

} // namespace mural
