#include "nodes/culling/box_cache.hpp"

#include <algorithm>
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

BoxCache::Node& BoxCache::freshNode(const BoxKey& key, uint64_t hash) {
    if (free_.empty()) {
        nodes_.emplace_back();
        free_.push_back(&nodes_.back());
    }
    Node& node = *free_.back();
    free_.pop_back();
    node = {};
    node.sizeBytes = kEntryBytes;
    node.hash = hash;
    node.key = key;
    bytes_ += kEntryBytes;
    return node;
}

BoxCache::Node& BoxCache::nodeOf(const BoxKey& key) {
    Node* const likely = last_ ? last_->successor : nullptr;
    if (likely && !likely->isFree && likely->key == key) {
        likely->isUsed = true;
        return *likely;
    }
    const uint64_t hash = key.hash();
    const auto [known, isNew] = byHash_.try_emplace(hash);
    if (isNew) {
        known->second = &freshNode(key, hash);
    } else if (!(known->second->key == key)) { // another key with this hash
        bytes_ += kEntryBytes - known->second->sizeBytes;
        *known->second = {};
        known->second->sizeBytes = kEntryBytes;
        known->second->hash = hash;
        known->second->key = key;
    } else {
        known->second->isUsed = true;
    }
    if (last_) last_->successor = known->second;
    return *known->second;
}

BoxCache::Entry& BoxCache::look(const BoxKey& key) {
    last_ = &nodeOf(key);
    if (bytes_ > maxBytes_) shrink();
    peakBytes_ = std::max(peakBytes_, bytes_);
    if (last_->successor) __builtin_prefetch(last_->successor);
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
    while (bytes_ > maxBytes_ && byHash_.size() > 1) {
        hand_ = hand_ < nodes_.size() ? hand_ : 0;
        Node& node = nodes_[hand_++];
        if (node.isFree || &node == last_ || std::exchange(node.isUsed, false)) continue;
        bytes_ -= node.sizeBytes;
        byHash_.erase(node.hash);
        node.entry = {};
        node.isFree = true;
        free_.push_back(&node);
    }
    peakBytes_ = std::max(peakBytes_, bytes_);
}

} // namespace mural::culling
