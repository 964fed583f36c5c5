// Parts common to all test programs: options, the frame loop, and errors that end the program. The programs use no
// clock and no random numbers, so two runs draw the same pictures. They print nothing on success.
#pragma once

#include <functional>
#include <memory>

#include "tests/programs/support/window.hpp"

namespace programs {

struct Options {
    int frames = 4;  // --frames N
    int width = 250; // --size WxH
    int height = 190;
};

Options parseOptions(int argc, char** argv);

// Prints one line with the program's name and ends the program with status 2.
[[noreturn]] __attribute__((format(printf, 1, 2))) void fail(const char* format, ...);

// Ends the program if glGetError reports an error; `where` names the place.
void checkNoError(const char* where);

using Setup = std::function<void(Window&)>;
using Draw = std::function<void(Window&, int frame)>;

// Calls `draw` once per frame, checks for GL errors, and swaps. END_FILE=PATH in the environment: once that file
// exists, its text is the number of further frames, limited by --frames.
void runFrames(Window& window, const Options& options, const Draw& draw);

// Runs the whole main() of a program with one window.
int runInGlxWindow(int argc, char** argv, const WindowSpec& spec, const Setup& setup, const Draw& draw);
int runInEglWindow(int argc, char** argv, const WindowSpec& spec, const Setup& setup, const Draw& draw);

} // namespace programs
