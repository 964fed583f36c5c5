#include "nodes/output/wall_sink.hpp"

#include "nodes/output/wall_layout.hpp"

namespace mural {

Result<void> WallSink::reopen(int width, int height) {
    config_.tiles = windowsOfTiles(grid_, {0, 0, grid_.columns, grid_.rows}, width, height);
    windows_.reset(); // one set per process
    auto opened = WallWindows::open(config_);
    if (!opened) return opened.error();
    windows_ = std::move(*opened);
    width_ = width;
    height_ = height;
    return {};
}

Result<void> WallSink::show(int64_t, const Picture& picture) {
    if (!windows_ || picture.width != width_ || picture.height != height_) {
        if (auto opened = reopen(picture.width, picture.height); !opened) return opened;
    }
    std::vector<OwnedPicture> pictures;
    std::vector<WallWindows::TilePicture> shown;
    pictures.reserve(config_.tiles.size());
    for (size_t i = 0; i < config_.tiles.size(); ++i) {
        if (config_.tiles[i].tile.empty()) continue;
        pictures.push_back(cutOut(picture, config_.tiles[i].tile));
        shown.push_back({i, pictures.back().view()});
    }
    return windows_->showAll(shown);
}

std::string WallSink::describe() const { return windows_ ? windows_->describe() : "windows of the wall"; }

} // namespace mural
