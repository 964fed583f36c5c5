// Configurations for common cases, from the options --tiles, --nodes, --db, --stereo, --pixel, --subpixel, --dplex and
// --zoom. They nest in this order: tiles, frames (time-multiplex), ranges, pixel kernels, samples. Tile queues divide
// the rest.
#pragma once

#include "balancer/config/config.hpp"
#include "common/base/result.hpp"

namespace mural::config {

enum class StereoPreset : uint8_t {
    None,
    Anaglyph,   // both eyes in one picture, by colour
    Quad,       // both eyes in one window with stereo buffers
    Passive,    // one window per eye
    SideBySide, // left eye in the left half of each window, right eye in the right half
};

enum class SplitPreset : uint8_t {
    Fixed, // equal parts
    Load,  // divided by a load equalizer
    Tree,  // divided by a tree equalizer
};

struct Preset {
    int32_t columns = 1; // tiles
    int32_t rows = 1;
    std::vector<std::string> nodes;          // host names; an empty name, or none at all: this machine
    int32_t ranges = 1;                      // --db
    std::string composition;                 // --composition of the ranges; empty: not stated
    int32_t chunks = 0;                      // --chunk-queue; 0: static ranges
    SplitPreset split = SplitPreset::Fixed;  // --balance: of ranges, and of areas among several channels
    int32_t pixelColumns = 1, pixelRows = 1; // --pixel
    int32_t samples = 1;                     // --subpixel
    int32_t frames = 1;                      // --dplex
    Zoom zoom;                               // --zoom
    int32_t tileWidth = 0;                   // --tile-queue, in pixels; 0: none
    int32_t tileHeight = 0;
    int32_t takers = 1; // channels that share each part of the picture, by tiles or by a split
    StereoPreset stereo = StereoPreset::None;
    int32_t width = 1920; // of the whole picture, in pixels
    int32_t height = 1080;
};

Result<ConfigFile> shortForm(const Preset& form);

} // namespace mural::config
