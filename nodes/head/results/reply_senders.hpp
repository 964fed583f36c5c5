// Determines the nodes that will answer an item of the stream: those that were members when it was sent. A returning
// node becomes a member at one position of the stream (HeadCommand::Activate), and each node marks that position in its
// messages. The set of members (view) that applies to a message is thus known without parsing the stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural {

// Views are numbered; all initial nodes are members of view 0. Not thread-safe.
class ReplySenders {
public:
    explicit ReplySenders(size_t nodes) : nodes_(nodes) {}
    [[nodiscard]] size_t size() const { return nodes_.size(); }

    // Adds nodes that are no members yet.
    void addNodes(size_t count) { nodes_.resize(nodes_.size() + count, {false, 0, 0}); }
    // Makes the node a member from this view on. It must have sent nothing before.
    void joins(int node, uint32_t view) { at(node) = {true, view, view}; }
    // Records that the node's messages belong to this view from now on.
    void reached(int node, uint32_t view) { at(node).in = view; }
    void lost(int node) { at(node).isAlive = false; }

    [[nodiscard]] uint32_t since(int node) const { return nodes_[static_cast<size_t>(node)].since; }
    [[nodiscard]] bool isAlive(int node) const { return nodes_[static_cast<size_t>(node)].isAlive; }
    // Returns the nodes that will report the same item as `teller`, which is the first to report it.
    [[nodiscard]] std::vector<bool> awaited(int teller) const {
        const uint32_t view = nodes_[static_cast<size_t>(teller)].in;
        std::vector<bool> senders;
        for (const Node& node : nodes_) senders.push_back(node.isAlive && node.since <= view);
        return senders;
    }

private:
    struct Node {
        bool isAlive = true;
        uint32_t since = 0;
        uint32_t in = 0; // view of its current messages
    };
    Node& at(int node) { return nodes_[static_cast<size_t>(node)]; }

    std::vector<Node> nodes_;
};

} // namespace mural
