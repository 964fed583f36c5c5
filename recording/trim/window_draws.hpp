// Which draws into a window nobody will see: a later clear covers all that they can have changed, and nothing has looked
// before.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "recording/trim/context_state.hpp"

namespace mural::recording {

// Of a draw: the numbers of its records in the file.
using RecordNumbers = std::vector<uint64_t>;

class WindowDraws {
public:
    // writtenPlanes: that it may have changed.
    void draw(const RecordNumbers& records, uint32_t writtenPlanes) {
        auto& same = covered_[indexOf(kAllPlanes & ~writtenPlanes)];
        same.insert(same.end(), records.begin(), records.end());
    }
    // All of these planes gets another value.
    void clear(uint32_t planes) {
        for (unsigned i = 0; i < kUnseen; ++i) {
            const unsigned into = i | indexOf(planes);
            if (into == i) continue;
            covered_[into].insert(covered_[into].end(), covered_[i].begin(), covered_[i].end());
            covered_[i].clear();
        }
    }
    // Its pixels are used: what they hold has to be drawn.
    void look() {
        for (unsigned i = 0; i < kUnseen; ++i) covered_[i].clear();
    }
    [[nodiscard]] const std::vector<uint64_t>& unseen() const { return covered_[kUnseen]; }

private:
    static unsigned indexOf(uint32_t planes) {
        return (planes & kColorPlane ? 1u : 0u) | (planes & kDepthPlane ? 2u : 0u) | (planes & kStencilPlane ? 4u : 0u);
    }
    static constexpr unsigned kUnseen = 7;
    std::array<std::vector<uint64_t>, kUnseen + 1> covered_; // draws, by the planes that were cleared since or are as they were
};

} // namespace mural::recording
