// What the nodes said about themselves when they were ready, and what of it holds for all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural {

struct NodeFacts {
    std::string host;
    int64_t pid = 0;
    std::string renderer;
    std::string placement; // of the replay thread; for --explain
    std::string ownStream; // why its packets can't come by multicast; empty: they do, or nobody asked it to
    std::string exchange;  // HOST:PORT where it takes other nodes' pictures; no host: this machine; empty: it does not
    std::string swapBarrier; // likewise where it lets others of its swap barrier in
    int glVersion = 0; // 10 * major + minor, 0: unknown
    int64_t mostPixels = 0; // of a side of the pictures that it can draw; 0: unknown
    std::vector<std::string> extensions;
};

Result<NodeFacts> nodeFactsFromJson(const std::string& json);

int lowestGlVersion(const std::vector<NodeFacts>& nodes);

// Those that every node has, separated by spaces.
std::string commonExtensions(const std::vector<NodeFacts>& nodes);

} // namespace mural
