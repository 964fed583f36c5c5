// Pages of long records, at most so many bytes of them. When it is full, the page goes that was not used for longest, as the
// clock rule sees it: a hand goes round and takes the first page that was not used since it last came by. Both sides keep
// it with one bit per page, where a list by age would cost them a list of a quarter of a million links.
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
    void use(uint32_t slot) { used_[slot] = 1; }

    // Empty where there is none.
    [[nodiscard]] std::span<const std::byte> at(uint32_t slot) const {
        return slot < sizes_.size() ? std::span<const std::byte>(bytes_.data() + size_t{slot} * kPageBytes, sizes_[slot]) : std::span<const std::byte>();
    }
    // Of a known slot, whatever it holds.
    [[nodiscard]] std::span<const std::byte> bytes(uint32_t slot, size_t sizeBytes) const { return {bytes_.data() + size_t{slot} * kPageBytes, sizeBytes}; }
    [[nodiscard]] uint32_t slots() const { return static_cast<uint32_t>(sizes_.size()); }

private:
    const uint32_t capacity_;
    LargeArray<std::byte> bytes_;
    std::vector<uint16_t> sizes_;
    std::vector<uint8_t> used_;
    uint32_t hand_ = 0;
};

} // namespace mural::economy
