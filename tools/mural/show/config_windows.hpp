// The windows of a remote wall as a configuration file describes them.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/geometry/viewport.hpp"
#include "nodes/output/windows/wall_windows.hpp"

namespace mural::cli {

struct ConfigWindow {
    std::string name; // of the channel
    Viewport part;    // of the canvas
    int x = 0, y = 0; // upper left corner on the screen
};

struct ConfigWall {
    int width = 0, height = 0; // of the first canvas, in pixels
    bool isFullScreen = false; // of any window
    std::vector<ConfigWindow> windows;
};

// Reads the first canvas of the file. Errors: the file cannot be used, or no segment has a channel of known size.
Result<ConfigWall> configWindows(const std::string& file);
// Returns the windows for a picture of this size, which covers the canvas.
[[nodiscard]] std::vector<TileWindow> windowsFor(const ConfigWall& wall, int width, int height);

} // namespace mural::cli
