// The capabilities that nodes report when they are ready, and their intersection.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural {

struct NodeCapabilities {
    std::string host;
    int64_t pid = 0;
    std::string renderer;
    std::string placement;   // CPU placement of the replay thread, for --explain
    std::string ownStream;   // the reason why multicast does not reach the node; empty: it does, or was not requested
    std::string exchange;    // HOST:PORT of its picture exchange; no host: this machine; empty: none
    std::string swapBarrier; // the same for its swap barrier
    int glVersion = 0;       // 10 * major + minor; 0: unknown
    int64_t maxPixels = 0;   // maximum side of a picture, pixels; 0: unknown
    std::vector<std::string> extensions;
};

Result<NodeCapabilities> nodeFactsFromJson(const std::string& json);

int lowestGlVersion(const std::vector<NodeCapabilities>& nodes);

// The extensions of all nodes, separated by spaces.
std::string commonExtensions(const std::vector<NodeCapabilities>& nodes);

} // namespace mural
