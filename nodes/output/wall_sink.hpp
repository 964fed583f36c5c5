// Whole pictures in the windows of a wall, where no node has a whole tile to show: frames of several passes.
#pragma once

#include <memory>

#include "common/tile_grid.hpp"
#include "nodes/output/picture_sink.hpp"
#include "nodes/output/wall_windows.hpp"

namespace mural {

class WallSink : public PictureSink {
public:
    // config: without tiles; they come with the first picture's size.
    WallSink(WallWindowsConfig config, const TileGrid& grid)
        : config_(std::move(config))
        , grid_(grid) {}

    Result<void> show(int64_t frame, const Picture& picture) override;
    Result<void> finish() override { return {}; }
    [[nodiscard]] std::string describe() const override;

private:
    Result<void> reopen(int width, int height);

    WallWindowsConfig config_;
    const TileGrid grid_;
    std::unique_ptr<WallWindows> windows_;
    int width_ = 0, height_ = 0;
};

} // namespace mural
