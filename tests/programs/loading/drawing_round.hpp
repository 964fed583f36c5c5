// One load of a GL library in a process. The program opens the library by name, draws some frames in a new window on a
// new display connection, prints checksums of the pixels, and closes all of it.
#pragma once

#include <X11/Xlib.h>
#include <string>

namespace programs {

enum class WindowSystem { Glx, Egl };

struct Round {
    WindowSystem system = WindowSystem::Glx;
    int number = 0; // selects the colours and the size
    int frames = 3;
    std::string display; // display name; not from the environment, which may be empty
};

// Draws, and prints a line for each frame and one for the window's contents on the X server.
void drawRound(const Round& round);

} // namespace programs
