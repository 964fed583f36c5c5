// Notes about GL calls that bypass the capture library. They go to `mural run` (MURAL_NOTES), which prints each line
// once for all processes. Without it they go to stderr.
#pragma once

namespace mural {

// Prints one line for the user.
void reportBypass(const char* format, ...) __attribute__((format(printf, 1, 2)));

} // namespace mural
