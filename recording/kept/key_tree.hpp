// Names of all that commands write and read, as a tree: a client, in it share groups and contexts, in these objects and state,
// in an object its parts. Who writes or reads a node does so with all below it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural::recording {

using Key = uint32_t;
constexpr Key kNoKey = 0; // the root, above all clients

class KeyTree {
public:
    KeyTree();
    // The key of that name below `parent`; made when there was none. `kind` tells apart what a and b mean.
    Key child(Key parent, uint32_t kind, uint64_t a = 0, uint64_t b = 0);
    [[nodiscard]] Key parent(Key key) const { return nodes_[key].parent; }
    [[nodiscard]] size_t size() const { return nodes_.size(); } // keys are below it
    [[nodiscard]] size_t used() const { return nodes_.size() - free_.size(); }
    // Forgets all keys that are not marked; those above marked ones stay. Forgotten keys may come back as others.
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

} // namespace mural::recording
