// Shows whole pictures in wall windows, for sessions in which several passes compose each tile.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/geometry/tile_grid.hpp"
#include "nodes/output/picture_sink.hpp"
#include "nodes/output/windows/wall_windows.hpp"

namespace mural {

class WallSink : public PictureSink {
public:
    // Returns the windows for a picture of this size.
    using Arrange = std::function<std::vector<TileWindow>(int width, int height)>;
    // config: without tiles, which follow from the first picture's size.
    WallSink(WallWindowsConfig config, Arrange arrange) : config_(std::move(config)), arrange_(std::move(arrange)) {}
    WallSink(WallWindowsConfig config, const TileGrid& grid);

    Result<void> show(int64_t frame, const Picture& picture) override;
    Result<void> showPair(int64_t frame, const EyePair& eyes) override;
    Result<void> finish() override { return {}; }
    [[nodiscard]] std::string describe() const override;
    // Returns whether the user has requested to close a window.
    [[nodiscard]] bool closeRequested() const { return windows_ && windows_->closeRequested(); }

private:
    Result<void> reopen(int width, int height);
    Result<void> openFor(const Picture& picture);
    Result<void> showTiles(const Picture& picture, const Picture& right);

    WallWindowsConfig config_;
    const Arrange arrange_;
    std::string whyNot_; // reason for no buffer per eye; "": windows have one, or it is unknown yet
    std::unique_ptr<WallWindows> windows_;
    int width_ = 0, height_ = 0;
};

} // namespace mural
