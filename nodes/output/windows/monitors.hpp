// The monitors of an X display, for `mural doctor`.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural {

struct MonitorFacts {
    std::string name;
    int x = 0, y = 0, width = 0, height = 0; // pixels
    int widthMm = 0, heightMm = 0;           // 0: unknown
};

struct ScreenFacts {
    int width = 0, height = 0;          // pixels, of the whole X screen
    std::vector<MonitorFacts> monitors; // in reading order, as --fullscreen numbers them
};

// Errors: the display cannot be opened. Requires a process without other uses of GLFW; connecting has no time limit.
Result<ScreenFacts> readScreen(const std::string& display);

} // namespace mural
