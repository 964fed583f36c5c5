#include "nodes/session/render_pass.hpp"

#include <cstdio>

#include "common/geometry/jitter.hpp"

namespace mural {

std::vector<Eye> eyesOf(StereoMode mode) {
    switch (mode) {
    case StereoMode::Off: return {Eye::Cyclop};
    case StereoMode::Left: return {Eye::Left};
    case StereoMode::Right: return {Eye::Right};
    default: return {Eye::Left, Eye::Right};
    }
}

std::vector<RenderPass> passesOf(const PassCounts& counts) {
    std::vector<RenderPass> passes;
    RenderPass p;
    p.kernelWidth = counts.kernelWidth;
    p.kernelHeight = counts.kernelHeight;
    p.samples = counts.samples;
    p.period = counts.period;
    p.ranges = counts.ranges;
    p.zoom = counts.zoom;
    for (const Eye eye : eyesOf(counts.stereo)) {
        p.eye = eye;
        for (p.kernelY = 0; p.kernelY < counts.kernelHeight; ++p.kernelY)
            for (p.kernelX = 0; p.kernelX < counts.kernelWidth; ++p.kernelX)
                for (p.sample = 0; p.sample < counts.samples; ++p.sample)
                    for (p.phase = 0; p.phase < counts.period; ++p.phase) passes.push_back(p);
    }
    return passes;
}

int pictureOf(const PassCounts& counts, const RenderPass& pass) {
    const int eye = pass.eye == Eye::Right && eyesOf(counts.stereo).size() > 1 ? 1 : 0;
    return ((eye * counts.kernelHeight + pass.kernelY) * counts.kernelWidth + pass.kernelX) * counts.samples +
           pass.sample;
}

int picturesOf(const PassCounts& counts) {
    return static_cast<int>(eyesOf(counts.stereo).size()) * counts.kernelHeight * counts.kernelWidth * counts.samples;
}

std::array<double, 2> jitterOf(int sample, int samples) {
    const Jitter jitter = jitterOf(SubPixel{sample, samples});
    return {jitter.x, jitter.y};
}

std::string describe(const RenderPass& pass) {
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (pass.eye != Eye::Cyclop) add(pass.eye == Eye::Left ? "left eye" : "right eye");
    if (pass.kernelWidth * pass.kernelHeight > 1)
        add("pixel " + std::to_string(pass.kernelX) + "," + std::to_string(pass.kernelY) + " of each " +
            std::to_string(pass.kernelWidth) + "x" + std::to_string(pass.kernelHeight));
    if (pass.samples > 1) add("sample " + std::to_string(pass.sample + 1) + " of " + std::to_string(pass.samples));
    if (pass.period > 1)
        add("frames " + std::to_string(pass.phase) + ", " + std::to_string(pass.phase + pass.period) + ", …");
    if (pass.zoom != pass.shown) { // drawing at the canvas's own resolution is no zoom
        char zoom[48];
        std::snprintf(zoom, sizeof zoom, "zoom %.4g %.4g", pass.zoom.x / pass.shown.x, pass.zoom.y / pass.shown.y);
        add(zoom);
    }
    if (pass.ranges > 1) add("range " + std::to_string(pass.range + 1) + " of " + std::to_string(pass.ranges));
    return text;
}

} // namespace mural
