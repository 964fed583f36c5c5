// The numbers of all nodes for the overlay `stats`, from the statistics of frames. Pure; not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nodes/head/statistics/frame_record.hpp"
#include "nodes/overlay/overlay_content.hpp"

namespace mural {

class OverlayNumbers {
public:
    // names: one per node; empty: the number has no node, and nodes() omits it.
    explicit OverlayNumbers(std::vector<std::string> names);

    // Adds complete frames, in order. Frames with numbers below next() count once.
    void add(const std::vector<FrameRecord>& records);
    [[nodiscard]] uint64_t next() const { return next_; }
    [[nodiscard]] const std::vector<OverlayNode>& nodes() const { return nodes_; }

private:
    std::vector<OverlayNode> nodes_;
    std::vector<std::optional<size_t>> places_; // in nodes_, by number of the node
    uint64_t next_ = 1;                         // number of the first frame that is not added yet
};

} // namespace mural
