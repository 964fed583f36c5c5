// Options of `mural run` for the tiles of the wall, its size and its place.
#include <fmt/format.h>
#include <tuple>

#include "nodes/launch/private_display.hpp"
#include "tools/mural/run/option_values.hpp"
#include "tools/mural/run/run_option_readers.hpp"

namespace mural::cli {

namespace {

constexpr int kMaxTilesPerSide = 256;

} // namespace

Result<void> readSizes(const RunArguments& a, SessionConfig& c) {
    if (a.tiles) {
        const auto tiles = pairOf(*a.tiles, 'x', 1, kMaxTilesPerSide);
        if (!tiles)
            return badValue("--tiles", *a.tiles,
                            fmt::format("must be COLUMNSxROWS, each from 1 to {}, such as 2x2", kMaxTilesPerSide));
        std::tie(c.columns, c.rows) = *tiles;
    }
    if (a.tileQueue) {
        const auto tile = pairOf(*a.tileQueue, 'x', 1, launch::kMaxScreenSize);
        if (!tile)
            return badValue("--tile-queue", *a.tileQueue,
                            fmt::format("must be WIDTHxHEIGHT of a tile in pixels, each from 1 to {}, such as 64x64",
                                        launch::kMaxScreenSize));
        if (a.tiles) return Error{"--tiles and --tile-queue both set the tiles; omit one of them"};
        std::tie(c.tileWidth, c.tileHeight) = *tile;
    }
    if (a.size) {
        const auto size = pairOf(*a.size, 'x', 1, launch::kMaxScreenSize);
        if (!size)
            return badValue("--size", *a.size,
                            fmt::format("must be WIDTHxHEIGHT in pixels, each from 1 to {}, such as 7680x4320",
                                        launch::kMaxScreenSize));
        std::tie(c.width, c.height) = *size;
    }
    if (a.position) {
        const auto position = pairOf(*a.position, ',', -launch::kMaxScreenSize, launch::kMaxScreenSize);
        if (!position) return badValue("--position", *a.position, "must be X,Y in pixels, such as 0,0");
        std::tie(c.windowX, c.windowY) = *position;
    }
    if (a.overlay) {
        const auto mode = overlayModeOf(*a.overlay);
        if (!mode) return badValue("--overlay", *a.overlay, fmt::format("must be {}", kOverlayModeNames));
        c.overlay = *mode;
    }
    if (a.windowInput) {
        const auto permission = input::inputPermissionOf(*a.windowInput);
        if (!permission)
            return badValue("--window-input", *a.windowInput, fmt::format("must be {}", input::kInputPermissionNames));
        c.windowInput = *permission;
    }
    return {};
}

} // namespace mural::cli
