#include "nodes/node/tile_windows.hpp"

#include <cstring>

namespace mural {

Result<std::unique_ptr<TileWindows>> TileWindows::open(const NodeSetup& setup) {
    return std::unique_ptr<TileWindows>(new TileWindows(setup)); // the windows come with the first picture's size
}

Result<void> TileWindows::reopen(int width, int height) {
    const TileGrid grid{setup_.columns, setup_.rows, setup_.tiling == Tiling::Lean ? 2 : 1};
    tiles_.clear();
    std::vector<int> numbers;
    for (int row = setup_.regionRow; row < setup_.regionRow + setup_.regionRows; ++row) {
        for (int column = setup_.regionColumn; column < setup_.regionColumn + setup_.regionColumns; ++column) {
            tiles_.push_back(tileViewport(grid, column, row, width, height));
            numbers.push_back((setup_.rows - 1 - row) * setup_.columns + column); // reading order
        }
    }
    WallWindowsConfig config;
    config.displayName = setup_.displayName;
    config.tiles = placeTiles(tiles_, height);
    for (size_t i = 0; i < config.tiles.size(); ++i) {
        config.tiles[i].title = "Mural tile " + std::to_string(numbers[i]);
        config.tiles[i].monitor = numbers[i];
    }
    config.positionX = setup_.windowX;
    config.positionY = setup_.windowY;
    config.fullScreen = setup_.fullScreen;
    windows_.reset(); // one set per process
    auto opened = WallWindows::open(config);
    if (!opened) return opened.error();
    windows_ = std::move(*opened);
    width_ = width;
    height_ = height;
    return {};
}

Result<void> TileWindows::show(const ReplayOutputs::Frame& f) {
    const auto width = static_cast<int>(f.config.width), height = static_cast<int>(f.config.height);
    if (mainWindow_.swapped(f.client, f.window, f.config.width, f.config.height) == 0) return {};
    if (!windows_ || width != width_ || height != height_) {
        const auto opened = reopen(width, height);
        if (!opened) return opened;
    }
    std::vector<OwnedPicture> pictures(tiles_.size());
    std::vector<WallWindows::TilePicture> shown;
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const PixelViewport& tile = tiles_[i];
        if (tile.empty()) continue;
        pictures[i].assign({tile.w, tile.h, f.pixels(tile)});
        shown.push_back({i, pictures[i].view()});
    }
    return windows_->showAll(shown);
}

} // namespace mural
