// Divides the items of a tile or chunk queue among the channels that take them. Tiles and chunks are two strategies of
// one mechanism: a grid of tiles, or one row of parts of the range (tile_queue.hpp).
#pragma once

#include <optional>

#include "balancer/equalizers/equalizer.hpp"
#include "balancer/equalizers/tile_queue.hpp"

namespace mural::balance {

class TileEqualizer : public Equalizer {
public:
    // queue: an output queue of the compound.
    TileEqualizer(std::string id, const ResolvedConfig& config, Index compound, const config::ResolvedQueue& queue);

    void observe(const FrameStatistics& statistics) override;

    // Tiles of each taker, in the order of the compounds; empty before the first frame.
    [[nodiscard]] const std::vector<TileRegion>& regions() const;
    [[nodiscard]] const std::vector<Index>& takers() const { return takers_; }
    [[nodiscard]] std::vector<Index> targets(const ResolvedConfig&) const override { return takers_; }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }

protected:
    void decide(const FrameContext& context, States& states) override;

private:
    [[nodiscard]] bool isChunks() const { return !size_.pixels; }
    [[nodiscard]] Viewport edgesOf(const TileRegion& region) const;
    [[nodiscard]] std::optional<TileRegion> regionOf(size_t taker) const;
    void layOut();
    void chooseGrid();
    void apply(States& states);

    const config::PixelsOrRange size_;
    std::vector<Index> takers_;
    std::vector<size_t> working_; // takers whose nodes live, in ascending order; each has a region
    int columns_ = 0, rows_ = 0;
    int width_ = 0, height_ = 0; // of a tile in pixels
    PixelViewport area_;
    std::optional<queue::TileQueue> queue_;
    std::vector<double> times_; // per entry of working_
};

} // namespace mural::balance
