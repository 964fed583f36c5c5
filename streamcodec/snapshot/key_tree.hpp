// Keys of everything that commands read and write, as a tree: clients, below them share groups and contexts, below
// these objects and state, below an object its parts. An access to a node covers its whole subtree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural::snapshot {

using Key = uint32_t;
constexpr Key kNoKey = 0; // the root, above all clients

class KeyTree {
public:
    KeyTree();
    // Returns the key below `parent`, creating it if needed. `kind` separates the name spaces of a and b.
    Key child(Key parent, uint32_t kind, uint64_t a = 0, uint64_t b = 0);
    [[nodiscard]] Key parent(Key key) const { return nodes_[key].parent; }
    [[nodiscard]] size_t size() const { return nodes_.size(); } // has keys below it
    [[nodiscard]] size_t used() const { return nodes_.size() - free_.size(); }
    // Removes unmarked keys; ancestors of marked keys stay. Numbers of removed keys may be reused.
    void keepOnly(std::vector<bool> marked);

private:
    struct Node {
        Key parent;
        uint32_t kind;
        uint64_t a, b;
    };
    [[nodiscard]] static uint64_t hashOf(const Node& node);
    void rehash(size_t slots);
    void insert(Key key);

    std::vector<Node> nodes_;
    std::vector<Key> free_;
    std::vector<Key> slots_; // open addressing; kNoKey: empty
};

} // namespace mural::snapshot
