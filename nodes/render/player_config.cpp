#include "nodes/render/player_config.hpp"

#include <cstdlib>
#include <vector>

#include "nodes/affinity/placement.hpp"
#include "nodes/gl/software_renderer.hpp"
#include "nodes/player/readback_choice.hpp"

namespace mural {

namespace {

std::vector<Viewport> areasOf(const std::vector<double>& numbers) {
    std::vector<Viewport> areas;
    for (size_t i = 0; i + 4 <= numbers.size(); i += 4)
        areas.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
    return areas;
}

} // namespace

PlayerConfig playerConfigOf(const NodeSetup& setup, const std::string& renderer) {
    PlayerConfig config;
    config.node = setup.node;
    config.skips = setup.isResyncing && setup.skipsFrames;
    config.isResyncing = setup.isResyncing;
    config.lean = setup.tiling == Tiling::Lean;
    config.cull = setup.tiling == Tiling::Culled;
    config.culling = setup.culling;
    config.rastersInBins = gl::drawsWithoutGpu(renderer);
    config.grid = {setup.columns, setup.rows, config.lean ? 2 : 1};
    config.region = {setup.regionColumn, setup.regionRow, setup.regionColumns, setup.regionRows};
    if (setup.hasArea) config.area = setup.area;
    if (!setup.areas.empty()) config.areas.emplace(ViewportAssignment{0, areasOf(setup.areas), {}});
    config.anyMovesZoom = setup.anyMovesZoom;
    config.movesZoom = setup.movesZoom;
    config.pass = setup.pass;
    for (size_t i = 0; i + 2 <= setup.ranges.size(); i += 2)
        config.ranges.push_back({setup.ranges[i], setup.ranges[i + 1]});
    config.readback = setup.sendPictures ? readbackBy(renderer, setup.readback) : Readback::Direct;
    config.deepPictures = setup.deepPictures;
    config.answers = setup.answers;
    config.screen = setup.screen;
    config.eyeBase = setup.eyeBase;
    config.focusDistance = setup.focusDistance;
    if (const char* const plant = std::getenv("MURAL_PLANT")) config.plant = plant;
    return config;
}

std::string placeReplay(const NodeSetup& setup, const std::string& renderer) {
    if (!setup.placeThreads) return "not placed: --no-placement";
    if (gl::drawsWithoutGpu(renderer)) return "not placed: no GPU draws";
    return placeThread(DeviceKind::Gpu).description;
}

} // namespace mural
