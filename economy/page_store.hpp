// Pages of long records, at most so many bytes of them. When it is full, the page goes that was not used for longest, as the
// clock rule sees it: a hand goes round and takes the first page that was not used since it last came by. Both sides keep
// it with one bit per page, where a list by age would cost them a list of a quarter of a million links.
//
// A page of which a part changes goes into a new slot, so that the one before it can come again. One that has changed so several
// times, and never came again as it had been before a change, stays in its slot: a buffer that is another in most frames would fill
// memory else, which costs more than to compare it. That it comes as it is now, in the frames between, tells nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "economy/large_array.hpp"
#include "economy/limits.hpp"

namespace mural::economy {

class PageStore {
public:
    explicit PageStore(uint64_t sizeBytes);

    // False: there was no memory for it.
    [[nodiscard]] bool ready() const { return static_cast<bool>(bytes_); }

    // The slot for a new page; what was in it is gone.
    uint32_t take();
    // `page` may lie in the store.
    void fill(uint32_t slot, std::span<const std::byte> page);
    // What is in it comes where it was expected.
    void use(uint32_t slot) {
        slots_[slot].used = true;
        if (slots_[slot].left) begin(slot);
    }
    // It comes in another page's place.
    void useElsewhere(uint32_t slot) {
        slots_[slot].used = true;
        begin(slot);
    }
    // The slot for what the page in this slot has become.
    uint32_t changed(uint32_t slot);
    // That is this slot.
    [[nodiscard]] bool changesInPlace(uint32_t slot) const { return slots_[slot].changes >= kMostChanges; }

    // Empty where there is none.
    [[nodiscard]] std::span<const std::byte> at(uint32_t slot) const {
        return slot < slots_.size() ? bytes(slot, slots_[slot].sizeBytes) : std::span<const std::byte>();
    }
    // Of a known slot, whatever it holds.
    [[nodiscard]] std::span<const std::byte> bytes(uint32_t slot, size_t sizeBytes) const { return {bytes_.data() + size_t{slot} * kPageBytes, sizeBytes}; }
    [[nodiscard]] uint32_t slots() const { return static_cast<uint32_t>(slots_.size()); }

private:
    static constexpr uint8_t kMostChanges = 8; // so many states of a page are remembered

    struct Slot {
        uint16_t sizeBytes = 0;
        bool used = false;   // since the hand came by
        bool left = false;   // what is in it has changed, and went on in another slot
        uint8_t changes = 0; // up to what is in it, one behind the other, without a page that came again
    };
    void begin(uint32_t slot) { slots_[slot].changes = 0, slots_[slot].left = false; }

    const uint32_t capacity_;
    LargeArray<std::byte> bytes_;
    std::vector<Slot> slots_;
    uint32_t hand_ = 0;
};

} // namespace mural::economy
