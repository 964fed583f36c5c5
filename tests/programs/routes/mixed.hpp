// For programs that draw into one context in two ways. New functions are found normally. Immediate mode comes from
// another library that shares the driver's dispatch (MIXED_LIBRARY; not defined: the first in the program's own order).
// At the end the programs print whether their window shows the whole picture.
#pragma once

#include <cstdio>
#include <cstring>
#include <dlfcn.h>

#include "tests/programs/routes/row_changes.hpp"
#include "tests/programs/routes/scene.hpp"
#include "tests/programs/support/program.hpp"

namespace programs {

inline bool isImmediate(const char* name) {
    for (const char* other :
         {"glBegin", "glEnd", "glVertex2f", "glColor3f", "glTexCoord2f", "glLoadIdentity", "glRotatef"}) {
        if (std::strcmp(name, other) == 0) {
            return true;
        }
    }
    return false;
}

inline GlFunction findElsewhere(const char* name) {
#ifdef MIXED_LIBRARY
    static void* library = dlopen(MIXED_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        fail("no library: %s", dlerror());
    }
#else
    void* library = RTLD_DEFAULT;
#endif
    return reinterpret_cast<GlFunction>(dlsym(library, name));
}

// Prints whether the window shows the whole picture, for the size 253x191: immediate mode draws above, buffers and
// shaders below.
inline void printWhetherComplete(Display* display, ::Window window, int width) {
    XSync(display, False);
    const bool above = changesInRow(display, window, 60, width) > 5,
               below = changesInRow(display, window, 140, width) > 5;
    std::printf("the window shows %s\n", above && below ? "the whole picture"
                                         : above        ? "the upper half"
                                         : below        ? "the lower half"
                                                        : "nothing");
}

} // namespace programs
