// Streaming: the last rank sends to its predecessor, which composites and passes on, down to the collector. Each rank
// transfers one picture to one neighbour, and each link is used in one direction. Bands are pipelined, so all ranks
// work at once after the first few. Source: Roth, Reiners, "Sorted pipeline image composition" (2006); thesis, "DB with
// streaming".
#include <algorithm>

#include "compositor/strategies/schedule_maker.hpp"

namespace mural::compositor {

namespace {

constexpr int32_t kMinRows = 64; // rows of a band: smaller ones cost more than they save in latency
constexpr int kMaxBands = 16;

} // namespace

void makeStreaming(ScheduleMaker& maker) {
    const int bands = std::clamp(static_cast<int>(maker.rows() / kMinRows), 1, kMaxBands);
    for (int b = 0; b < bands; ++b)
        for (int rank = maker.ranks() - 1; rank > 0; --rank)
            maker.transfer({rank, rank - 1, maker.band(b, bands), Step::Kind::FoldLater, 0});
}

} // namespace mural::compositor
