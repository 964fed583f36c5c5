// A GL platform without GL. Its functions do only the work on which callers rely: they make names and write replies.
// They read as many bytes from their pointers as GL would, so that a sanitizer detects an unchecked length. A call
// without a current context ends the process.
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "nodes/gl/gl_platform.hpp"

namespace mural::fuzz {

struct FakeGlOptions {
    gl::ColorBuffers colorBuffers = gl::ColorBuffers::FrontAndBack;
    bool surfacesFail = false;
    int largestTexture = 0;   // size in pixels above which memory is exhausted; 0: none
    bool talks = false;       // each glDrawArrays sends a performance message to the debug callback
    unsigned resetStatus = 0; // status that contexts with reset notification report
    // called for each glClear and glRectf; may be empty
    std::function<void(bool scissored, const std::array<int, 4>& box)> drew = {};
    // called for each name passed to glDrawBuffer, glDrawBuffers and glReadBuffer; may be empty
    std::function<void(unsigned name)> namedBuffer = {};
};
// Creates the platform; at most one exists per process.
std::unique_ptr<gl::Platform> makeFakePlatform(const FakeGlOptions& options);

} // namespace mural::fuzz
