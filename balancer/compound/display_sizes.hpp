// Pixel sizes of pipes, windows and channels. A pipe without a size in the file has the size of its machine's screen.
#pragma once

#include "balancer/config/resolved_config.hpp"

namespace mural::compound {

using config::at;
using config::Index;
using config::kNone;
using config::ResolvedConfig;

struct DisplaySizes {
    std::vector<PixelViewport> pipes;
    std::vector<PixelViewport> windows;  // relative to the pipe's screen
    std::vector<PixelViewport> channels; // relative to the window
};

struct PixelSize {
    int32_t w = 1920;
    int32_t h = 1080;
};

// Returns all sizes. `machineSizes` holds the screen size of each pipe as far as known; pipes without one have the size
// `otherwise`.
DisplaySizes displaySizes(const ResolvedConfig& config, const std::vector<PixelSize>& machineSizes = {},
                          PixelSize otherwise = {});

// Applies a new window size, chosen by the user, to the window and its channels.
void resizeWindow(const ResolvedConfig& config, Index window, PixelSize size, DisplaySizes& sizes);

} // namespace mural::compound
