#include "nodes/head/planning/preset_plan.hpp"

#include <algorithm>

namespace mural {

namespace {

constexpr int kMaxDefaultNodes = 4; // without --nodes and --local-nodes

// Returns the number of channels that share each part of the picture. Tiles that do not move limit it.
int takersOf(const SessionConfig& config) {
    if (!movesWork(config)) return 1;
    const auto passes = static_cast<int>(passesOf(config.passes).size()) * config.passes.ranges;
    const int tiles = config.columns * config.rows;
    const bool isLimited = config.tileWidth == 0 && (tiles > 1 || config.passes.ranges > 1);
    const int requested = config.localNodes + static_cast<int>(config.hosts.size());
    const int unrequested = isLimited ? std::min(tiles, kMaxDefaultNodes) : kMaxDefaultNodes;
    const int takers = std::max(1, (requested > 0 ? requested : std::max(passes, unrequested)) / passes);
    return config.chunks > 0 && config.tileWidth == 0 ? std::min(takers, tiles) : takers;
}

Result<config::StereoPreset> stereoOf(StereoMode mode) {
    switch (mode) {
    case StereoMode::Off: return config::StereoPreset::None;
    case StereoMode::Anaglyph: return config::StereoPreset::Anaglyph;
    case StereoMode::SideBySide: return config::StereoPreset::SideBySide;
    case StereoMode::Quad: return config::StereoPreset::Quad;
    default: return Error{"--stereo: configurations have no such stereo mode; use anaglyph, side-by-side or quad"};
    }
}

} // namespace

bool movesWork(const SessionConfig& config) {
    return config.tileWidth > 0 || config.chunks > 0 ||
           (config.balance != balance::Balance::AsInFile && config.balance != balance::Balance::Off);
}

Result<config::Preset> presetOf(const SessionConfig& config) {
    config::Preset form;
    const bool moves = movesWork(config);
    if (!moves) form.columns = config.columns, form.rows = config.rows;
    if (config.localNodes > 0 && !config.hosts.empty()) form.nodes.resize(static_cast<size_t>(config.localNodes));
    std::ranges::copy(config.hosts, std::back_inserter(form.nodes));
    form.ranges = config.passes.ranges;
    if (config.composition != "auto") form.composition = config.composition;
    form.chunks = config.chunks;
    form.pixelColumns = config.passes.kernelWidth;
    form.pixelRows = config.passes.kernelHeight;
    form.samples = config.passes.samples;
    form.frames = config.passes.period;
    form.zoom = config.passes.zoom;
    form.tileWidth = config.tileWidth;
    form.tileHeight = config.tileHeight;
    form.takers = takersOf(config);
    if (moves && config.tileWidth == 0 && config.chunks == 0)
        form.split = config.balance == balance::Balance::Tree ? config::SplitPreset::Tree : config::SplitPreset::Load;
    auto stereo = stereoOf(config.passes.stereo);
    if (!stereo) return stereo.error();
    form.stereo = *stereo;
    if (config.width > 0) form.width = config.width;
    if (config.height > 0) form.height = config.height;
    return form;
}

} // namespace mural
