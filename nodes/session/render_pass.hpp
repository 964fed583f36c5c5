// The pass of a picture: an eye, a kernel pixel, a sample, a phase, a range. A session with any of these draws every
// frame in several passes on separate nodes; the head combines the pictures. Source: thesis, "Scalable Rendering"
// (stereo, pixel, subpixel and time-multiplex compounds).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/geometry/eye.hpp"
#include "common/geometry/range.hpp"
#include "common/geometry/zoom.hpp"

namespace mural {

enum class StereoMode {
    Off,
    Anaglyph,   // left eye in red, right eye in green and blue
    SideBySide, // eyes side by side at half width
    TopBottom,  // left above right at half height
    Left,       // one eye only, for two sessions or for inspection
    Right,
    Quad // both eyes at full size: quad-buffered windows
};

struct RenderPass {
    Eye eye = Eye::Cyclop;
    int kernelX = 0, kernelY = 0;          // the pixel within the kernel
    int kernelWidth = 1, kernelHeight = 1; // size of the kernel; row 0 is the lowest
    int sample = 0, samples = 1;           // index and number of the averaged samples
    int phase = 0, period = 1;             // draws frames n with n mod period == phase
    int range = 0, ranges = 1;             // index and number of the ranges of a frame's draws (sort-last)
    Range share;                           // this node's part of the draws
    Zoom zoom;                             // drawn at this scale and resized before it is shown; at most kMaxZoom

    Zoom shown; // scale of another canvas relative to the program's picture

    bool operator==(const RenderPass&) const = default;
};

// The number of eyes, kernel pixels, samples, phases and ranges; all 1: a session without passes.
struct PassCounts {
    StereoMode stereo = StereoMode::Off;
    int kernelWidth = 1, kernelHeight = 1;
    int samples = 1;
    int period = 1;
    int ranges = 1;
    Zoom zoom; // of all passes
};

[[nodiscard]] std::vector<Eye> eyesOf(StereoMode mode);

// All passes, ordered by eye, kernel row, kernel column, sample and phase. One node per range draws each pass; together
// they draw one picture.
[[nodiscard]] std::vector<RenderPass> passesOf(const PassCounts& counts);

// The index of the pass's picture in that order. Passes that differ only in their phase share a picture.
[[nodiscard]] int pictureOf(const PassCounts& counts, const RenderPass& pass);
[[nodiscard]] int picturesOf(const PassCounts& counts);

// The position of sample i of n in its pixel, each coordinate in (-1/2, 1/2), with (0, 0) the centre. Each of n columns
// and n rows contains one sample; rows follow a Hammersley set. The mean is the centre, so no picture shifts.
[[nodiscard]] std::array<double, 2> jitterOf(int sample, int samples);

// A short text for --explain: "left eye", "sample 2 of 4"; "" for the plain picture.
[[nodiscard]] std::string describe(const RenderPass& pass);

} // namespace mural
