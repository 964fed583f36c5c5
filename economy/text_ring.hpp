// The bytes of short items: a ring that forgets the oldest. What it has overwritten is not looked for: an item whose text is
// gone reads as something else, the same on both sides, and the packer compares before it refers to anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "economy/large_array.hpp"

namespace mural::economy {

class TextRing {
public:
    explicit TextRing(uint32_t sizeBytes) : sizeBytes_(sizeBytes), bytes_(LargeArray<std::byte>::make(sizeBytes)) {}

    // Never beyond the end of the ring. `text` may lie in the ring.
    uint32_t add(std::span<const std::byte> text) {
        if (sizeBytes_ - head_ < text.size()) {
            written_ += sizeBytes_ - head_;
            head_ = 0;
        }
        std::memmove(bytes_.data() + head_, text.data(), text.size());
        const uint32_t where = head_;
        const auto sizeBytes = static_cast<uint32_t>((text.size() + 3) / 4 * 4);
        written_ += sizeBytes;
        head_ += sizeBytes;
        if (head_ >= sizeBytes_) head_ = 0;
        return where;
    }

    [[nodiscard]] std::span<const std::byte> at(uint32_t where, size_t sizeBytes) const { return {bytes_.data() + where, sizeBytes}; }

    // Bytes since the start, those left out at the end of the ring among them; and how many they were before this text was.
    [[nodiscard]] uint64_t written() const { return written_; }
    [[nodiscard]] uint64_t writtenBefore(uint32_t where) const { return written_ - ((head_ - where) & (sizeBytes_ - 1)); }
    // So old that it should be written anew, or what is in use would be overwritten.
    [[nodiscard]] bool old(uint32_t where) const { return ((head_ - where) & (sizeBytes_ - 1)) > sizeBytes_ / 2; }
    [[nodiscard]] bool oldSince(uint64_t writtenBefore) const { return written_ - writtenBefore > sizeBytes_ / 2; }

private:
    const uint32_t sizeBytes_;
    LargeArray<std::byte> bytes_;
    uint32_t head_ = 0;
    uint64_t written_ = 0;
};

} // namespace mural::economy
