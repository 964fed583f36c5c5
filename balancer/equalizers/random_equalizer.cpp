#include "balancer/equalizers/random_equalizer.hpp"

#include <algorithm>

#include "balancer/equalizers/random_areas.hpp"

namespace mural::balance {

namespace {

constexpr int kCells = 64; // of the grid that the cuts lie on, in each direction

} // namespace

RandomEqualizer::RandomEqualizer(const Equalizer& other, const ResolvedConfig& config, uint32_t seed)
    : Equalizer(other.id(), "random", other.compound(), other.effect()),
      targets_(other.targets(config)),
      random_(seed) {}

void RandomEqualizer::decide(const FrameContext&, States& states) {
    std::vector<Index> working;
    for (const Index target : targets_) {
        const bool works = states[at(target)].isAvailable;
        states[at(target)].active = works;
        if (works) working.push_back(target);
    }
    if (working.empty()) return;
    const bool ranges = effect() == Effect::Ranges;
    const auto pieces = static_cast<int>(working.size());
    auto areas = ranges ? queue::randomAreas(std::max(kCells, pieces), 1, working.size(), random_)
                        : queue::randomAreas(kCells, std::max(kCells, pieces), working.size(), random_);
    if (ranges) std::ranges::sort(areas, {}, &TileRegion::column); // ranges keep the order of the draws
    const double columns = ranges ? std::max(kCells, pieces) : kCells, rows = ranges ? 1 : std::max(kCells, pieces);
    for (size_t i = 0; i < working.size(); ++i) {
        const TileRegion& r = areas[i];
        CompoundState& state = states[at(working[i])];
        if (ranges)
            state.range = Range{r.column / columns, (r.column + r.columns) / columns};
        else
            state.viewport = Viewport{r.column / columns, r.row / rows, r.columns / columns, r.rows / rows};
    }
    decision_.what = "a random division";
    decision_.moved = true;
}

} // namespace mural::balance
