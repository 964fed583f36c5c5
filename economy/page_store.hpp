// Pages of long records, at most so many bytes of them. When it is full, the page goes that was not used for longest, as the
// clock rule sees it: a hand goes round and takes the first page that was not used since it last came by. Both sides keep
// it with one bit per page, where a list by age would cost them a list of a quarter of a million links.
//
// A page of which a part changes goes into a new slot, so that the one before it can come again. One that has changed so several
// times, and never came again as it was, stays in its slot: a buffer that is another in each frame would fill memory else, which
// costs more than to compare it.
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
    void use(uint32_t slot) { used_[slot] = 1, changes_[slot] = 0; }
    // The slot for what the page in this slot has become.
    uint32_t changed(uint32_t slot);
    // That is this slot.
    [[nodiscard]] bool changesInPlace(uint32_t slot) const { return changes_[slot] >= kMostChanges; }

    // Empty where there is none.
    [[nodiscard]] std::span<const std::byte> at(uint32_t slot) const {
        return slot < sizes_.size() ? std::span<const std::byte>(bytes_.data() + size_t{slot} * kPageBytes, sizes_[slot]) : std::span<const std::byte>();
    }
    // Of a known slot, whatever it holds.
    [[nodiscard]] std::span<const std::byte> bytes(uint32_t slot, size_t sizeBytes) const { return {bytes_.data() + size_t{slot} * kPageBytes, sizeBytes}; }
    [[nodiscard]] uint32_t slots() const { return static_cast<uint32_t>(sizes_.size()); }

private:
    static constexpr uint8_t kMostChanges = 8; // so many states of a page are remembered

    const uint32_t capacity_;
    LargeArray<std::byte> bytes_;
    std::vector<uint16_t> sizes_;
    std::vector<uint8_t> used_;
    std::vector<uint8_t> changes_; // up to what is in the slot, one behind the other, without a page that came again
    uint32_t hand_ = 0;
};

} // namespace mural::economy
