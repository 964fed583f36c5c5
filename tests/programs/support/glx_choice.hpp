// Chooses GLX configurations and contexts for programs that create their drawables themselves.
#pragma once

#include <GL/glx.h>

namespace programs {

// Returns a configuration with two colour buffers of 8 bits, for drawables of these kinds (GLX_WINDOW_BIT …), with at
// least that depth. Ends the program if there is none.
GLXFBConfig chooseGlxConfig(Display* display, int drawableBits, int depthBits = 0);

// Creates a core 3.3 context. `share` may be null. Ends the program on failure.
GLXContext makeCoreGlxContext(Display* display, GLXFBConfig config, GLXContext share);

} // namespace programs
