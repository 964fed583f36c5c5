#include "nodes/culling/box_cache.hpp"

#include <algorithm>
#include <utility>

namespace mural::culling {

namespace {
// Memory of an entry without boxes, with the nodes of list and map.
constexpr size_t kEntryBytes = 640;
} // namespace

size_t BoxKey::hash() const {
    uint64_t hash = used_;
    for (size_t i = 0; i < used_; ++i) {
        hash = (hash ^ numbers_[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

BoxCache::Entry& BoxCache::look(const BoxKey& key) {
    const auto known = byKey_.find(key);
    if (known != byKey_.end()) {
        nodes_.splice(nodes_.begin(), nodes_, known->second);
    } else {
        nodes_.push_front({key, {}, kEntryBytes});
        byKey_.emplace(key, nodes_.begin());
        bytes_ += kEntryBytes;
        shrink();
    }
    Entry& entry = nodes_.front().entry;
    if (entry.sightings < UINT32_MAX) ++entry.sightings;
    return entry;
}

void BoxCache::store(std::shared_ptr<const DrawBoxes> boxes) {
    Node& node = nodes_.front();
    node.entry.isImpossible = !boxes;
    node.entry.boxes = std::move(boxes);
    const size_t size = kEntryBytes + (node.entry.boxes ? node.entry.boxes->memoryBytes() : 0);
    bytes_ += size - std::exchange(node.sizeBytes, size);
    shrink();
}

// Keeps the latest entry, even if it is larger than the bound.
void BoxCache::shrink() {
    while (bytes_ > maxBytes_ && nodes_.size() > 1) {
        bytes_ -= nodes_.back().sizeBytes;
        byKey_.erase(nodes_.back().key);
        nodes_.pop_back();
    }
    peakBytes_ = std::max(peakBytes_, bytes_);
}

} // namespace mural::culling
