// Pixels of everything that a picture is drawn into. Pipes that the file gives no size have the machine's.
#pragma once

#include "balancer/config/resolved_config.hpp"

namespace mural::compound {

using config::at;
using config::Index;
using config::kNone;
using config::ResolvedConfig;

struct DisplaySizes {
    std::vector<PixelViewport> pipes;
    std::vector<PixelViewport> windows;  // on their pipe's screen
    std::vector<PixelViewport> channels; // in their window
};

struct PixelSize {
    int32_t w = 1920;
    int32_t h = 1080;
};

// machineSizes: of each pipe, as far as known; others have `otherwise`.
DisplaySizes displaySizes(const ResolvedConfig& config, const std::vector<PixelSize>& machineSizes = {}, PixelSize otherwise = {});

// The user has given a window another size: its channels follow.
void resizeWindow(const ResolvedConfig& config, Index window, PixelSize size, DisplaySizes& sizes);

} // namespace mural::compound
