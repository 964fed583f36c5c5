// Store for pages of long records, of bounded size. The clock algorithm selects the page to replace: a hand advances
// and takes the first page without a use since its last pass. It needs one bit per page on both sides; an LRU list
// would need a quarter of a million links.
//
// A partially changed page takes a new slot, so the previous contents can recur. A page that has changed several times
// without recurring stays in its slot: a buffer that changes in most frames would otherwise fill the memory, at a
// higher cost than a comparison. Unchanged repetitions in between do not count.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "streamcodec/delta/dictionary/large_array.hpp"
#include "streamcodec/delta/limits.hpp"

namespace mural::delta {

class PageStore {
public:
    explicit PageStore(uint64_t sizeBytes);

    // Returns false if there was no memory for the store.
    [[nodiscard]] bool ready() const { return static_cast<bool>(bytes_); }

    // Returns the slot for a new page. Its previous contents are lost.
    uint32_t take();
    // Sets the contents of a slot. `page` may be in the store.
    void fill(uint32_t slot, std::span<const std::byte> page);
    // The page recurs at its expected position.
    void use(uint32_t slot) {
        slots_[slot].used = true;
        if (slots_[slot].left) begin(slot);
    }
    // The page recurs in another page's place.
    void useElsewhere(uint32_t slot) {
        slots_[slot].used = true;
        begin(slot);
    }
    // Returns the slot for the changed contents of this page.
    uint32_t changed(uint32_t slot);
    // Returns true if the changed contents stay in this slot.
    [[nodiscard]] bool changesInPlace(uint32_t slot) const { return slots_[slot].changes >= kMaxChanges; }

    // Returns an empty span for an invalid slot.
    [[nodiscard]] std::span<const std::byte> at(uint32_t slot) const {
        return slot < slots_.size() ? bytes(slot, slots_[slot].sizeBytes) : std::span<const std::byte>();
    }
    // Returns the bytes of a valid slot with any contents.
    [[nodiscard]] std::span<const std::byte> bytes(uint32_t slot, size_t sizeBytes) const {
        return {bytes_.data() + size_t{slot} * kPageBytes, sizeBytes};
    }
    [[nodiscard]] uint32_t slots() const { return static_cast<uint32_t>(slots_.size()); }

private:
    static constexpr uint8_t kMaxChanges = 8; // states of a page that are remembered

    struct Slot {
        uint16_t sizeBytes = 0;
        bool used = false;   // since the last pass of the hand
        bool left = false;   // the page has changed and continues in another slot
        uint8_t changes = 0; // consecutive changes without a recurrence
    };
    void begin(uint32_t slot) { slots_[slot].changes = 0, slots_[slot].left = false; }

    const uint32_t capacity_;
    LargeArray<std::byte> bytes_;
    std::vector<Slot> slots_;
    uint32_t hand_ = 0;
};

} // namespace mural::delta
