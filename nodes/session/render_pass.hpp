// What a picture is drawn for beside its place on the wall: an eye, a pixel of a kernel, a sample of a
// pixel, a turn in time, a range of what is drawn. A session that decomposes by any of them draws every frame in several passes, each by
// nodes of its own; the head puts the passes' pictures together.
// Source: thesis, "Scalable Rendering" (stereo, pixel, subpixel and time-multiplex compounds).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/eye.hpp"
#include "common/range.hpp"
#include "common/zoom.hpp"

namespace mural {

enum class StereoMode {
    Off,
    Anaglyph,   // left in red, right in green and blue
    SideBySide, // left half and right half, each the whole picture at half its width
    TopBottom,  // left above right, each at half its height
    Left,       // one eye alone: for two sessions, or to look at it
    Right,
    Quad // each whole: windows with a buffer for each eye
};

struct RenderPass {
    Eye eye = Eye::Cyclop;
    int kernelX = 0, kernelY = 0; // which pixel of a kernel…
    int kernelWidth = 1, kernelHeight = 1; // …of so many columns and rows; row 0 is the lowest
    int sample = 0, samples = 1;  // which of the jittered pictures that are averaged
    int phase = 0, period = 1;    // draws the frames n with n mod period == phase
    int range = 0, ranges = 1;    // which of the nodes that share a frame's draws in their order (sort-last)…
    Range share;                  // …and which part of them it draws
    Zoom zoom;                    // drawn smaller or larger by this, and as large as it is shown before anybody sees it; at most kMostZoom

    Zoom shown;                   // its pictures are larger or smaller than the program's by this: those of another canvas

    bool operator==(const RenderPass&) const = default;
};

// How many of each; 1 of everything is a session without passes.
struct PassCounts {
    StereoMode stereo = StereoMode::Off;
    int kernelWidth = 1, kernelHeight = 1;
    int samples = 1;
    int period = 1;
    int ranges = 1;
    Zoom zoom; // of all
};

[[nodiscard]] std::vector<Eye> eyesOf(StereoMode mode);

// All passes: by eye, then by row and column of the kernel, then by sample, then by phase. Each stands for as many nodes
// as there are ranges: they draw one picture together.
[[nodiscard]] std::vector<RenderPass> passesOf(const PassCounts& counts);

// Passes that differ in their phase alone make one picture: its index in that order.
[[nodiscard]] int pictureOf(const PassCounts& counts, const RenderPass& pass);
[[nodiscard]] int picturesOf(const PassCounts& counts);

// Where sample i of n lies in its pixel, each coordinate in (-1/2, 1/2), (0, 0) being its centre: one sample in each of n
// columns and n rows, the rows in the order of a Hammersley set; their mean is the centre, so that no picture moves.
[[nodiscard]] std::array<double, 2> jitterOf(int sample, int samples);

// One word or two for --explain: "left eye", "sample 2 of 4", "" when it is the plain picture.
[[nodiscard]] std::string describe(const RenderPass& pass);

} // namespace mural
