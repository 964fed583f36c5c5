// What every test program shares: its options, the frame loop and loud failure. The programs know no
// clock and no random numbers: two runs draw the same pictures. They print nothing on success.
#pragma once

#include <functional>
#include <memory>

#include "tests/programs/support/window.hpp"

namespace programs {

struct Options {
    int frames = 4;   // --frames N
    int width = 250;  // --size WxH
    int height = 190;
};

Options parseOptions(int argc, char** argv);

// Prints one line with the program's name and ends the program with status 2.
[[noreturn]] __attribute__((format(printf, 1, 2))) void fail(const char* format, ...);

// Fails when glGetError says anything; `where` names the place.
void checkNoError(const char* where);

using Setup = std::function<void(Window&)>;
using Draw = std::function<void(Window&, int frame)>;

// Calls `draw` once per frame, looks for GL errors, swaps. END_FILE=PATH in the environment: once that file is there, as many
// frames more as its text says, --frames at most.
void runFrames(Window& window, const Options& options, const Draw& draw);

// The whole main() of a program with one window.
int runInGlxWindow(int argc, char** argv, const WindowSpec& spec, const Setup& setup, const Draw& draw);
int runInEglWindow(int argc, char** argv, const WindowSpec& spec, const Setup& setup, const Draw& draw);

} // namespace programs
