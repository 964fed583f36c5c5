// Where in a stream's log two items came one after the other, by their hashes: how the packer finds its way back when items
// were moved, or others put between them. A short one alone (glEnd) says nothing of what follows; a longer one does, where
// both are not found. An entry may be wrong or lost: the packer compares.
#pragma once

#include <cstdint>
#include <memory>

namespace mural::economy {

class ItemIndex {
public:
    explicit ItemIndex(uint32_t logItems)
        : mask_(logItems - 1), hashes_(std::make_unique_for_overwrite<uint32_t[]>(logItems)), positions_(std::make_unique<uint32_t[]>(logItems)) {}

    // The item that is appended at `position`; `first`: of its packet.
    void append(uint64_t position, uint32_t hash, uint32_t sizeBytes, bool first) {
        hashes_[position & mask_] = hash;
        if (!first) put(hashes_[(position - 1) & mask_], hash, position - 1);
        if (sizeBytes >= kTellingBytes) put(hash, kAnything, position);
    }
    void packetEnds(uint64_t lastPosition) { put(hashes_[lastPosition & mask_], kNothing, lastPosition); }

    [[nodiscard]] uint32_t hashAt(uint64_t position) const { return hashes_[position & mask_]; }
    // Before `end`; maybe such a pair is there.
    [[nodiscard]] uint64_t find(uint32_t hash, uint32_t nextHash, uint64_t end) const {
        const uint32_t position = positions_[key(hash, nextHash)];
        return end - static_cast<uint32_t>(static_cast<uint32_t>(end) - position);
    }

    static constexpr uint32_t kNothing = 0;  // follows the last item of a packet
    static constexpr uint32_t kAnything = 1; // whatever follows
    static constexpr uint32_t kTellingBytes = 32;

private:
    [[nodiscard]] uint32_t key(uint32_t a, uint32_t b) const {
        const uint64_t mixed = (uint64_t{a} << 32 | b) * 0x9e3779b97f4a7c15u;
        return static_cast<uint32_t>(mixed >> 32) & mask_;
    }
    void put(uint32_t hash, uint32_t next, uint64_t position) { positions_[key(hash, next)] = static_cast<uint32_t>(position); }

    const uint32_t mask_;
    const std::unique_ptr<uint32_t[]> hashes_;
    const std::unique_ptr<uint32_t[]> positions_;
};

} // namespace mural::economy
