// The numbers of all nodes for the overlay `stats`, from the statistics of frames. Pure; not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "nodes/head/statistics/frame_record.hpp"
#include "nodes/overlay/overlay_content.hpp"

namespace mural {

class OverlayNumbers {
public:
    // names: of the nodes, by their numbers.
    explicit OverlayNumbers(const std::map<int, std::string>& names);

    // Adds complete frames, in order. Frames with numbers below next() count once.
    void add(const std::vector<FrameRecord>& records);
    [[nodiscard]] uint64_t next() const { return next_; }
    [[nodiscard]] std::vector<OverlayNode> nodes() const; // in the order of their numbers

private:
    std::map<int, OverlayNode> nodes_;
    uint64_t next_ = 1; // number of the first frame that is not added yet
};

} // namespace mural
