// Deduplicates driver events. All nodes draw the same, so each node reports the same message; the program receives it
// once.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "streamcodec/wire/replies.hpp"

namespace mural {

// Thread-safe.
class DriverEventMerger {
public:
    // Returns true if the message is new to the program. The n-th message of a kind is the same message on all nodes.
    bool isNew(int node, const wire::DriverEvent& event, const std::string& text);
    void programGone(uint32_t client);
    void nodeJoins(int node); // earlier messages are not expected from this node

private:
    // Message ids differ between processes and are not part of the key.
    using Key = std::tuple<uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, std::string>;
    struct Count {
        std::vector<uint32_t> byNode;
        uint32_t delivered = 0;
    };
    std::mutex mutex_;
    std::map<Key, Count> counts_;
};

} // namespace mural
