// Which nodes will speak of a thing that comes in the stream: those that were members when it was sent. Nodes that come
// back become members at one place of the stream (HeadCommand::Member), and each node says where in its messages that is:
// so it is known of every message without a look into the stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural {

// The views are counted; in view 0 all are members. No lock of its own.
class NodeViews {
public:
    explicit NodeViews(size_t nodes) : nodes_(nodes) {}

    // It is one from this view on, and says nothing before.
    void joins(int node, uint32_t view) { at(node) = {true, view, view}; }
    // What it says from here on was sent in this view.
    void reached(int node, uint32_t view) { at(node).in = view; }
    void lost(int node) { at(node).lives = false; }

    [[nodiscard]] uint32_t since(int node) const { return nodes_[static_cast<size_t>(node)].since; }
    [[nodiscard]] bool lives(int node) const { return nodes_[static_cast<size_t>(node)].lives; }
    // Who speaks of what `teller` is the first to speak of now.
    [[nodiscard]] std::vector<bool> awaited(int teller) const {
        const uint32_t view = nodes_[static_cast<size_t>(teller)].in;
        std::vector<bool> who;
        for (const Node& node : nodes_) who.push_back(node.lives && node.since <= view);
        return who;
    }

private:
    struct Node {
        bool lives = true;
        uint32_t since = 0;
        uint32_t in = 0; // what it says now was sent in this view
    };
    Node& at(int node) { return nodes_[static_cast<size_t>(node)]; }

    std::vector<Node> nodes_;
};

} // namespace mural
