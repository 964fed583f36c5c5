#include "nodes/head/results/driver_event_merger.hpp"

namespace mural {
namespace {
constexpr size_t kMaxKinds = 4096; // bounds the remembered messages; the counts restart at this limit
} // namespace

bool DriverEventMerger::isNew(int node, const wire::DriverEvent& event, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (counts_.size() >= kMaxKinds) counts_.clear();
    Count& count = counts_[{event.client, event.context, event.kind, event.source, event.type, event.severity, text}];
    const auto index = static_cast<size_t>(node);
    if (count.byNode.size() <= index) count.byNode.resize(index + 1);
    if (++count.byNode[index] <= count.delivered) return false;
    ++count.delivered;
    return true;
}

void DriverEventMerger::nodeJoins(int node) {
    const std::lock_guard lock(mutex_);
    const auto index = static_cast<size_t>(node);
    for (auto& [kind, count] : counts_) {
        if (count.byNode.size() <= index) count.byNode.resize(index + 1);
        count.byNode[index] = count.delivered;
    }
}

void DriverEventMerger::programGone(uint32_t client) {
    const std::lock_guard lock(mutex_);
    std::erase_if(counts_, [&](const auto& entry) { return std::get<0>(entry.first) == client; });
}

} // namespace mural
