#include "nodes/output/windows/wall_sink.hpp"

#include "common/log/log.hpp"
#include "nodes/output/windows/wall_layout.hpp"

namespace mural {

WallSink::WallSink(WallWindowsConfig config, const TileGrid& grid)
    : WallSink(std::move(config), [grid](int width, int height) {
          return windowsOfTiles(grid, {0, 0, grid.columns, grid.rows}, width, height);
      }) {}

Result<void> WallSink::reopen(int width, int height) {
    config_.tiles = arrange_(width, height);
    config_.wall.wallWidth = width;
    config_.wall.wallHeight = height;
    windows_.reset(); // one set per process
    auto opened = WallWindows::open(config_);
    if (!opened) return opened.error();
    windows_ = std::move(*opened);
    width_ = width;
    height_ = height;
    return {};
}

Result<void> WallSink::openFor(const Picture& picture) {
    return windows_ && picture.width == width_ && picture.height == height_ ? Result<void>()
                                                                            : reopen(picture.width, picture.height);
}

Result<void> WallSink::showTiles(const Picture& picture, const Picture& right) {
    std::vector<OwnedPicture> pictures;
    std::vector<WallWindows::TilePicture> shown;
    pictures.reserve(2 * config_.tiles.size());
    const auto part = [&](const Picture& whole, const PixelViewport& tile) {
        return whole.empty() ? Picture{} : pictures.emplace_back(cutOut(whole, tile)).view();
    };
    for (size_t i = 0; i < config_.tiles.size(); ++i) {
        const PixelViewport& tile = config_.tiles[i].tile;
        if (!tile.empty()) shown.push_back({i, part(picture, tile), part(right, tile)});
    }
    return windows_->showAll(shown);
}

Result<void> WallSink::show(int64_t, const Picture& picture) {
    if (auto opened = openFor(picture); !opened) return opened;
    return showTiles(picture, {});
}

// Stereo support is queried once: it depends on the display only.
Result<void> WallSink::showPair(int64_t frame, const EyePair& eyes) {
    config_.stereo = whyNot_.empty();
    if (auto opened = openFor(eyes.left); !opened) return opened;
    if (windows_->stereo()) return showTiles(eyes.left, eyes.right);
    if (whyNot_.empty()) {
        whyNot_ = windows_->whyNotStereo();
        log::warning(log::Topic::Output,
                     "both eyes are shown side by side, because no window with a buffer for each eye can be opened (",
                     whyNot_, "); use a graphics card and display with quad-buffered stereo, or --stereo anaglyph");
    }
    return PictureSink::showPair(frame, eyes);
}

std::string WallSink::describe() const { return windows_ ? windows_->describe() : "windows of the wall"; }

} // namespace mural
