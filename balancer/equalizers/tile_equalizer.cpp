#include "balancer/equalizers/tile_equalizer.hpp"

#include <cmath>

#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

namespace {

constexpr int kMostTiles = 65536;

void collectTakers(const ResolvedConfig& config, Index compound, const std::string& queue, std::vector<Index>& takers) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    if (std::any_of(c.inputQueues.begin(), c.inputQueues.end(), [&](const auto& q) { return q.name == queue; }))
        takers.push_back(compound);
    for (const Index child : c.children) collectTakers(config, child, queue, takers);
}

// Returns one area per taker: the grid is halved along its longer side.
void divide(const TileRegion& grid, size_t takers, std::vector<TileRegion>& areas) {
    if (takers == 1) {
        areas.push_back(grid);
        return;
    }
    const size_t half = takers / 2;
    const bool isWide = grid.columns >= grid.rows;
    const int length = isWide ? grid.columns : grid.rows;
    const int across = isWide ? grid.rows : grid.columns;
    const auto need = [&](size_t count) {
        return static_cast<int>((count + static_cast<size_t>(across) - 1) / static_cast<size_t>(across));
    };
    int cut = static_cast<int>(std::lround(length * static_cast<double>(half) / static_cast<double>(takers)));
    cut = std::clamp(cut, need(half), std::max(need(half), length - need(takers - half)));
    TileRegion low = grid, high = grid;
    (isWide ? low.columns : low.rows) = cut;
    (isWide ? high.column : high.row) += cut;
    (isWide ? high.columns : high.rows) -= cut;
    divide(low, half, areas);
    divide(high, takers - half, areas);
}

} // namespace

TileEqualizer::TileEqualizer(std::string id, const ResolvedConfig& config, Index compound,
                             const config::ResolvedQueue& queue)
    : Equalizer(std::move(id), queue.size.pixels ? "tile_queue" : "chunk_queue", compound), size_(queue.size) {
    collectTakers(config, compound, queue.name, takers_);
}

const std::vector<TileRegion>& TileEqualizer::regions() const {
    static const std::vector<TileRegion> kEmpty;
    return queue_ ? queue_->areas() : kEmpty;
}

void TileEqualizer::observe(const FrameStatistics& statistics) {
    if (!queue_) return;
    times_.assign(takers_.size(), -1);
    for (const LeafStatistics& leaf : statistics.leaves) {
        const auto taker = std::find(takers_.begin(), takers_.end(), leaf.compound);
        if (taker == takers_.end()) continue;
        // Frames of older regions tell nothing about the current ones.
        const size_t i = static_cast<size_t>(taker - takers_.begin());
        const Viewport now = edgesOf(queue_->areas()[i]);
        const Viewport drawn =
            isChunks() ? Viewport{leaf.range.start, 0, leaf.range.end - leaf.range.start, 1} : leaf.viewport;
        const double tolerance = isChunks() ? 1e-6 : 1. / std::max(1, std::min(area_.w, area_.h));
        if (std::abs(now.x - drawn.x) > tolerance || std::abs(now.w - drawn.w) > tolerance) return;
        if (std::abs(now.y - drawn.y) > tolerance || std::abs(now.h - drawn.h) > tolerance) return;
        times_[i] = leaf.loadSeconds();
    }
    if (std::any_of(times_.begin(), times_.end(), [](double t) { return t < 0; })) return;
    decision_.measured = statistics.frameNumber;
    queue_->drawn(times_);
}

void TileEqualizer::layOut() {
    if (isChunks()) {
        columns_ = std::clamp(static_cast<int>(std::ceil(1 / size_.range.value_or(1) - 1e-9)), 1, kMostTiles);
        rows_ = 1;
    } else {
        const auto w = static_cast<int>(std::max(1u, size_.pixels->x)),
                   h = static_cast<int>(std::max(1u, size_.pixels->y));
        columns_ = std::max(1, (area_.w + w - 1) / w);
        rows_ = std::max(1, (area_.h + h - 1) / h);
    }
    queue_.reset();
    if (takers_.empty() || static_cast<size_t>(columns_) * static_cast<size_t>(rows_) < takers_.size()) return;
    std::vector<TileRegion> areas;
    divide({0, 0, columns_, rows_}, takers_.size(), areas);
    queue_.emplace(columns_, rows_, std::move(areas));
}

// Returns the part of a region; a chunk's range is its x and w.
Viewport TileEqualizer::edgesOf(const TileRegion& region) const {
    const double w = isChunks() ? size_.range.value_or(1) : double(size_.pixels->x) / std::max(1, area_.w);
    const double h = isChunks() ? 1 : double(size_.pixels->y) / std::max(1, area_.h);
    const double x0 = std::min(1., region.column * w), x1 = std::min(1., (region.column + region.columns) * w);
    const double y0 = std::min(1., region.row * h), y1 = std::min(1., (region.row + region.rows) * h);
    const bool isLastColumn = region.column + region.columns >= columns_, isLastRow = region.row + region.rows >= rows_;
    return {x0, y0, (isLastColumn ? 1 : x1) - x0, (isLastRow ? 1 : y1) - y0};
}

void TileEqualizer::apply(States& states) {
    for (size_t i = 0; i < takers_.size(); ++i) {
        CompoundState& state = states[at(takers_[i])];
        const Viewport part = edgesOf(queue_->areas()[i]);
        if (isChunks()) {
            const Range range{part.x, part.x + part.w};
            decision_.moved |= state.range != range;
            state.range = range;
        } else {
            decision_.moved |= state.viewport != part;
            state.viewport = part;
        }
    }
}

void TileEqualizer::decide(const FrameContext& context, States& states) {
    const PixelViewport area = areaOf(context, compound());
    if (columns_ == 0 || area.w != area_.w || area.h != area_.h) {
        area_ = area;
        layOut();
    }
    if (!queue_) {
        decision_.what = "fewer items than channels";
        return;
    }
    apply(states);
    decision_.what = decision_.moved ? "items moved to faster channels" : "items stay";
    decision_.inputs = {{"columns", double(columns_)}, {"rows", double(rows_)}};
}

} // namespace mural::balance
