// A rough measure of a window's contents: the scene's pictures have many colours along a row, an empty window has one.
#pragma once

#include <X11/Xutil.h>

namespace programs {

// Returns the number of colour changes along a row of the window.
inline int changesInRow(Display* display, ::Window window, int y, int width) {
    XImage* image = XGetImage(display, window, 0, y, static_cast<unsigned>(width), 1, AllPlanes, ZPixmap);
    int changes = 0;
    for (int x = 1; image != nullptr && x < width; ++x) {
        changes += XGetPixel(image, x, 0) != XGetPixel(image, x - 1, 0);
    }
    if (image != nullptr) {
        XDestroyImage(image);
    }
    return changes;
}

} // namespace programs
