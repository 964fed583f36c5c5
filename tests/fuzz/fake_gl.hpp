// A platform without GL: its functions do nothing but what callers rely on (names are made, answers
// are written) and read as many bytes behind their pointers as GL would, so that a sanitizer sees a
// length that was not checked. Called without a current context they end the process.
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "nodes/gl/gl_platform.hpp"

namespace mural::fuzz {

struct FakeGlOptions {
    gl::ColorBuffers colorBuffers = gl::ColorBuffers::FrontAndBack;
    bool surfacesFail = false;
    int largestTexture = 0;    // in pixels; beyond, there is no memory. 0: any
    bool talks = false;        // each glDrawArrays sends a message of performance to the debug callback
    unsigned resetStatus = 0;  // what contexts that tell resets say
    std::function<void(bool scissored, const std::array<int, 4>& box)> drew = {}; // each glClear and glRectf; may be empty
    std::function<void(unsigned name)> namedBuffer = {}; // each name that glDrawBuffer, glDrawBuffers and glReadBuffer are given; may be empty
};
// One at a time per process.
std::unique_ptr<gl::Platform> makeFakePlatform(const FakeGlOptions& options);

} // namespace mural::fuzz
