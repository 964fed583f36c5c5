// Pool of payload slots of one size; the lowest free slot is used first. A reader that keeps up reuses few slots, which
// stay in the processor's cache, and consecutive payloads are mostly adjacent.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace mural::rsp {

class SlotPool {
public:
    // Memory is committed on first use.
    SlotPool(size_t slotBytes, uint32_t slots)
        : slotBytes_(slotBytes),
          bytes_(std::make_unique_for_overwrite<std::byte[]>(slotBytes * slots)),
          free_((slots + 63) / 64, ~uint64_t{0}) {}

    // Returns a free slot. The user never exceeds the capacity.
    uint32_t take() {
        while (free_[lowest_] == 0) ++lowest_;
        const auto bit = static_cast<uint32_t>(std::countr_zero(free_[lowest_]));
        free_[lowest_] &= free_[lowest_] - 1;
        return static_cast<uint32_t>(lowest_ * 64) + bit;
    }
    void giveBack(uint32_t poolSlot) {
        const size_t word = poolSlot / 64;
        free_[word] |= uint64_t{1} << poolSlot % 64;
        if (word < lowest_) lowest_ = word;
    }

    [[nodiscard]] std::byte* at(uint32_t poolSlot) const { return bytes_.get() + poolSlot * slotBytes_; }

private:
    size_t slotBytes_;
    std::unique_ptr<std::byte[]> bytes_;
    std::vector<uint64_t> free_; // one bit per slot
    size_t lowest_ = 0;          // no word before it has a free slot
};

} // namespace mural::rsp
