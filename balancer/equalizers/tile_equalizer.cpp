#include "balancer/equalizers/tile_equalizer.hpp"

#include <algorithm>
#include <cmath>

#include "balancer/equalizers/split/split_equalizer.hpp"

namespace mural::balance {

namespace {

constexpr int kMaxTiles = 16384; // of a picture; more tiles cost more here than they gain
constexpr int kMaxChunks = 4096;

int piecesOf(int size, int step) { return (size + step - 1) / step; }

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
    : Equalizer(std::move(id), queue.size.pixels ? "tile_queue" : "chunk_queue", compound,
                queue.size.pixels ? Effect::Viewports : Effect::Ranges),
      size_(queue.size) {
    collectTakers(config, compound, queue.name, takers_);
}

const std::vector<TileRegion>& TileEqualizer::regions() const {
    static const std::vector<TileRegion> kEmpty;
    return queue_ ? queue_->areas() : kEmpty;
}

std::optional<TileRegion> TileEqualizer::regionOf(size_t taker) const {
    const auto at = std::ranges::lower_bound(working_, taker);
    if (!queue_ || at == working_.end() || *at != taker) return {};
    return queue_->areas()[static_cast<size_t>(at - working_.begin())];
}

void TileEqualizer::observe(const FrameStatistics& statistics) {
    if (!queue_) return;
    times_.assign(working_.size(), -1);
    for (const LeafStatistics& leaf : statistics.leaves) {
        const auto taker = static_cast<size_t>(std::ranges::find(takers_, leaf.compound) - takers_.begin());
        const auto region = regionOf(taker);
        if (!region) continue;
        // Frames of older regions tell nothing about the current ones.
        const Viewport now = edgesOf(*region);
        const Viewport drawn =
            isChunks() ? Viewport{leaf.range.start, 0, leaf.range.end - leaf.range.start, 1} : leaf.viewport;
        const double tolerance = isChunks() ? 1e-6 : 1. / std::max(1, std::min(area_.w, area_.h));
        if (std::abs(now.x - drawn.x) > tolerance || std::abs(now.w - drawn.w) > tolerance) return;
        if (std::abs(now.y - drawn.y) > tolerance || std::abs(now.h - drawn.h) > tolerance) return;
        times_[static_cast<size_t>(std::ranges::lower_bound(working_, taker) - working_.begin())] = leaf.loadSeconds();
    }
    if (std::any_of(times_.begin(), times_.end(), [](double t) { return t < 0; })) return;
    decision_.measured = statistics.frameNumber;
    queue_->drawn(times_);
}

// Doubles the size of tiles while there are too many. Halves it while there are fewer than takers.
void TileEqualizer::chooseGrid() {
    const auto takers = static_cast<int>(working_.size());
    rows_ = 1;
    if (isChunks()) {
        const double part = std::max(size_.range.value_or(1), 1. / kMaxChunks);
        columns_ = std::clamp(static_cast<int>(std::ceil(1 / part - 1e-9)), std::max(1, takers), kMaxChunks);
        return;
    }
    width_ = static_cast<int>(std::clamp(size_.pixels->x, 1u, 1u << 20));
    height_ = static_cast<int>(std::clamp(size_.pixels->y, 1u, 1u << 20));
    const int w = std::max(1, area_.w), h = std::max(1, area_.h);
    while (int64_t{piecesOf(w, width_)} * piecesOf(h, height_) > kMaxTiles) (width_ <= height_ ? width_ : height_) *= 2;
    while (piecesOf(w, width_) * piecesOf(h, height_) < takers && (width_ > 1 || height_ > 1)) {
        if (width_ > 1) width_ = (width_ + 1) / 2;
        if (height_ > 1) height_ = (height_ + 1) / 2;
    }
    columns_ = piecesOf(w, width_);
    rows_ = piecesOf(h, height_);
}

void TileEqualizer::layOut() {
    chooseGrid();
    queue_.reset();
    if (working_.empty() || int64_t{columns_} * rows_ < static_cast<int64_t>(working_.size())) return;
    std::vector<TileRegion> areas;
    divide({0, 0, columns_, rows_}, working_.size(), areas);
    queue_.emplace(columns_, rows_, std::move(areas));
}

// Returns the part of a region; a chunk's range is its x and w.
Viewport TileEqualizer::edgesOf(const TileRegion& region) const {
    const double w = isChunks() ? 1. / columns_ : double(width_) / std::max(1, area_.w);
    const double h = isChunks() ? 1 : double(height_) / std::max(1, area_.h);
    const double x0 = std::min(1., region.column * w), x1 = std::min(1., (region.column + region.columns) * w);
    const double y0 = std::min(1., region.row * h), y1 = std::min(1., (region.row + region.rows) * h);
    const bool isLastColumn = region.column + region.columns >= columns_, isLastRow = region.row + region.rows >= rows_;
    return {x0, y0, (isLastColumn ? 1 : x1) - x0, (isLastRow ? 1 : y1) - y0};
}

void TileEqualizer::apply(States& states) {
    for (size_t i = 0; i < takers_.size(); ++i) {
        CompoundState& state = states[at(takers_[i])];
        const auto region = regionOf(i);
        const Viewport part = region ? edgesOf(*region) : Viewport{0, 0, 0, 0};
        decision_.moved |= state.active != region.has_value();
        state.active = region.has_value();
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
    std::vector<size_t> working;
    for (size_t i = 0; i < takers_.size(); ++i)
        if (states[at(takers_[i])].isAvailable && states[at(takers_[i])].usage > 0) working.push_back(i);
    if (columns_ == 0 || area.w != area_.w || area.h != area_.h || working != working_) {
        area_ = area;
        working_ = std::move(working);
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
