// Configurations for the common cases, from a few numbers: what --tiles, --nodes, --db, --stereo, --pixel, --subpixel,
// --dplex and --zoom stand for. All of them may be given together: each tile of the wall is divided by frame numbers, in each of
// these by range, in each of these by pixels, in each of these by samples; what is
// left is taken tile by tile from a queue.
#pragma once

#include "balancer/config/config.hpp"
#include "common/result.hpp"

namespace mural::config {

enum class StereoForm : uint8_t {
    None,
    Anaglyph,   // both eyes in one picture, by colour
    Quad,       // both eyes in one window with stereo buffers
    Passive,    // a window for each eye
    SideBySide, // the left eye in the left half of each window, the right one in the right half
};

struct ShortForm {
    int32_t columns = 1; // of tiles
    int32_t rows = 1;
    std::vector<std::string> nodes; // hosts; none: all is drawn on this machine
    int32_t ranges = 1;             // --db
    std::string composition;        // --composition, of the ranges; empty: nothing is said
    int32_t chunks = 0;             // --chunk-queue, of the ranges; 0: each has its share
    int32_t pixels = 1;             // --pixel
    int32_t samples = 1;            // --subpixel
    int32_t frames = 1;             // --dplex
    Zoom zoom;                      // --zoom
    int32_t tileWidth = 0;          // --tile-queue: pixels; 0: none
    int32_t tileHeight = 0;
    int32_t takers = 1;             // channels that take such tiles, of each part of the picture
    StereoForm stereo = StereoForm::None;
    int32_t width = 1920; // of the whole picture, in pixels
    int32_t height = 1080;
};

Result<ConfigFile> shortForm(const ShortForm& form);

} // namespace mural::config
