// What the nodes' GL tells of one context, each on its own: the same message from all nodes, as they all
// draw the same, is told to the program once.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "streamcodec/wire.hpp"

namespace mural {

// All calls from any thread.
class NewsMerger {
public:
    // True: the program has not heard it. A node's n-th message of one kind is the n-th of all nodes.
    bool isNew(int node, const wire::News& news, const std::string& text);
    void programGone(uint32_t client);
    void nodeJoins(int node); // what was told before is not this node's to tell

private:
    // Numbers of messages differ from process to process, so they are no part of this.
    using Key = std::tuple<uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, std::string>;
    struct Count {
        std::vector<uint32_t> byNode;
        uint32_t told = 0;
    };
    std::mutex mutex_;
    std::map<Key, Count> counts_;
};

} // namespace mural
