// glXUseXFont. Drivers create its display lists internally, where the stream cannot capture them.
#pragma once

#include <X11/Xlib.h>

namespace mural {

// With a current context: creates the lists listBase to listBase + count - 1, each with one glBitmap, through the
// program's own entry. Returns false if it has done nothing; the caller then uses the driver's function.
bool listsFromXFont(Display* dpy, Font font, int first, int count, int listBase);

} // namespace mural
