// Detects draws past the capture library. The program's own context does not draw what the nodes draw, so a window's
// local back buffer stays unchanged after it is bound. A change means that another path has drawn. Compares samples of
// its pixels at the end of frames 1, 2, 4, 8, … of a window.
//
// False positives are excluded. A change is ignored after a new binding or size, for which drivers may use other
// memory, and after our own draws. Only Mesa is checked: its buffers belong to one window, and several libraries share
// its dispatch.
#pragma once

#include <atomic>
#include <cstdint>

namespace mural {

struct ThreadState;
struct Window;

// The last sample of a window; part of Window.
struct BackBufferProbe {
    std::atomic<bool> known{false};
    std::atomic<bool> busy{false}; // a thread is sampling
    uint32_t width = 0, height = 0;
    uint64_t print = 0;
    uint64_t drawings = 0; // number of our own draws at the sample
    uint32_t frames = 0;   // frames that the window has shown
    int binds = 0;         // bindings since the last frame
};

// Call when the window becomes current.
void backBufferBound(ThreadState& t, Window& w);
// Call before a picture of the window is sent. Returns true if another path has drawn into it.
bool backBufferChanged(ThreadState& t, Window& w);

// Brackets draws of the program's own contexts that we allow while the nodes draw the pictures.
void ownDrawingBegins();
void ownDrawingEnds();

} // namespace mural
