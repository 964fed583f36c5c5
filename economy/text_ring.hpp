// The bytes of short items: a ring that forgets the oldest. What it has overwritten is not looked for: an item whose text is
// gone reads as something else, the same on both sides, and the packer compares before it refers to anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace mural::economy {

class TextRing {
public:
    explicit TextRing(uint32_t sizeBytes) : bytes_(sizeBytes) {}

    // Never beyond the end of the ring. `text` may lie in the ring.
    uint32_t add(std::span<const std::byte> text) {
        if (bytes_.size() - head_ < text.size()) head_ = 0;
        std::memmove(bytes_.data() + head_, text.data(), text.size());
        const uint32_t where = head_;
        head_ += static_cast<uint32_t>((text.size() + 3) / 4 * 4);
        if (head_ >= bytes_.size()) head_ = 0;
        return where;
    }

    [[nodiscard]] std::span<const std::byte> at(uint32_t where, size_t sizeBytes) const { return {bytes_.data() + where, sizeBytes}; }

    // So old that it should be written anew, or what is in use would be overwritten.
    [[nodiscard]] bool old(uint32_t where) const { return ((head_ - where) & (bytes_.size() - 1)) > bytes_.size() / 2; }

private:
    std::vector<std::byte> bytes_;
    uint32_t head_ = 0;
};

} // namespace mural::economy
