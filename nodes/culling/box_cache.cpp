#include "nodes/culling/box_cache.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace mural::culling {

namespace {
// Memory of an entry without boxes, with the nodes of list and map.
constexpr size_t kEntryBytes = 384;
} // namespace

uint64_t BoxKey::hash() const {
    uint64_t hash = used_;
    for (size_t i = 0; i < used_; ++i) {
        hash = (hash ^ numbers_[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

BoxCache::Entry& BoxCache::look(const BoxKey& key) {
    const uint64_t hash = key.hash();
    const auto [known, isNew] = byHash_.try_emplace(hash);
    if (isNew) {
        nodes_.push_front({{}, false, kEntryBytes, hash, key});
        known->second = nodes_.begin();
        bytes_ += kEntryBytes;
        last_ = &nodes_.front();
        shrink();
    } else if (last_ = &*known->second; !(last_->key == key)) { // another key with this hash
        bytes_ += kEntryBytes - last_->sizeBytes;
        *last_ = {{}, false, kEntryBytes, hash, key};
    } else {
        last_->isUsed = true;
    }
    if (last_->entry.sightings < UINT32_MAX) ++last_->entry.sightings;
    return last_->entry;
}

void BoxCache::store(std::shared_ptr<const DrawBoxes> boxes) {
    Node& node = *last_;
    node.entry.isImpossible = !boxes;
    node.entry.boxes = std::move(boxes);
    const size_t size = kEntryBytes + (node.entry.boxes ? node.entry.boxes->memoryBytes() : 0);
    bytes_ += size - std::exchange(node.sizeBytes, size);
    shrink();
}

// Keeps the entry that look() returned last, even if it is larger than the bound.
void BoxCache::shrink() {
    while (bytes_ > maxBytes_ && nodes_.size() > 1) {
        Node& oldest = nodes_.back();
        if (std::exchange(oldest.isUsed, false) || &oldest == last_) {
            nodes_.splice(nodes_.begin(), nodes_, std::prev(nodes_.end()));
            continue;
        }
        bytes_ -= oldest.sizeBytes;
        byHash_.erase(oldest.hash);
        nodes_.pop_back();
    }
    peakBytes_ = std::max(peakBytes_, bytes_);
}

} // namespace mural::culling
