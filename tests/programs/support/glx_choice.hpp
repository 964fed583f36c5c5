// GLX configurations and contexts of programs that make their drawables themselves.
#pragma once

#include <GL/glx.h>

namespace programs {

// Two colour buffers of 8 bits, for drawables of these kinds (GLX_WINDOW_BIT …), with at least that much depth.
// Ends the program when there is none.
GLXFBConfig chooseGlxConfig(Display* display, int drawableBits, int depthBits = 0);

// Core 3.3. share may be null. Ends the program when it can't be made.
GLXContext makeCoreGlxContext(Display* display, GLXFBConfig config, GLXContext share);

} // namespace programs
