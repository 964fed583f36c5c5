// Boxes of draws by the contents and the layout of their arrays. At the bound, entries leave that no draw has looked up
// since the last round of removals. Frames repeat their draws in the same order, so each entry remembers its successor:
// a look-up then touches the entry's cache lines only.
//
// A key is boxed when it comes the second time, because vertices that change with each draw never pay.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <vector>

#include "nodes/culling/payoff.hpp"
#include "nodes/culling/vertex_boxes.hpp"

namespace mural::culling {

// Numbers that determine the boxes of a draw. Equal keys have equal boxes.
class BoxKey {
public:
    // Numbers beyond the capacity make the key incomplete.
    void add(uint64_t number) {
        if (used_ == numbers_.size())
            isComplete_ = false;
        else
            numbers_[used_++] = number;
    }
    [[nodiscard]] bool isComplete() const { return isComplete_; }
    [[nodiscard]] uint64_t hash() const;
    friend bool operator==(const BoxKey& a, const BoxKey& b) {
        return a.used_ == b.used_ && std::equal(a.numbers_.begin(), a.numbers_.begin() + a.used_, b.numbers_.begin());
    }

private:
    uint32_t used_ = 0;
    bool isComplete_ = true;
    std::array<uint64_t, 24> numbers_; // the first used_ are set
};

inline constexpr size_t kBoxCacheBytes = size_t{64} << 20;

class BoxCache {
public:
    struct Entry {
        std::shared_ptr<const DrawBoxes> boxes; // null: not made yet, or impossible
        bool isImpossible = false;
        uint32_t sightings = 0;
        Payoff payoff; // of clusters

        [[nodiscard]] bool wantsBoxes() const { return !boxes && !isImpossible && sightings >= 2; }
    };
    explicit BoxCache(size_t maxBytes = kBoxCacheBytes) : maxBytes_(maxBytes) {}

    // Counts the sighting. The entry is valid until the next call of look().
    Entry& look(const BoxKey& key);
    // Sets the boxes of the entry that look() returned last; null: impossible.
    void store(std::shared_ptr<const DrawBoxes> boxes);
    [[nodiscard]] size_t memoryBytes() const { return bytes_; }
    [[nodiscard]] size_t peakBytes() const { return peakBytes_; }

private:
    struct Node {
        Entry entry;
        bool isUsed = false; // again, since the last round
        bool isFree = false;
        size_t sizeBytes = 0;
        uint64_t hash = 0;
        Node* successor = nullptr; // looked up after this one, the last time; perhaps with another key now
        BoxKey key;
    };
    struct SameHash {
        size_t operator()(uint64_t hash) const { return hash; }
    };
    Node& nodeOf(const BoxKey& key);
    Node& freshNode(const BoxKey& key, uint64_t hash);
    void shrink();

    size_t maxBytes_, bytes_ = 0, peakBytes_ = 0;
    std::deque<Node> nodes_; // in no order; their addresses stay
    std::vector<Node*> free_;
    size_t hand_ = 0; // next candidate for removal
    std::unordered_map<uint64_t, Node*, SameHash> byHash_;
    Node* last_ = nullptr; // of look()
};

} // namespace mural::culling
