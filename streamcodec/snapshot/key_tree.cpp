#include "streamcodec/snapshot/key_tree.hpp"

#include <algorithm>

namespace mural::snapshot {
namespace {

constexpr size_t kFirstSlots = 1024;
constexpr uint32_t kFreeKind = 0xffffffff;

} // namespace

KeyTree::KeyTree() : nodes_{{kNoKey, kFreeKind, 0, 0}}, slots_(kFirstSlots, kNoKey) {}

uint64_t KeyTree::hashOf(const Node& node) {
    uint64_t h = (uint64_t{node.parent} << 32 | node.kind) * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 29 ^ node.a) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 32 ^ node.b) * 0x94d049bb133111ebu;
    return h ^ h >> 31;
}

Key KeyTree::child(Key parent, uint32_t kind, uint64_t a, uint64_t b) {
    const Node wanted{parent, kind, a, b};
    const size_t mask = slots_.size() - 1;
    for (size_t at = hashOf(wanted) & mask;; at = (at + 1) & mask) {
        const Key key = slots_[at];
        if (key == kNoKey) break;
        const Node& n = nodes_[key];
        if (n.parent == parent && n.kind == kind && n.a == a && n.b == b) return key;
    }
    Key key = static_cast<Key>(nodes_.size());
    if (free_.empty()) {
        nodes_.push_back(wanted);
    } else {
        key = free_.back();
        free_.pop_back();
        nodes_[key] = wanted;
    }
    if (used() * 2 > slots_.size())
        rehash(slots_.size() * 2);
    else
        insert(key);
    return key;
}

void KeyTree::insert(Key key) {
    const size_t mask = slots_.size() - 1;
    size_t at = hashOf(nodes_[key]) & mask;
    while (slots_[at] != kNoKey) at = (at + 1) & mask;
    slots_[at] = key;
}

void KeyTree::rehash(size_t slots) {
    slots_.assign(slots, kNoKey);
    for (Key key = 1; key < nodes_.size(); ++key)
        if (nodes_[key].kind != kFreeKind) insert(key);
}

void KeyTree::keepOnly(std::vector<bool> marked) {
    marked.resize(nodes_.size());
    for (Key key = 1; key < nodes_.size(); ++key)
        if (marked[key])
            for (Key above = nodes_[key].parent; above != kNoKey && !marked[above]; above = nodes_[above].parent)
                marked[above] = true;
    for (Key key = 1; key < nodes_.size(); ++key) {
        if (marked[key] || nodes_[key].kind == kFreeKind) continue;
        nodes_[key].kind = kFreeKind;
        free_.push_back(key);
    }
    size_t slots = kFirstSlots;
    while (slots < used() * 4) slots *= 2;
    rehash(slots);
}

} // namespace mural::snapshot
