// Shows whole pictures in wall windows, for sessions in which several passes compose each tile.
#pragma once

#include <memory>
#include <string>

#include "common/geometry/tile_grid.hpp"
#include "nodes/output/picture_sink.hpp"
#include "nodes/output/windows/wall_windows.hpp"

namespace mural {

class WallSink : public PictureSink {
public:
    // config: without tiles, which follow from the first picture's size.
    WallSink(WallWindowsConfig config, const TileGrid& grid) : config_(std::move(config)), grid_(grid) {}

    Result<void> show(int64_t frame, const Picture& picture) override;
    Result<void> showPair(int64_t frame, const EyePair& eyes) override;
    Result<void> finish() override { return {}; }
    [[nodiscard]] std::string describe() const override;

private:
    Result<void> reopen(int width, int height);
    Result<void> openFor(const Picture& picture);
    Result<void> showTiles(const Picture& picture, const Picture& right);

    WallWindowsConfig config_;
    const TileGrid grid_;
    std::string whyNot_; // reason for no buffer per eye; "": windows have one, or it is unknown yet
    std::unique_ptr<WallWindows> windows_;
    int width_ = 0, height_ = 0;
};

} // namespace mural
