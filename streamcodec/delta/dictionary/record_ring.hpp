// Ring of the bytes of short records. Overwritten bytes are not tracked: a stale entry reads as other bytes, identical
// on both sides, and the encoder compares before it refers to an entry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "streamcodec/delta/dictionary/large_array.hpp"

namespace mural::delta {

class RecordRing {
public:
    explicit RecordRing(uint32_t sizeBytes) : sizeBytes_(sizeBytes), bytes_(LargeArray<std::byte>::make(sizeBytes)) {}

    // Appends contiguous bytes. `text` may be in the ring.
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

    [[nodiscard]] std::span<const std::byte> at(uint32_t where, size_t sizeBytes) const {
        return {bytes_.data() + where, sizeBytes};
    }

    // Returns the number of bytes written since the start, including skipped ones at the end of the ring, now and
    // before a given entry.
    [[nodiscard]] uint64_t written() const { return written_; }
    [[nodiscard]] uint64_t writtenBefore(uint32_t where) const {
        return written_ - ((head_ - where) & (sizeBytes_ - 1));
    }
    // Returns true if the entry is in the older half of the ring and must be appended again before it is overwritten.
    [[nodiscard]] bool old(uint32_t where) const { return ((head_ - where) & (sizeBytes_ - 1)) > sizeBytes_ / 2; }
    [[nodiscard]] bool oldSince(uint64_t writtenBefore) const { return written_ - writtenBefore > sizeBytes_ / 2; }

private:
    const uint32_t sizeBytes_;
    LargeArray<std::byte> bytes_;
    uint32_t head_ = 0;
    uint64_t written_ = 0;
};

} // namespace mural::delta
