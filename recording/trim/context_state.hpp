// What of a context's state decides what its draws and clears do to its window. Pure.
#pragma once

#include <cstdint>
#include <string>

#include "recording/record_walk.hpp"

namespace mural::recording {

// Planes of a window, as glClear names them.
constexpr uint32_t kColorPlane = 0x4000, kDepthPlane = 0x100, kStencilPlane = 0x400;
constexpr uint32_t kAllPlanes = kColorPlane | kDepthPlane | kStencilPlane;

// What a program has done anywhere that makes its pictures depend on more than the draws since the last clear.
struct Doubts {
    std::string why; // the first of them; empty: none
    bool listsChangeState = false; // of what is below: by glCallList
    uint32_t writtenPlanes = kColorPlane; // depth and stencil: once there was a test
    void doubt(const char* reason) {
        if (why.empty()) why = reason;
    }
};

class ContextState {
public:
    void record(const RecordView& r, Doubts& doubts);

    // Draws change the window, and nothing else.
    [[nodiscard]] bool drawsIntoWindow() const { return drawFramebuffer_ == 0 && !compiling_ && queries_ == 0 && !feedback_; }
    [[nodiscard]] bool readsWindow() const { return readFramebuffer_ == 0 || compiling_; }
    [[nodiscard]] bool compiling() const { return compiling_; }
    // Of the planes of glClear: those that it sets all of.
    [[nodiscard]] uint32_t clears(uint32_t mask) const;

private:
    void enable(uint32_t what, bool on, Doubts& doubts);
    void changes(Doubts& doubts); // a part of the state is not what contexts begin with
    void framebuffer(uint32_t target, uint32_t name);
    void buffers(const RecordView& r, Doubts& doubts);

    uint32_t drawFramebuffer_ = 0, readFramebuffer_ = 0;
    int queries_ = 0;
    bool feedback_ = false; // transform feedback
    bool compiling_ = false;
    bool conditional_ = false;
    bool scissor_ = false, discard_ = false;
    bool colorMasked_ = false, depthMasked_ = false, stencilMasked_ = false;
    bool everChanged_ = false;
    bool unknown_ = false; // what the state is now, nobody here knows
};

} // namespace mural::recording
