#include "nodes/render/windows/tile_windows.hpp"

#include "common/base/clock.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/output/windows/wall_layout.hpp"

namespace mural {

Result<std::unique_ptr<TileWindows>> TileWindows::open(const NodeSetup& setup, OnInput onInput) {
    // the windows open with the first picture, whose size they need
    return std::unique_ptr<TileWindows>(new TileWindows(setup, std::move(onInput)));
}

// Returns the window of the node's area, or the windows of its tiles.
std::vector<TileWindow> TileWindows::windowsFor(int width, int height) const {
    if (setup_.hasArea) {
        const PixelViewport whole{0, 0, width, height};
        const PixelViewport tile = intersect(apply(whole, setup_.area), whole);
        std::vector<TileWindow> windows = placeTiles(std::span(&tile, 1), height);
        windows[0].title = setup_.windowTitle;
        if (!setup_.windowAsOnWall) windows[0].screenX = windows[0].screenY = 0;
        return windows;
    }
    const TileGrid grid{setup_.columns, setup_.rows, setup_.tiling == Tiling::Lean ? 2 : 1};
    return windowsOfTiles(grid, {setup_.regionColumn, setup_.regionRow, setup_.regionColumns, setup_.regionRows}, width,
                          height);
}

Result<void> TileWindows::reopen(int width, int height) {
    WallWindowsConfig config;
    config.displayName = setup_.displayName;
    config.tiles = windowsFor(width, height);
    tiles_.clear();
    for (const TileWindow& window : config.tiles) tiles_.push_back(window.tile);
    config.positionX = setup_.windowX;
    config.positionY = setup_.windowY;
    config.fullScreen = setup_.fullScreen;
    config.overlay = overlay_->overlay();
    config.onInput = onInput_;
    config.wall.wallWidth = width;
    config.wall.wallHeight = height;
    config.wall.wallWidthMm = setup_.wallWidthMm;
    config.wall.wallHeightMm = setup_.wallHeightMm;
    windows_.reset(); // one set per process
    auto opened = WallWindows::open(config);
    if (!opened) return opened.error();
    windows_ = std::move(*opened);
    width_ = width;
    height_ = height;
    return {};
}

int64_t TileWindows::awaitBarrier(SwapBarrier& barrier, const SwapKey& key) {
    const SpanScope waits(SpanKind::WaitBarrier);
    return barrier.await(key);
}

Result<void> TileWindows::show(const PlayerOutputs::Frame& f, SwapBarrier* barrier) {
    const SpanScope presents(SpanKind::Present);
    const bool other = !setup_.pass.shown.none(); // the canvas has its own resolution
    const int width = other ? f.picture.w : static_cast<int>(f.config.width),
              height = other ? f.picture.h : static_cast<int>(f.config.height);
    const uint64_t native = uint64_t{f.config.nativeHigh} << 32 | f.config.nativeLow;
    if (mainWindow_.swapped(f.client, f.window, f.config.width, f.config.height, native) == 0) return {};
    if (!windows_ || width != width_ || height != height_) {
        const auto opened = reopen(width, height);
        if (!opened) return opened;
    }
    auto next = std::make_shared<ShownTiles>();
    std::vector<OwnedPicture>& pictures = next->pictures;
    pictures.resize(tiles_.size());
    std::vector<WallWindows::TilePicture> shown;
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const PixelViewport& tile = tiles_[i];
        if (tile.empty()) continue;
        pictures[i].assign({tile.w, tile.h, f.pixels(tile)});
        shown.push_back({i, pictures[i].view()});
    }
    auto presentedNs = present(shown, {f.client, f.window, f.frame}, barrier);
    if (!presentedNs) return presentedNs.error();
    next->client = f.client;
    next->window = f.window;
    next->frame = f.frame;
    next->shownNs = *presentedNs;
    next->width = width;
    next->height = height;
    next->tiles = tiles_;
    shown_ = std::move(next);
    return {};
}

// Returns the time at which the server had the pictures.
Result<int64_t> TileWindows::present(std::span<const WallWindows::TilePicture> pictures, const SwapKey& key,
                                     SwapBarrier* barrier) {
    if (!barrier) {
        if (const auto done = windows_->showAll(pictures); !done) return done.error();
        return monotonicNowNs();
    }
    if (const auto drawn = windows_->drawAll(pictures); !drawn) return drawn.error();
    auto presentedNs = windows_->present(awaitBarrier(*barrier, key));
    if (presentedNs) barrier->shown(key, *presentedNs);
    return presentedNs;
}

} // namespace mural
