// What the nodes draw is not drawn in the program's own context: a window's own back buffer stays as it is
// from the moment that it is bound. When it has changed, somebody draws into it past us. Looked at at the
// end of the frames 1, 2, 4, 8, … of a window, by a sample of its pixels.
//
// Nothing but drawing past us may count. So a change means nothing after a window was bound anew or has
// another size (drivers take other memory then) and after we have drawn there ourselves; and only Mesa is
// looked at: its buffers belong to the window alone, and several libraries share its dispatch.
#pragma once

#include <atomic>
#include <cstdint>

namespace mural {

struct ThreadState;
struct Window;

// A window's pixels when they were last looked at; part of Window.
struct LocalPixels {
    std::atomic<bool> known{false};
    std::atomic<bool> busy{false}; // a thread is looking
    uint32_t width = 0, height = 0;
    uint64_t print = 0;
    uint64_t drawings = 0; // of our own that there had been
    uint32_t frames = 0;   // that the window has shown
    int binds = 0;         // since the last of them
};

// The window was made current, and was not before.
void localPixelsBound(ThreadState& t, Window& w);
// Before a picture of the window goes out. True: somebody else has drawn into it.
bool localPixelsChanged(ThreadState& t, Window& w);

// Around everything that we let the program's own contexts draw while the nodes draw the pictures.
void ownDrawingBegins();
void ownDrawingEnds();

} // namespace mural
