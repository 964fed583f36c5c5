// One life of a GL library in a process: it is opened by name, draws some frames in a window of its own on a display of its
// own, says what it reads back, and is closed again. So nothing of it stays but what others keep.
#pragma once

#include <X11/Xlib.h>
#include <string>

namespace programs {

enum class WindowSystem { Glx, Egl };

struct Round {
    WindowSystem system = WindowSystem::Glx;
    int number = 0;          // chooses the colours and the size
    int frames = 3;
    std::string display;     // name; not from the environment, which may be empty
};

// Prints a line for each frame, and one for the window as the X server has it.
void drawRound(const Round& round);

} // namespace programs
