#include "nodes/swap_barrier/skew_meter.hpp"

#include <algorithm>

namespace mural {

namespace {

constexpr size_t kOpen = 64;
constexpr size_t kSamples = 4096;

} // namespace

void SkewMeter::released(const SwapKey& key, size_t windows) {
    if (windows < 2) return;
    if (open_.size() == kOpen) open_.pop_front();
    open_.push_back({key, windows});
}

void SkewMeter::shown(const SwapKey& key, int64_t atNs) {
    const auto found = std::ranges::find(open_, key, &Open::key);
    if (found == open_.end()) return;
    found->firstNs = found->any ? std::min(found->firstNs, atNs) : atNs;
    found->lastNs = found->any ? std::max(found->lastNs, atNs) : atNs;
    found->any = true;
    if (--found->awaited > 0) return;
    const int64_t skewNs = found->lastNs - found->firstNs;
    open_.erase(found);
    ++swaps_;
    maxNs_ = std::max(maxNs_, skewNs);
    if (last_.size() < kSamples)
        last_.push_back(skewNs);
    else
        last_[next_++ % kSamples] = skewNs;
}

SkewNumbers SkewMeter::numbers() const {
    SkewNumbers n{swaps_, 0, 0, maxNs_};
    if (last_.empty()) return n;
    std::vector<int64_t> sorted = last_;
    std::ranges::sort(sorted);
    n.medianNs = sorted[sorted.size() / 2];
    n.p99Ns = sorted[std::min(sorted.size() - 1, sorted.size() * 99 / 100)];
    return n;
}

} // namespace mural
