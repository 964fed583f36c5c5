// Finds positions in a stream's log by the hashes of two consecutive entries, so the encoder resynchronizes after moved
// or inserted entries. A short entry alone, such as glEnd, does not determine its successor. A longer entry does, and
// is used if the pair is not found. Results are hints: the encoder compares.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "streamcodec/delta/dictionary/large_array.hpp"

namespace mural::delta {

class MatchIndex {
public:
    explicit MatchIndex(uint32_t logItems)
        : mask_(logItems - 1),
          againBits_(static_cast<uint32_t>(std::bit_width((logItems + 1) / 2)) - 1),
          maxPositions_(logItems / 8),
          hashes_(LargeArray<uint32_t>::make(logItems)),
          positions_(kFirstPositions) {}

    // Adds the entry appended at `position`. `first`: it is the first of its packet.
    void append(uint64_t position, uint32_t hash, uint32_t sizeBytes, bool first) {
        hashes_[position & mask_] = hash;
        if (!first) put(hashes_[(position - 1) & mask_], hash, position - 1);
        if (sizeBytes >= kMinIndexedBytes) put(hash, kAnything, position);
    }
    // Adds a repetition of the entry at `from` after the same predecessor. The old position stays in the index until it
    // is half a log behind.
    void appendAgain(uint64_t position, uint64_t from, uint32_t sizeBytes) {
        const uint32_t hash = hashes_[from & mask_];
        if (half(position) == half(from))
            hashes_[position & mask_] = hash;
        else
            append(position, hash, sizeBytes, false);
    }
    // The same for a run. `sizeAt(i)` returns the size of the entry at `from + i`.
    void appendAllAgain(uint64_t position, uint64_t from, size_t count, const auto& sizeAt) {
        for (size_t i = 0; i < count;) {
            if (half(position + i) != half(from + i)) {
                appendAgain(position + i, from + i, sizeAt(i));
                ++i;
                continue;
            }
            const size_t source = (from + i) & mask_, target = (position + i) & mask_,
                         halfEnds = (size_t{1} << againBits_) - 1;
            const size_t maximum = std::min(halfEnds + 1 - (source & halfEnds), halfEnds + 1 - (target & halfEnds)),
                         part = std::min(count - i, maximum);
            std::memmove(hashes_.data() + target, hashes_.data() + source, part * sizeof(uint32_t));
            i += part;
        }
    }
    // Adds an entry that changes every time and is not searched for.
    void appendUnfound(uint64_t position, uint32_t hash) { hashes_[position & mask_] = hash; }
    void packetEnds(uint64_t lastPosition) { put(hashes_[lastPosition & mask_], kNothing, lastPosition); }

    [[nodiscard]] uint32_t hashAt(uint64_t position) const { return hashes_[position & mask_]; }
    // Returns a position before `end` where such a pair may be.
    [[nodiscard]] uint64_t find(uint32_t hash, uint32_t nextHash, uint64_t end) const {
        const uint32_t position = positions_[key(hash, nextHash)];
        return end - static_cast<uint32_t>(static_cast<uint32_t>(end) - position);
    }

    static constexpr uint32_t kNothing = 0;  // predecessor of a packet's first entry
    static constexpr uint32_t kAnything = 1; // any successor
    static constexpr uint32_t kMinIndexedBytes = 32;

private:
    static constexpr size_t kFirstPositions = 8192;

    [[nodiscard]] uint64_t half(uint64_t position) const { return position >> againBits_; }
    [[nodiscard]] size_t key(uint32_t a, uint32_t b) const {
        const uint64_t mixed = (uint64_t{a} << 32 | b) * 0x9e3779b97f4a7c15u;
        return static_cast<size_t>(mixed >> 32) & (positions_.size() - 1);
    }
    void put(uint32_t hash, uint32_t next, uint64_t position) {
        uint32_t& slot = positions_[key(hash, next)];
        puts_ += slot == 0;
        slot = static_cast<uint32_t>(position);
        if (puts_ > positions_.size() / 8 && positions_.size() < maxPositions_) grow(position);
    }
    // Grows the table, so programs with few calls touch little memory. Reinserts the existing entries from the log.
    void grow(uint64_t end) {
        positions_.assign(positions_.size() * 4, 0);
        puts_ = 0;
        const uint64_t known = end < mask_ ? end : mask_;
        for (uint64_t position = end - known; position + 1 < end; ++position) {
            const uint32_t hash = hashes_[position & mask_];
            positions_[key(hash, hashes_[(position + 1) & mask_])] = static_cast<uint32_t>(position);
            positions_[key(hash, kAnything)] = static_cast<uint32_t>(position);
            puts_ += 2;
        }
    }

    const uint32_t mask_;
    const uint32_t againBits_; // position bits that span half the log
    const size_t maxPositions_;
    LargeArray<uint32_t> hashes_;
    std::vector<uint32_t> positions_; // size is a power of two
    size_t puts_ = 0;
};

} // namespace mural::delta
