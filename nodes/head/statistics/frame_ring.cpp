#include "nodes/head/statistics/frame_ring.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace mural {

// Searches the newest frames first, because most tracks belong to one of them.
FrameRing::Entry& FrameRing::of(uint32_t client, uint32_t frame, int64_t nowNs) {
    const auto found = std::find_if(entries_.rbegin(), entries_.rend(), [&](const Entry& entry) {
        return entry.record.client == client && entry.record.frame == frame;
    });
    if (found != entries_.rend()) return *found;
    if (entries_.size() >= capacity_) entries_.pop_front();
    Entry& entry = entries_.emplace_back();
    entry.record.number = next_++;
    entry.record.client = client;
    entry.record.frame = frame;
    entry.beganNs = nowNs;
    return entry;
}

void FrameRing::add(uint32_t client, uint32_t frame, SpanTrack track, int64_t nowNs) {
    of(client, frame, nowNs).record.tracks.push_back(std::move(track));
}

void FrameRing::finish(uint32_t client, uint32_t window, uint32_t frame, int64_t nowNs) {
    FrameRecord& record = of(client, frame, nowNs).record;
    if (record.doneNs != 0) return;
    record.window = window;
    record.doneNs = nowNs;
}

std::vector<FrameRecord> FrameRing::since(uint64_t number, int64_t nowNs, size_t newest) const {
    auto first = std::ranges::find_if(entries_, [&](const Entry& entry) { return entry.record.number >= number; });
    const auto end = std::find_if(first, entries_.end(), [&](const Entry& entry) {
        const bool isSettled = entry.record.doneNs != 0 && nowNs - entry.record.doneNs >= kSettleNs;
        return !isSettled && nowNs - entry.beganNs < kPatienceNs;
    });
    first = std::max(first, end - std::min(end - first, static_cast<std::ptrdiff_t>(newest)));
    std::vector<FrameRecord> records;
    records.reserve(static_cast<size_t>(end - first));
    std::transform(first, end, std::back_inserter(records), [](const Entry& entry) { return entry.record; });
    return records;
}

} // namespace mural
