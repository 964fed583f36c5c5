#include "nodes/head/statistics/frame_ring.hpp"

#include <algorithm>
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

std::vector<FrameRecord> FrameRing::since(uint64_t number, int64_t nowNs) const {
    std::vector<FrameRecord> records;
    for (const Entry& entry : entries_) {
        if (entry.record.number < number) continue;
        const bool isSettled = entry.record.doneNs != 0 && nowNs - entry.record.doneNs >= kSettleNs;
        if (!isSettled && nowNs - entry.beganNs < kPatienceNs) break;
        records.push_back(entry.record);
    }
    return records;
}

} // namespace mural
